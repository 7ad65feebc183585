//! Arguments as rows, and results as arrays.

use std::borrow::Cow;

use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;

use crane_model::Description;

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
        if let Ok(number) = object.extract::<f64>() {
            return Ok(Self { shape: Vec::new(), numbers: vec![number], width: 1 });
        }
        let (shape, numbers) = read(name, object)?;
        Ok(Self { shape, numbers, width: 1 })
    }

    /// As many numbers per row as the crane has coordinates: `q`, `v`, `a`.
    pub fn coordinates(name: &str, object: &Bound<'_, PyAny>, description: &Description) -> PyResult<Self> {
        let (mut shape, numbers) = read(name, object)?;
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
        let own = (0..rows).map(|row| {
            let (mut rest, mut place, mut stride) = (row, 0, 1);
            for (axis, size) in shape.iter().rev().enumerate() {
                let own = self.shape.iter().rev().nth(axis).copied().unwrap_or(1);
                if own > 1 {
                    place += rest % size * stride;
                    stride *= own;
                }
                rest /= size;
            }
            place
        });
        Cow::Owned(own.flat_map(|place| &self.numbers[place * self.width..(place + 1) * self.width]).copied().collect())
    }
}

/// Shape and numbers of anything that `NumPy` converts to an array.
fn read(name: &str, object: &Bound<'_, PyAny>) -> PyResult<(Vec<usize>, Vec<f64>)> {
    if let Ok(array) = object.cast::<PyArrayDyn<f64>>()
        && let Ok(numbers) = array.to_vec()
    {
        return Ok((array.shape().to_vec(), numbers));
    }
    let py = object.py();
    let numpy = py.import(intern!(py, "numpy"))?;
    let array = numpy.call_method1(intern!(py, "ascontiguousarray"), (object, intern!(py, "float64")));
    let array = array.map_err(|error| {
        let wrong = PyTypeError::new_err(format!("{name} is not an array of numbers: {}", error.value(py)));
        wrong.set_cause(py, Some(error));
        wrong
    })?;
    let array = array.cast_into::<PyArrayDyn<f64>>()?;
    // A single number becomes an array of one axis.
    let axes = object.getattr(intern!(py, "ndim")).and_then(|axes| axes.extract::<usize>());
    let scalar = axes.map_or_else(|_| object.extract::<f64>().is_ok(), |axes| axes == 0);
    let shape = if scalar { Vec::new() } else { array.shape().to_vec() };
    Ok((shape, array.to_vec()?))
}

/// Arguments over the leading axes of all of them.
pub struct Joined<'a> {
    /// Leading axes.
    pub shape: Vec<usize>,
    /// Each argument, with that many rows, or with one for all.
    pub arguments: Vec<Cow<'a, [f64]>>,
}

impl<'a> Joined<'a> {
    /// Broadcasts as `NumPy` does.
    pub fn new(arguments: &[(&str, &'a Argument)]) -> PyResult<Self> {
        let mut shape: Vec<usize> = Vec::new();
        for (name, argument) in arguments {
            let own = &argument.shape;
            if own.len() > shape.len() {
                shape.splice(0..0, std::iter::repeat_n(1, own.len() - shape.len()));
            }
            let begin = shape.len() - own.len();
            for (joint, own) in shape[begin..].iter_mut().zip(own) {
                match (*joint, *own) {
                    (joint, own) if joint == own => {}
                    (1, own) => *joint = own,
                    (_, 1) => {}
                    (size, own) => {
                        return Err(PyValueError::new_err(format!(
                            "the leading axes of {name} do not match those of the other arguments: {own} and {size}"
                        )));
                    }
                }
            }
        }
        let arguments = arguments.iter().map(|(_, argument)| argument.over(&shape)).collect();
        Ok(Self { shape, arguments })
    }

    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.shape.iter().product()
    }
}

/// An array of zeros with leading axes and those of a row.
pub fn zeros<'py>(py: Python<'py>, shape: &[usize], own: &[usize]) -> Bound<'py, PyArrayDyn<f64>> {
    PyArrayDyn::zeros(py, [shape, own].concat(), false)
}

/// Numbers as an array with leading axes and those of a row.
pub fn array<'py>(
    py: Python<'py>,
    numbers: Vec<f64>,
    shape: &[usize],
    own: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    numpy::PyArray1::from_vec(py, numbers).reshape([shape, own].concat())
}
