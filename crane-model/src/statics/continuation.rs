//! The path of equilibria from the guess, held by springs, to the crane under its whole load.

use nalgebra::{DMatrix, DVector};

use super::{equations::Equations, residual_scale::ResidualScale};

/// Maximum change of a coordinate in a step, m or rad, and of λ.
const LONGEST: f64 = 0.3;
/// A step as short as this makes no progress.
const SHORTEST: f64 = 1e-9;
/// Newton steps back to the path: where it takes more, the step was too long.
const CORRECTIONS: usize = 6;
/// Corrections up to which the next step may be twice as long.
const EASY: usize = 3;
/// Scaled residual of a point of the path: only the end has to be exact.
const ON_PATH: f64 = 1e-6;

/// Called at the full load with the pose and the number of steps.
pub(super) type Arrive<'a, T> = dyn FnMut(DVector<f64>, usize) -> Option<T> + 'a;

/// Follows `H(q, λ) = λ r(q) + (1 − λ) S (q − q₀) = 0` from `(q₀, 0)` on. At λ = 1 `arrive` gets the pose and the number of
/// steps, and may end the search.
pub(super) fn follow<T>(
    equations: &Equations<'_>,
    start: &DVector<f64>,
    steps: usize,
    scale: &ResidualScale,
    arrive: &mut Arrive<'_, T>,
) -> Option<T> {
    let n = start.len();
    let springs = scale.springs(&equations.stiffness(start));
    let path = Path { equations, start, springs, scale };
    // A point is q and λ in one vector; the path starts towards increasing λ.
    let mut point = start.clone().push(0.0);
    let ahead = DVector::zeros(n).push(1.0);
    let mut tangent = path.tangent(&point, &ahead)?;
    let mut length = LONGEST;

    for step in 1..=steps {
        let (next, corrections) = loop {
            if length < SHORTEST {
                return None;
            }
            // Not beyond the full load.
            let left = if tangent[n] > 0.0 { (1.0 - point[n]) / tangent[n] } else { f64::INFINITY };
            match path.corrected(&point + &tangent * length.min(left), &tangent) {
                Some(found) => break found,
                None => length = length.min(left) / 2.0,
            }
        };
        if next[n] >= 1.0 - ON_PATH {
            return arrive(next.remove_row(n), step);
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
struct Path<'a> {
    equations: &'a Equations<'a>,
    start: &'a DVector<f64>,
    /// S, N/m and N m/rad.
    springs: DVector<f64>,
    scale: &'a ResidualScale,
}

impl Path<'_> {
    /// Scaled H at a point, and its derivatives with respect to q and λ, followed by the row `last`.
    fn system(&self, point: &DVector<f64>, last: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let n = self.start.len();
        let (q, load) = (point.rows(0, n).into_owned(), point[n]);
        let held = (&q - self.start).component_mul(&self.springs);
        let (value, by_pose, by_load) = self.equations.partly_loaded(&q, load, &held, &self.springs);
        let (value, by_load) = (self.scale.scaled(&value), self.scale.scaled(&by_load));
        let matrix = DMatrix::from_fn(n + 1, n + 1, |i, j| match (i < n, j < n) {
            (true, true) => self.scale.row(i, by_pose[(i, j)]),
            (true, false) => by_load[i],
            (false, _) => last[j],
        });
        (value.push(0.0), matrix)
    }

    /// Unit tangent of the path at one of its points, oriented like the previous direction.
    fn tangent(&self, point: &DVector<f64>, before: &DVector<f64>) -> Option<DVector<f64>> {
        let (_, matrix) = self.system(point, before);
        let along = DVector::zeros(self.start.len()).push(1.0);
        let direction = matrix.lu().solve(&along)?;
        let length = direction.norm();
        length.is_normal().then(|| direction / length)
    }

    /// The point of the path perpendicular to the tangent from `point`, and the number of corrections.
    fn corrected(&self, mut point: DVector<f64>, tangent: &DVector<f64>) -> Option<(DVector<f64>, usize)> {
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
