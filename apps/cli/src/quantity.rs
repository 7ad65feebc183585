//! Numbers with units, as arguments.

use crane_codegen::units::number_in;

use crate::problem::{Outcome, Problem};

/// A finite number of something, in a unit or with one of the same dimension.
///
/// # Errors
/// It is neither.
pub fn number(unit: &str, text: &str, subject: &str) -> Outcome<f64> {
    number_in(unit, text, subject).map_err(|wrong| Problem::usage(wrong.problem, wrong.help))
}

/// Whether a number has no unit.
pub fn is_bare(text: &str) -> bool {
    text.trim().parse::<f64>().is_ok()
}
