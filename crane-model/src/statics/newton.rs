//! The Newton–Raphson iteration.

use std::ops::RangeInclusive;

use nalgebra::DVector;

use super::{
    Equilibrium, Iteration, Settings, Status,
    equations::Equations,
    residual_scale::ResidualScale,
    tangent::{Limit, Tangent},
};
use crate::CoordinateKind;

/// Halvings of a step before it is given up: 1e-6 of a Newton step no longer makes progress.
const HALVINGS: u32 = 20;
/// Halvings before a step with other limits is tried.
const FIRST: u32 = 1;

/// Limits of a step, with the halvings of it, in the order in which they are tried.
pub(super) type Steps = [(Limit, RangeInclusive<u32>)];
/// Limited only in free directions, if that soon helps; in soft ones; and at last however short.
pub(super) const BOLD: &Steps =
    &[(Limit::Free, 0..=FIRST), (Limit::Soft, 0..=HALVINGS), (Limit::Free, FIRST + 1..=HALVINGS)];
/// Limited in soft directions, in which a crane on feet that have lifted would move far.
pub(super) const CAUTIOUS: &Steps = &[(Limit::Soft, 0..=HALVINGS), (Limit::Free, 0..=HALVINGS)];
/// Where steps do not help any more, a residual of at most this many times the estimate is rounding.
const STALLED: f64 = 8.0;
/// Largest residual that rounding may leave in an equilibrium: forces are then known to six digits.
const ROUNDED: f64 = 1e-6;
/// Maximum rotation in a step, rad: far from equilibrium the tangent says nothing about poses further away.
const GREATEST_ROTATION: f64 = 1.0;

/// The iteration from the pose `q`.
pub(super) fn iterate(
    equations: &Equations<'_>,
    mut q: DVector<f64>,
    settings: &Settings,
    scale: &ResidualScale,
    steps: &Steps,
) -> Equilibrium {
    let load_steps = None;
    if q.is_empty() {
        // Nothing can move; an empty matrix has no eigenvalues to look at.
        let history = vec![Iteration { residual: 0.0, fraction: 0.0 }];
        return Equilibrium { status: Status::Converged, q: Vec::new(), history, load_steps };
    }
    let description = equations.crane.description();
    let mut residual = equations.residual(&q);
    let mut norm = scale.norm(&residual);
    let mut history = vec![Iteration { residual: norm, fraction: 0.0 }];

    // Where the last step was taken: one along which nothing holds the crane may end anywhere.
    let mut left: Option<Tangent> = None;
    let status = loop {
        let stiffness = equations.stiffness(&q);
        let Some(tangent) = Tangent::new(&stiffness, description).filter(|_| norm.is_finite()) else {
            let free = left.and_then(|tangent| tangent.free_directions(description, Limit::Soft));
            break free.map_or(Status::Overflow, |coordinates| Status::Singular { coordinates });
        };
        // Whether rounding leaves too much to call the pose an equilibrium is decided at the end of the search.
        let rounding = scale.rounding(equations, &stiffness, &q);
        // Steps that gain nothing any more end a little above the estimate.
        let before = history.iter().rev().nth(1).map_or(f64::INFINITY, |last| last.residual);
        let has_stalled = norm <= STALLED * rounding && norm > 0.5 * before;
        if norm <= settings.tolerance.max(rounding) || has_stalled {
            break tangent.status(description);
        }
        if history.len() > settings.iterations {
            break Status::NotConverged;
        }
        let try_step = |step: &DVector<f64>, fraction: f64, is_nearer: &dyn Fn(&DVector<f64>) -> bool| {
            let mut pose = &q + step * fraction;
            if !equations.close(&mut pose) {
                return None;
            }
            let residual = equations.residual(&pose);
            let trial = scale.norm(&residual);
            (trial < norm || is_nearer(&residual)).then_some((pose, residual, trial, fraction))
        };
        let fractions =
            |mut halvings: RangeInclusive<u32>, step: DVector<f64>, is_nearer: &dyn Fn(&DVector<f64>) -> bool| {
                let step = limited(step, |i| description.coordinates[i].kind);
                halvings.find_map(|k| try_step(&step, 0.5_f64.powi(k.cast_signed()), is_nearer))
            };
        // The friction of feet that slide does not enter the tangent that decides about stability.
        let sliding = equations.sliding_stiffness(&q).and_then(|matrix| matrix.lu().solve(&-&residual));
        let with_friction = || sliding.clone().and_then(|step| fractions(0..=HALVINGS, step, &|_| false));
        let by_tangent = || {
            steps.iter().cloned().find_map(|(limit, halvings)| {
                let newton = tangent.step(&residual, limit);
                // A stiff connector makes a curved valley: its force grows along a straight step, even if the step leads towards the
                // equilibrium. There a residual is measured by the Newton step from it, in which soft and stiff directions count equally:
                // the natural monotonicity test, P. Deuflhard, Newton Methods for Nonlinear Problems, Springer 2004.
                let length = newton.norm();
                let is_nearer = |residual: &DVector<f64>| {
                    !description.connectors.is_empty() && tangent.step(residual, limit).norm() < length
                };
                fractions(halvings, newton, &is_nearer)
            })
        };
        let is_cautious = matches!(steps.first(), Some((Limit::Soft, _)));
        let improved =
            if is_cautious { by_tangent().or_else(with_friction) } else { with_friction().or_else(by_tangent) };
        let Some((pose, next, trial, fraction)) = improved else {
            if norm <= STALLED * rounding {
                break tangent.status(description);
            }
            // A free direction explains why no step helps.
            break tangent
                .free_directions(description, Limit::Soft)
                .map_or(Status::NotConverged, |coordinates| Status::Singular { coordinates });
        };
        (q, residual, norm) = (pose, next, trial);
        left = Some(tangent);
        history.push(Iteration { residual: norm, fraction });
    };
    Equilibrium { status, q: q.as_slice().to_vec(), history, load_steps }
}

/// Whether the iteration ended, by rounding, with more than an equilibrium leaves.
pub(super) fn is_hidden(equations: &Equations<'_>, equilibrium: &Equilibrium) -> bool {
    let q = DVector::from_column_slice(&equilibrium.q);
    equilibrium.residual() > ROUNDED && exceeds_weights(equations, &q, &equations.residual(&q))
}

/// Whether rounding hides how far a pose is from equilibrium, which then cannot be found.
pub(super) fn rounding_hides(equations: &Equations<'_>, q: &DVector<f64>) -> bool {
    let scale = ResidualScale::at(equations, q);
    let residual = equations.residual(q);
    let norm = scale.norm(&residual);
    norm > ROUNDED
        && norm <= scale.rounding(equations, &equations.stiffness(q), q)
        && exceeds_weights(equations, q, &residual)
}

/// Whether a residual is also more than weights leave that move by 1 rad or 1 m: where a pendulum hangs, no force is left to compare with.
fn exceeds_weights(equations: &Equations<'_>, q: &DVector<f64>, residual: &DVector<f64>) -> bool {
    let energy = |q: &DVector<f64>| equations.crane.gravity_energy(q.as_slice());
    let here = energy(q);
    let lifted = (0..q.len()).map(|i| {
        let mut moved = q.clone();
        moved[i] += 1.0;
        (energy(&moved) - here).abs()
    });
    residual.amax() > ROUNDED * lifted.fold(0.0, f64::max)
}

/// The step, shortened so that no coordinate rotates by more than [`GREATEST_ROTATION`].
fn limited(step: DVector<f64>, kind: impl Fn(usize) -> CoordinateKind) -> DVector<f64> {
    let rotation =
        (0..step.len()).filter(|&i| kind(i) == CoordinateKind::Rotation).map(|i| step[i].abs()).fold(0.0, f64::max);
    if rotation > GREATEST_ROTATION { step * (GREATEST_ROTATION / rotation) } else { step }
}
