//! How many times larger weight and loads may become before the crane buckles, or does not stand for another reason.

use nalgebra::{DMatrix, SymmetricEigen};

use super::{
    Limits,
    rating::{LoadSearch, Posed},
    search::{ALONG, Range},
};
use crate::{dyn_crane::DynCrane, statics::Status};

/// Relative accuracy of a factor.
const ACCURACY: f64 = 1e-6;
/// The largest factor by the stiffness that is told.
const MOST: f64 = 1000.0;
/// The largest factor to which a pose is followed: EN 1993-1-1, 5.2.1 lets effects of the second order be left out from 10 on, 15 for plastic analysis.
const MOST_FOLLOWED: f64 = 100.0;
/// Part of a factor by which another one is a little larger.
const A_LITTLE: f64 = 1e-5;
/// How often a path goes on beyond where it seemed to end.
const PASSES: usize = 100;

/// Critical factors of weight and loads.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadFactor {
    /// By the stiffness at rest with factor 1: the smallest λ > 1 with which `K + (λ − 1) ∂K/∂λ` is singular, all at this pose. `None` if no factor is
    /// large enough, and for closed loops.
    pub linearised: Option<f64>,
    /// The largest factor up to which the crane rests, its pose followed from factor 1 on; `None` if it is above 100.
    pub followed: Option<Followed>,
}

/// The end of a path of poses.
#[derive(Clone, Debug, PartialEq)]
pub struct Followed {
    /// The factor.
    pub factor: f64,
    /// How statics ends with a little more, from the last pose; `None` if the crane rests with a stage out of its beam, which nothing holds.
    pub beyond: Option<Status>,
}

impl LoadFactor {
    /// The largest factor by the stiffness that is told.
    pub const MOST: f64 = MOST;
    /// The largest factor to which a pose is followed.
    pub const MOST_FOLLOWED: f64 = MOST_FOLLOWED;
}

/// The critical factors of a crane with its drives at the beginning of their motions. `parameter` is the factor of its weight and loads, which is left at
/// another value. `None` if the crane does not rest with factor 1.
pub fn load_factor(crane: &mut dyn DynCrane, parameter: usize) -> Option<LoadFactor> {
    let limits = Limits::none(crane.description());
    let positions = crane.drive_targets_at(0.0);
    let range = Range { greatest: MOST_FOLLOWED, guess: 0.0, scale: 1.0, accuracy: ACCURACY, growth: ALONG };
    let search = LoadSearch { limits: &limits, factor: 1.0, range, points: &[] };
    let mut posed = Posed { crane, load: parameter, positions: &positions };
    let begin = posed.find(1.0, None)?;
    let of_coordinates = posed.crane.description().by_coordinate(&positions);
    let linearised = if posed.crane.loop_joints().is_empty() {
        let stiffness =
            |crane: &mut dyn DynCrane, factor: f64| stiffness(crane, (parameter, factor), (&begin.q, &of_coordinates));
        stiffness(posed.crane, 1.0).zip(stiffness(posed.crane, 2.0)).and_then(|(one, two)| singular(one, two))
    } else {
        None
    };
    let mut first = posed.trial(1.0, begin, &search);
    let mut followed = None;
    for _ in 0..PASSES {
        let (best, governing) = posed.find_largest(first, &search);
        let Some(best) = governing.and(best) else {
            followed = None;
            break;
        };
        let more = best.load * (1.0 + A_LITTLE);
        let near = posed.find_next([best.load, more], &best.at.q);
        let status = near.as_ref().map_or(Status::NotConverged, |equilibrium| equilibrium.status.clone());
        let beyond = (status != Status::Converged).then_some(status);
        followed = Some(Followed { factor: best.load, beyond });
        // Newton's method may miss a pose that is there: if the crane rests with a little more, its path goes on.
        let Some(next) = near.and_then(|near| posed.condition(near)) else { break };
        first = posed.trial(more, next, &search);
    }
    Some(LoadFactor { linearised: linearised.filter(|factor| *factor <= MOST), followed })
}

/// The tangent stiffness at a pose with a value of a parameter.
fn stiffness(
    crane: &mut dyn DynCrane,
    (parameter, value): (usize, f64),
    (q, positions): (&[f64], &[f64]),
) -> Option<DMatrix<f64>> {
    crane.set_parameter(parameter, value).ok()?;
    let mut stiffness = DMatrix::zeros(q.len(), q.len());
    crane.tangent_stiffness(0.0, q, positions, stiffness.as_mut_slice());
    Some(stiffness)
}

/// The smallest λ > 1 at which `K₁ + (λ − 1)(K₂ − K₁)` is singular, from the eigenvalues ν of `−L⁻¹ (K₂ − K₁) L⁻ᵀ`, `K₁ = L Lᵀ`: `λ = 1 + 1/ν`.
fn singular(one: DMatrix<f64>, two: DMatrix<f64>) -> Option<f64> {
    let change = &one - two;
    let lower = one.cholesky()?.l();
    let half = lower.solve_lower_triangular(&change)?;
    let whole = lower.solve_lower_triangular(&half.transpose())?;
    let largest = SymmetricEigen::new(0.5 * (&whole + whole.transpose())).eigenvalues.max();
    (largest > 0.0).then(|| 1.0 + largest.recip())
}
