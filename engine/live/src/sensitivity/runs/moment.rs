//! Derivatives of the rates of a motion at one moment, by the motion and by inputs that are set.
//!
//! Rates are those of `[q, v, x]`: with the states x of forces, and on closed loops.

use crane_model::Description;
use crane_model::dyn_crane::Functions;
use crane_model::dynamics::{NotFinite, gradients};

use super::Along;
use super::directions::Directions;
use super::transposed::Transposed;
use crate::LiveCrane;
use crate::assemble::TooLarge;

/// A change of a motion, and of all inputs of its crane.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Of `[q, v, x]`.
    pub motion: Vec<f64>,
    /// Of the values of inputs.
    pub inputs: Vec<f64>,
}

/// Changes of the rates of a motion at a time, s, with each of some changes; eight at once cost hardly more than one.
///
/// # Errors
/// A rate or its change is not finite.
pub fn push_rates(crane: &LiveCrane, moment: (f64, &[f64]), along: &[Change]) -> Result<Vec<Vec<f64>>, NotFinite> {
    let (motions, inputs): (Vec<_>, Vec<_>) =
        along.iter().map(|change| (change.motion.clone(), &*change.inputs)).unzip();
    gradients::push_rates(crane, &mut Directions::with_inputs(crane, &inputs), moment, &motions)
}

/// The derivatives of the sum of rates at a time, s, times weights: by the motion, and by all inputs.
///
/// # Errors
/// A function of the crane needs too many registers.
pub fn pull_rates(
    crane: &LiveCrane,
    moment: (f64, &[f64]),
    weights: &[f64],
) -> Result<Result<Change, NotFinite>, TooLarge> {
    let Description { inputs, .. } = crane.description();
    let along: Vec<Along> = (0..inputs.len()).map(Along::Input).collect();
    let mut functions = Transposed::new(crane, &along)?;
    Ok(gradients::pull_rates(crane, &mut functions, moment, weights)
        .map(|sum| Change { motion: sum.motion, inputs: sum.numbers }))
}
