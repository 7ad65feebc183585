//! Types of arguments and results that Python's type checkers know, and `PyO3` does not: those that the stub names.

use std::marker::PhantomData;
use std::ops::Deref;

use numpy::{PyArrayDyn, PyReadonlyArray2};
#[cfg(feature = "stub")]
use pyo3::inspect::PyStaticExpr;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Anything that `NumPy` converts to an array of real numbers.
pub type ArrayLike<'py> = As<hints::ArrayLike, Bound<'py, PyAny>>;
/// An array of numbers.
pub type Numbers<'py, T = f64> = As<hints::Array<T>, Bound<'py, PyArrayDyn<T>>>;
/// A result, over the leading axes and its own.
pub type Array<'py> = PyResult<Numbers<'py>>;
/// An argument that may be left out.
pub type Given<'py> = Option<ArrayLike<'py>>;
/// An array of numbers with two axes, as an argument.
pub type Rows<'py> = As<hints::Array<f64>, PyReadonlyArray2<'py, f64>>;
/// A dictionary of values by names.
pub type Dict<'py, V = hints::Any> = As<hints::Dict<V>, Bound<'py, PyDict>>;
/// What is read from a dictionary.
pub type Keys<T> = As<hints::Dict<hints::Any>, T>;
/// The dictionary that `crane.info` describes.
pub type Info<'py> = As<hints::Info, Bound<'py, PyDict>>;
/// A function that receives the numbers of finished and of all rows.
pub type Progress = As<hints::Progress, Py<PyAny>>;

/// A value, and what Python calls its type.
pub struct As<H, T>(pub T, PhantomData<H>);

impl<H, T> From<T> for As<H, T> {
    fn from(value: T) -> Self {
        Self(value, PhantomData)
    }
}

impl<H, T> Deref for As<H, T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<'a, 'py, H: hints::Hint, T: FromPyObject<'a, 'py>> FromPyObject<'a, 'py> for As<H, T> {
    type Error = T::Error;

    #[cfg(feature = "stub")]
    const INPUT_TYPE: PyStaticExpr = H::HINT;

    fn extract(object: Borrowed<'a, 'py, PyAny>) -> Result<Self, T::Error> {
        T::extract(object).map(Self::from)
    }
}

impl<'py, H: hints::Hint, T: IntoPyObject<'py>> IntoPyObject<'py> for As<H, T> {
    type Target = T::Target;
    type Output = T::Output;
    type Error = T::Error;

    #[cfg(feature = "stub")]
    const OUTPUT_TYPE: PyStaticExpr = H::HINT;

    fn into_pyobject(self, py: Python<'py>) -> Result<T::Output, T::Error> {
        self.0.into_pyobject(py)
    }
}

/// What Python calls the types.
pub mod hints {
    use std::marker::PhantomData;

    #[cfg(feature = "stub")]
    use pyo3::inspect::PyStaticExpr;
    #[cfg(feature = "stub")]
    use pyo3::{type_hint_identifier as named, type_hint_subscript as of, type_hint_union};

    /// The name of a type.
    pub trait Hint {
        /// The name.
        #[cfg(feature = "stub")]
        const HINT: PyStaticExpr;
    }

    /// Anything.
    pub struct Any;
    /// A real number.
    pub struct Float;
    /// A whole number.
    pub struct Int;
    /// What becomes an array.
    pub struct ArrayLike;
    /// An array of such elements.
    pub struct Array<T>(PhantomData<T>);
    /// A dictionary of such values by names.
    pub struct Dict<V>(PhantomData<V>);
    /// What `crane.info` describes.
    pub struct Info;
    /// A function that receives two counts.
    pub struct Progress;

    macro_rules! hints {
        ($($type:ty $([$($generic:tt)*])? = $name:expr;)*) => {
            $(impl$(<$($generic)*>)? Hint for $type {
                #[cfg(feature = "stub")]
                const HINT: PyStaticExpr = $name;
            })*
        };
    }

    hints! {
        Any = named!("typing", "Any");
        Float = named!("builtins", "float");
        Int = named!("builtins", "int");
        ArrayLike = named!("numpy.typing", "ArrayLike");
        Array<f64> = of!(named!("numpy.typing", "NDArray"), named!("numpy", "float64"));
        Array<u8> = of!(named!("numpy.typing", "NDArray"), named!("numpy", "uint8"));
        Dict<V> [V: Hint] = of!(named!("builtins", "dict"), named!("builtins", "str"), V::HINT);
        Option<V> [V: Hint] = type_hint_union!(V::HINT, <pyo3::types::PyNone as pyo3::PyTypeInfo>::TYPE_HINT);
        Info = named!("crane.info", "Info");
        Progress = of!(
            named!("collections.abc", "Callable"),
            PyStaticExpr::List { elts: &[Int::HINT, Int::HINT] },
            Any::HINT
        );
    }
}
