//! Small motions about any motion, by exact derivatives of the forces that it requires.

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{DynDynamics, DynLineariseMotion, DynModel};

use crate::LiveCrane;
use crate::dual::{DIRECTIONS, Dual8};
use crate::machine::Number;
use crate::rows::Evaluation;

/// Numbers, of which some from the `first` one on have slopes, each in a direction of its own.
fn numbers(values: &[f64], first: Option<usize>) -> Vec<Dual8> {
    let along = |i: usize| first.and_then(|first| i.checked_sub(first)).filter(|direction| *direction < DIRECTIONS);
    values.iter().enumerate().map(|(i, value)| Dual8::along(*value, along(i))).collect()
}

/// `∂(Jᵀ λ)/∂q`, column by column.
pub fn loop_stiffness(crane: &LiveCrane, q: &[f64], multipliers: &[f64], out: &mut [f64]) {
    let n = crane.size();
    let (mut jacobians, rest) =
        (Evaluation::<Dual8>::new(crane, FunctionId::LoopJacobians), vec![Dual8::splat(0.0); n]);
    out.fill(0.0);
    for first in (0..n).step_by(DIRECTIONS) {
        let rows = jacobians.at(Dual8::splat(0.0), &numbers(q, Some(first)), &rest, &rest);
        for (multiplier, row) in multipliers.iter().zip(rows.chunks_exact(n)) {
            for (direction, column) in out.chunks_exact_mut(n).skip(first).take(DIRECTIONS).enumerate() {
                column.iter_mut().zip(row).for_each(|(sum, entry)| *sum += multiplier * entry.slope(direction));
            }
        }
    }
}

impl DynLineariseMotion for LiveCrane {
    fn linearise_motion(
        &self,
        t: f64,
        [q, v, a]: [&[f64]; 3],
        mass: &mut [f64],
        stiffness: &mut [f64],
        damping: &mut [f64],
    ) {
        let n = self.size();
        self.mass_matrix(q, mass);
        // A a − e, and f.
        let quantities = [FunctionId::InverseDynamics, FunctionId::Forces];
        let mut forces = quantities.map(|quantity| Evaluation::<Dual8>::new(self, quantity));
        let (t, a) = (Dual8::splat(t), numbers(a, None));
        for first in (0..n).step_by(DIRECTIONS) {
            for (of_rates, columns) in [(false, &mut *stiffness), (true, &mut *damping)] {
                let q = numbers(q, (!of_rates).then_some(first));
                let v = numbers(v, of_rates.then_some(first));
                let [required, given] = &mut forces;
                let (required, given) = (required.at(t, &q, &v, &a), given.at(t, &q, &v, &a));
                for (direction, column) in columns.chunks_exact_mut(n).skip(first).take(DIRECTIONS).enumerate() {
                    for (entry, (required, given)) in column.iter_mut().zip(required.iter().zip(given)) {
                        *entry = required.slope(direction) - given.slope(direction);
                    }
                }
            }
        }
        // Prescribed coordinates do not move: as in small motions about a pose at rest, each is a separate oscillator with 1 rad/s.
        for j in self.description().prescribed() {
            for (matrix, diagonal) in [(&mut *mass, 1.0), (&mut *stiffness, 1.0), (&mut *damping, 0.0)] {
                for k in 0..n {
                    (matrix[j + n * k], matrix[k + n * j]) = (0.0, 0.0);
                }
                matrix[j + n * j] = diagonal;
            }
        }
    }
}
