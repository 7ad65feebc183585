//! Arguments as rows, and results as arrays.

use std::borrow::Cow;

use numpy::{PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyFloat, PyInt, PyList, PyString};

use crane_codegen::units::number_in;
use crane_model::Description;

use crate::types::{ArrayLike, Numbers};

/// An argument: numbers, row after row, over leading axes.
#[derive(Clone, Debug, Default)]
pub struct Argument {
    /// Leading axes.
    pub shape: Vec<usize>,
    /// Numbers of all rows.
    pub numbers: Vec<f64>,
    /// Numbers of a row.
    pub width: usize,
}

impl Argument {
    /// One number per row: `t`.
    pub fn scalars(name: &str, object: &Bound<'_, PyAny>) -> PyResult<Self> {
        if object.is_instance_of::<PyFloat>() || object.is_instance_of::<PyInt>() {
            return Ok(Self { shape: Vec::new(), numbers: vec![object.extract()?], width: 1 });
        }
        let (shape, numbers) = read_numbers(name, object)?;
        Ok(Self { shape, numbers, width: 1 })
    }

    /// The same of what has a unit: also one number with a unit of the same dimension, as text, `payload="1.5 t"`.
    pub fn scalars_in(unit: &str, name: &str, object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let Ok(text) = object.cast::<PyString>() else { return Self::scalars(name, object) };
        let text = text.to_str()?;
        if text.trim().parse::<f64>().is_ok() {
            return Self::scalars(name, object);
        }
        let number = number_in(unit, text, name);
        let number = number.map_err(|wrong| PyValueError::new_err(format!("{}: {}", wrong.problem, wrong.help)))?;
        Ok(Self { shape: Vec::new(), numbers: vec![number], width: 1 })
    }

    /// As many numbers per row as the crane has coordinates: `q`, `v`, `a`.
    pub fn coordinates(name: &str, object: &Bound<'_, PyAny>, description: &Description) -> PyResult<Self> {
        let named = by_name(name, object, description)?;
        let (mut shape, numbers) = read_numbers(name, named.as_ref().unwrap_or(object))?;
        let width = description.coordinates.len();
        let last = shape.pop();
        if last != Some(width) {
            let coordinates: Vec<&str> = description.coordinates.iter().map(|coordinate| &*coordinate.name).collect();
            let has = last.map_or("is one number".to_owned(), |last| format!("has {last} numbers in its last axis"));
            return Err(PyValueError::new_err(format!(
                "{name} {has}, but {} has {width} coordinates: {}",
                description.name,
                coordinates.join(", ")
            )));
        }
        Ok(Self { shape, numbers, width })
    }

    /// A number per row for each of `width` things, `of`.
    pub fn of_width(name: &str, object: &Bound<'_, PyAny>, width: usize, of: &str) -> PyResult<Self> {
        let (mut shape, numbers) = read_numbers(name, object)?;
        match shape.pop() {
            Some(last) if last == width => Ok(Self { shape, numbers, width }),
            // A list without numbers: not given.
            Some(0) => Ok(Self::none()),
            _ => Err(PyValueError::new_err(format!("{name} needs {width} numbers in its last axis: {of}"))),
        }
    }

    /// Nothing: an argument that was not given.
    pub fn none() -> Self {
        Self::default()
    }

    /// How many rows it has.
    pub fn rows(&self) -> usize {
        self.shape.iter().product()
    }

    /// Its rows broadcast to a larger shape, unless one row applies to all.
    fn over(&self, shape: &[usize]) -> Cow<'_, [f64]> {
        if self.rows() == 1 || self.shape == shape {
            return Cow::Borrowed(&self.numbers);
        }
        let rows: usize = shape.iter().product();
        let length = (0..rows).map(|row| {
            let (mut rest, mut index, mut stride) = (row, 0, 1);
            for (axis, size) in shape.iter().rev().enumerate() {
                let length = self.shape.iter().rev().nth(axis).copied().unwrap_or(1);
                if length > 1 {
                    index += rest % size * stride;
                    stride *= length;
                }
                rest /= size;
            }
            index
        });
        Cow::Owned(
            length.flat_map(|index| &self.numbers[index * self.width..(index + 1) * self.width]).copied().collect(),
        )
    }
}

/// Columns of a data frame, or entries of a series, in the order of the coordinates after which they are called; those of v may also have the
/// names of rates. Nothing for what has no names.
fn by_name<'py>(
    name: &str,
    object: &Bound<'py, PyAny>,
    description: &Description,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let py = object.py();
    if object.is_exact_instance_of::<PyUntypedArray>() || object.is_instance_of::<PyList>() {
        return Ok(None);
    }
    let labels = if object.hasattr(intern!(py, "columns"))? {
        object.getattr(intern!(py, "columns"))?
    } else if object.hasattr(intern!(py, "iloc"))? {
        object.getattr(intern!(py, "index"))?
    } else {
        return Ok(None);
    };
    let labels = labels.try_iter()?.map(|label| label?.extract::<String>());
    let Ok(labels) = labels.collect::<PyResult<Vec<String>>>() else { return Ok(None) };
    let coordinates = || description.coordinates.iter().map(|coordinate| &*coordinate.name);
    let called = |label: &str, coordinate: &str| {
        label == coordinate || (name == "v" && label.strip_suffix("_rate") == Some(coordinate))
    };
    let found = coordinates().map(|coordinate| labels.iter().find(|label| called(label, coordinate)));
    match found.collect::<Option<Vec<&String>>>() {
        Some(found) if found.len() == labels.len() => object.get_item(found).map(Some),
        _ => Err(PyValueError::new_err(format!(
            "{name} has columns that are not called after the coordinates of {}: write frame[c.coordinates], or frame.to_numpy() if they are in \
             the order of its coordinates: {}",
            description.name,
            coordinates().collect::<Vec<_>>().join(", ")
        ))),
    }
}

/// Shape and numbers of anything that `NumPy` converts to an array of real numbers, in the order of its indices: the last one varies
/// fastest, however the array lies in memory.
fn read_numbers(name: &str, object: &Bound<'_, PyAny>) -> PyResult<(Vec<usize>, Vec<f64>)> {
    if object.is_exact_instance_of::<PyUntypedArray>()
        && let Ok(array) = object.cast::<PyArrayDyn<f64>>()
        && array.is_c_contiguous()
        && array.data().is_aligned()
        && let Ok(numbers) = array.to_vec()
    {
        return Ok((array.shape().to_vec(), numbers));
    }
    let array = convert(object.py(), name, object)?;
    Ok((array.shape().to_vec(), array.to_vec()?))
}

/// A new array of the numbers of anything that `NumPy` converts to an array of real numbers; masked ones are NaN.
/// `TypeError` names what is none.
#[pyfunction]
pub fn real_array<'py>(py: Python<'py>, name: &str, object: ArrayLike<'py>) -> PyResult<Numbers<'py>> {
    convert(py, name, &object).map(Numbers::from)
}

fn convert<'py>(py: Python<'py>, name: &str, object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let numpy = py.import(intern!(py, "numpy"))?;
    let given = numpy.call_method1(intern!(py, "asanyarray"), (object,)).map_err(|error| {
        let wrong = PyTypeError::new_err(format!("{name} is not an array of numbers: {}", error.value(py)));
        wrong.set_cause(py, Some(error));
        wrong
    })?;
    let kind = given.cast::<PyUntypedArray>()?.dtype().kind();
    let refused = |holds: &str, help: &str| Err(PyTypeError::new_err(format!("{name} {holds}, not numbers: {help}")));
    match kind {
        b'f' | b'i' | b'u' | b'b' => {}
        b'c' => {
            return refused(
                "holds complex numbers",
                "give its real part; derivatives by complex steps are not possible",
            );
        }
        b'U' | b'S' | b'T' => return refused("holds text", "write float(...), or .astype(float) of an array"),
        b'M' | b'm' => return refused("holds dates or times", "give seconds as numbers"),
        b'O' => return refused("holds Python objects", "if all are numbers, give .astype(float) of it"),
        _ => return refused("holds records", "give one field, or an array of floats"),
    }
    let in_order = [("order", "C")].into_py_dict(py)?;
    let copy = numpy.call_method(intern!(py, "array"), (&given, intern!(py, "float64")), Some(&in_order))?;
    let masked = numpy.getattr(intern!(py, "ma"))?;
    if given.is_instance(&masked.getattr(intern!(py, "MaskedArray"))?)? {
        copy.set_item(masked.call_method1(intern!(py, "getmaskarray"), (&given,))?, f64::NAN)?;
    }
    Ok(copy.cast_into()?)
}

/// Arguments over the leading axes of all of them.
pub struct Joined<'a> {
    /// Leading axes.
    pub shape: Vec<usize>,
    /// Each argument, with that many rows, or with one for all.
    pub arguments: Vec<Cow<'a, [f64]>>,
    /// Its name, and how many numbers a row of it has.
    pub names: Vec<(&'a str, usize)>,
}

impl<'a> Joined<'a> {
    /// Broadcasts as `NumPy` does.
    pub fn new(arguments: &[(&'a str, &'a Argument)]) -> PyResult<Self> {
        let mut shape: Vec<usize> = Vec::new();
        for (name, argument) in arguments {
            let axes = &argument.shape;
            if axes.len() > shape.len() {
                shape.splice(0..0, std::iter::repeat_n(1, axes.len() - shape.len()));
            }
            let begin = shape.len() - axes.len();
            for (joint, axes) in shape[begin..].iter_mut().zip(axes) {
                match (*joint, *axes) {
                    (joint, axes) if joint == axes => {}
                    (1, axes) => *joint = axes,
                    (_, 1) => {}
                    (size, axes) => {
                        return Err(PyValueError::new_err(format!(
                            "the leading axes of {name} do not match those of the other arguments: {axes} and {size}"
                        )));
                    }
                }
            }
        }
        let names = arguments.iter().map(|(name, argument)| (*name, argument.width)).collect();
        let arguments = arguments.iter().map(|(_, argument)| argument.over(&shape)).collect();
        Ok(Self { shape, arguments, names })
    }

    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.shape.iter().product()
    }

    /// A row of an argument, by its index, of `width` numbers; empty if the argument was not given.
    pub fn row(&self, argument: usize, width: usize, row: usize) -> &[f64] {
        let numbers = &self.arguments[argument];
        let row = if numbers.len() <= width { 0 } else { row };
        numbers.get(row * width..(row + 1) * width).unwrap_or_default()
    }
}

/// An array of zeros with leading axes and those of a row.
pub fn zeros<'py>(py: Python<'py>, shape: &[usize], of_row: &[usize]) -> Bound<'py, PyArrayDyn<f64>> {
    PyArrayDyn::zeros(py, [shape, of_row].concat(), false)
}

/// An array that cannot be changed: a change would not change a crane.
pub fn fixed(numbers: Bound<'_, PyArrayDyn<f64>>) -> Numbers<'_> {
    numbers.readwrite().make_nonwriteable();
    numbers.into()
}

/// Numbers as an array with leading axes and those of a row.
pub fn array<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    shape: &[usize],
    of_row: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    numpy::PyArray1::from_vec(py, numbers).reshape([shape, of_row].concat())
}
