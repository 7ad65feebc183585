//! Exceptions and warnings.

use crane_codegen::Diagnostics;
use pyo3::exceptions::PyValueError;
use pyo3::import_exception;
use pyo3::prelude::*;

import_exception!(crane.mistakes, SpecError);
import_exception!(crane.mistakes, ParameterError);
import_exception!(crane.mistakes, NoEquilibrium);
import_exception!(crane.mistakes, SpecWarning);
import_exception!(crane.mistakes, InvalidRowWarning);

/// The mistakes of a spec as an exception that prints them as the command draws them; its `codes` are those of the rules.
pub fn spec_error(py: Python<'_>, mistakes: &Diagnostics) -> PyErr {
    let codes: Vec<&str> = mistakes.mistakes().iter().map(|mistake| mistake.code).collect();
    let error = SpecError::new_err(format!("\n{}", mistakes.to_string().trim_end()));
    match error.value(py).setattr("codes", codes) {
        Ok(()) => error,
        Err(other) => other,
    }
}

/// Warns of implausible parts of a spec.
pub fn warn_of_spec(py: Python<'_>, warnings: &Diagnostics) -> PyResult<()> {
    if warnings.is_empty() {
        return Ok(());
    }
    warn(py, &py.get_type::<SpecWarning>(), format!("\n{}", warnings.to_string().trim_end()))
}

/// Issues a warning at the caller of the package's function.
pub fn warn(py: Python<'_>, category: &Bound<'_, PyAny>, message: String) -> PyResult<()> {
    let message = std::ffi::CString::new(message.replace('\0', "\u{fffd}"))?;
    PyErr::warn(py, category, &message, 1)
}

/// Treatment of rows that cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Invalid {
    /// Raise an exception that names the first.
    Raise,
    /// Make their results NaN, and warn of all.
    Nan,
}

impl Invalid {
    /// By its name.
    pub fn named(name: &str) -> PyResult<Self> {
        match name {
            "raise" => Ok(Invalid::Raise),
            "nan" => Ok(Invalid::Nan),
            other => Err(PyValueError::new_err(format!("invalid={other:?}: write \"raise\" or \"nan\""))),
        }
    }
}

/// A row that cannot be computed, and why.
#[derive(Clone, Debug)]
pub struct BadRow {
    /// Its index.
    pub row: usize,
    /// Why.
    pub reason: String,
}

/// Maximum number of rows that a warning lists one by one.
const TOLD: usize = 5;

/// Warns of bad rows of a batch of this shape.
pub fn warn_of_rows(py: Python<'_>, bad: &[BadRow], shape: &[usize]) -> PyResult<()> {
    warn_of_numbers(py, "results", bad, shape)
}

/// Warns of rows of which some numbers are missing.
pub fn warn_of_numbers(py: Python<'_>, what: &str, bad: &[BadRow], shape: &[usize]) -> PyResult<()> {
    if bad.is_empty() {
        return Ok(());
    }
    let mut texts: Vec<String> = bad.iter().take(TOLD).map(|bad| describe(bad, shape)).collect();
    if bad.len() > TOLD {
        texts.push(format!("{} more", bad.len() - TOLD));
    }
    let category = py.get_type::<InvalidRowWarning>();
    warn(py, &category, format!("{what} of {} rows are NaN: {}", bad.len(), texts.join("; ")))
}

/// A bad row in words: its index, and why.
pub fn describe(bad: &BadRow, shape: &[usize]) -> String {
    if shape.is_empty() { bad.reason.clone() } else { format!("row {}: {}", index(bad.row, shape), bad.reason) }
}

/// The index of a row in an array of this shape.
fn index(row: usize, shape: &[usize]) -> String {
    let mut rest = row;
    let mut places: Vec<String> = shape
        .iter()
        .rev()
        .map(|size| {
            let position = rest % size.max(&1);
            rest /= size.max(&1);
            position.to_string()
        })
        .collect();
    places.reverse();
    if places.len() == 1 { format!("[{}]", places[0]) } else { format!("[{}]", places.join(", ")) }
}
