//! What loops that transmit forces add to the stiffness.

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{Arguments, Functions};

use super::evaluation::Evaluation;
use crate::LiveCrane;
use crate::dual::{DIRECTIONS, Dual8};

/// Numbers, of which some from the `first` one on have slopes, each in a direction of its own.
fn numbers(values: &[f64], first: usize) -> Vec<Dual8> {
    let along = |i: usize| i.checked_sub(first).filter(|direction| *direction < DIRECTIONS);
    values.iter().enumerate().map(|(i, value)| Dual8::along(*value, along(i))).collect()
}

/// `∂(Jᵀ λ)/∂q`, column by column.
pub fn loop_stiffness(crane: &LiveCrane, q: &[f64], multipliers: &[f64], out: &mut [f64]) {
    let n = crane.size();
    let mut jacobians = Evaluation::<Dual8>::new(crane, FunctionId::LoopJacobians);
    out.fill(0.0);
    for first in (0..n).step_by(DIRECTIONS) {
        let rows = jacobians.results_at(&Arguments { q: &numbers(q, first), ..Arguments::none() });
        for (multiplier, row) in multipliers.iter().zip(rows.chunks_exact(n)) {
            for (direction, column) in out.chunks_exact_mut(n).skip(first).take(DIRECTIONS).enumerate() {
                column.iter_mut().zip(row).for_each(|(sum, entry)| *sum += multiplier * entry.slope(direction));
            }
        }
    }
}
