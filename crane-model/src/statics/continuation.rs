//! The path of equilibria from the guess, held by springs, to the crane under its whole load.

use nalgebra::{DMatrix, DVector, SVector};

use super::{Equilibrium, balance::Balance};
use crate::Statics;

/// Greatest change of a coordinate in a step, m or rad, and of λ.
const LONGEST: f64 = 0.3;
/// A step as short as this leads nowhere.
const SHORTEST: f64 = 1e-9;
/// Newton steps back to the path: where it takes more, the step was too long.
const CORRECTIONS: usize = 6;
/// Corrections up to which the next step may be twice as long.
const EASY: usize = 3;
/// Scaled residual of a point of the path: only the end has to be exact.
const ON_PATH: f64 = 1e-6;

/// Follows `H(q, λ) = λ r(q) + (1 − λ) S (q − q₀) = 0` from `(q₀, 0)` on. At λ = 1 `arrive` gets the pose, the number of
/// steps and the residual, and may end the search.
pub(super) fn follow<const N: usize, C, R, A>(
    crane: &C,
    start: &SVector<f64, N>,
    steps: usize,
    balance: &Balance<N>,
    residual_at: &mut R,
    arrive: &mut A,
) -> Option<Equilibrium>
where
    C: Statics<N>,
    R: FnMut(&SVector<f64, N>) -> SVector<f64, N>,
    A: FnMut(&SVector<f64, N>, usize, &mut R) -> Option<Equilibrium>,
{
    let springs = balance.springs(&crane.tangent_stiffness(start));
    let mut path = Path { crane, start, springs, balance, residual_at };
    // A point is q and λ in one vector; the path sets out towards greater λ.
    let mut point = DVector::from_fn(N + 1, |i, _| if i < N { start[i] } else { 0.0 });
    let ahead = DVector::from_fn(N + 1, |i, _| if i < N { 0.0 } else { 1.0 });
    let mut tangent = path.tangent(&point, &ahead)?;
    let mut length = LONGEST;

    for step in 1..=steps {
        let (next, corrections) = loop {
            if length < SHORTEST {
                return None;
            }
            // Not beyond the whole load.
            let left = if tangent[N] > 0.0 { (1.0 - point[N]) / tangent[N] } else { f64::INFINITY };
            match path.corrected(&point + &tangent * length.min(left), &tangent) {
                Some(found) => break found,
                None => length = length.min(left) / 2.0,
            }
        };
        if next[N] >= 1.0 - ON_PATH {
            let pose = SVector::from_fn(|i, _| next[i]);
            return arrive(&pose, step, path.residual_at);
        }
        tangent = path.tangent(&next, &tangent)?;
        point = next;
        if corrections <= EASY {
            length *= 2.0;
        }
        length = length.min(LONGEST / tangent.amax());
    }
    None
}

/// The equations of the path.
struct Path<'a, const N: usize, C, R> {
    crane: &'a C,
    start: &'a SVector<f64, N>,
    /// S, N/m and N m/rad.
    springs: SVector<f64, N>,
    balance: &'a Balance<N>,
    residual_at: &'a mut R,
}

impl<const N: usize, C: Statics<N>, R: FnMut(&SVector<f64, N>) -> SVector<f64, N>> Path<'_, N, C, R> {
    /// Scaled H at a point, and its derivatives by q and λ above the row `last`.
    fn system(&mut self, point: &DVector<f64>, last: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let (q, load) = (SVector::from_fn(|i, _| point[i]), point[N]);
        let (residual, stiffness) = ((self.residual_at)(&q), self.crane.tangent_stiffness(&q));
        let held = (q - self.start).component_mul(&self.springs);
        let value = self.balance.scaled(&(residual * load + held * (1.0 - load)));
        let by_load = self.balance.scaled(&(residual - held));
        let matrix = DMatrix::from_fn(N + 1, N + 1, |i, j| match (i < N, j < N) {
            (true, true) if i == j => self.balance.row(i, stiffness[(i, j)] * load + self.springs[i] * (1.0 - load)),
            (true, true) => self.balance.row(i, stiffness[(i, j)] * load),
            (true, false) => by_load[i],
            (false, _) => last[j],
        });
        (DVector::from_fn(N + 1, |i, _| if i < N { value[i] } else { 0.0 }), matrix)
    }

    /// Direction of the path at a point of it, of length 1, onward from the direction before.
    fn tangent(&mut self, point: &DVector<f64>, before: &DVector<f64>) -> Option<DVector<f64>> {
        let (_, matrix) = self.system(point, before);
        let along = DVector::from_fn(N + 1, |i, _| if i < N { 0.0 } else { 1.0 });
        let direction = matrix.lu().solve(&along)?;
        let length = direction.norm();
        length.is_normal().then(|| direction / length)
    }

    /// The point of the path across its tangent from `point`, and how many corrections it took.
    fn corrected(&mut self, mut point: DVector<f64>, tangent: &DVector<f64>) -> Option<(DVector<f64>, usize)> {
        for correction in 0..=CORRECTIONS {
            let (value, matrix) = self.system(&point, tangent);
            if value.norm() <= ON_PATH {
                return Some((point, correction));
            }
            let step = matrix.lu().solve(&value)?;
            if !step.iter().all(|change| change.abs() <= LONGEST) {
                return None;
            }
            point -= step;
        }
        None
    }
}
