//! The Newton–Raphson iteration.

use nalgebra::SVector;

use super::{Status, balance::Balance, guess, tangent::Tangent};
use crate::{CoordinateKind, Statics};

/// Halvings of a step before it is given up: 1e-6 of a Newton step no longer makes progress.
const HALVINGS: u32 = 20;
/// Greatest rotation in a step, rad: far from equilibrium the tangent says nothing about poses further away.
const GREATEST_ROTATION: f64 = 1.0;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Greatest scaled residual `‖r/scale‖` of an equilibrium: the part of the balancing forces left over.
    pub tolerance: f64,
    /// Newton steps before giving up.
    pub iterations: usize,
}

impl Default for Settings {
    /// 1e-10 is 1e-5 N on a crane of ten tonnes and 1e4 times the rounding error; sound guesses need 3 to 5 steps.
    fn default() -> Self {
        Self { tolerance: 1e-10, iterations: 50 }
    }
}

/// One pose of the iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Scaled residual.
    pub residual: f64,
    /// Part of the Newton step that led here: 1 for a full step, 0 at the guess.
    pub fraction: f64,
}

/// Where the iteration ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Whether `q` is an equilibrium, and of what kind.
    pub status: Status,
    /// Last pose, m and rad.
    pub q: Vec<f64>,
    /// The guess and the pose after each step.
    pub history: Vec<Iteration>,
}

impl Equilibrium {
    /// Newton steps done.
    pub fn steps(&self) -> usize {
        self.history.len().saturating_sub(1)
    }

    /// Whether `q` is a stable equilibrium.
    pub fn is_stable(&self) -> bool {
        self.status == Status::Converged
    }
}

/// Solves `∂E_p/∂q = 0` at t = 0, Eq. (23) with `q̇ = q̈ = 0`, from the [`guess`].
///
/// Newton–Raphson on `r(q) = ∂E_p/∂q` with `K = ∂²E_p/∂q²`: `q ← q − α K⁻¹ r`, α = 1, halved until the residual falls.
/// The residual is measured as `‖r/scale‖`, the scale of a translation being the greatest force that any translation
/// balances at the guess, that of a rotation the greatest moment: N and N m become comparable. Any equilibrium is found,
/// a stable one or not; the tangent stiffness there tells which.
pub fn solve<const N: usize, C: Statics<N> + Clone>(crane: &C, settings: &Settings) -> Equilibrium {
    newton(crane, guess(crane), settings, |q| crane.static_residual(q))
}

/// As [`solve`], with the drives where their motions are at time `t`, s, and from the pose `q`: where the crane would rest
/// if its motion froze. Poses along a manoeuvre, each from the one before.
pub fn solve_at<const N: usize, C: Statics<N>>(
    crane: &C,
    t: f64,
    q: SVector<f64, N>,
    settings: &Settings,
) -> Equilibrium {
    let drives = crane.description().drives;
    let mut motions = vec![[0.0; 2]; drives.len()];
    // Forces of the drives' springs: at the prescribed rates the dampers are at rest.
    let mut springs = |t: f64, q: &SVector<f64, N>| {
        crane.drive_motions(t, &mut motions);
        let mut v = SVector::zeros();
        for (drive, [_, rate]) in drives.iter().zip(&motions) {
            v[drive.coordinate] = *rate;
        }
        crane.drive_forces(t, q, &v)
    };
    newton(crane, q, settings, |q| crane.static_residual(q) + springs(0.0, q) - springs(t, q))
}

/// The iteration of [`solve`] on any residual with the crane's tangent stiffness.
fn newton<const N: usize, C: Statics<N>>(
    crane: &C,
    mut q: SVector<f64, N>,
    settings: &Settings,
    mut residual_at: impl FnMut(&SVector<f64, N>) -> SVector<f64, N>,
) -> Equilibrium {
    if N == 0 {
        // Nothing can move; an empty matrix has no eigenvalues to look at.
        let history = vec![Iteration { residual: 0.0, fraction: 0.0 }];
        return Equilibrium { status: Status::Converged, q: Vec::new(), history };
    }
    let description = crane.description();
    let balance = Balance::at(crane, &q);
    let mut residual = residual_at(&q);
    let mut norm = balance.norm(&residual);
    let mut history = vec![Iteration { residual: norm, fraction: 0.0 }];

    let status = loop {
        let Some(tangent) = Tangent::new(&crane.tangent_stiffness(&q), description) else {
            break Status::NotConverged;
        };
        if norm <= settings.tolerance {
            break tangent.status(description);
        }
        if history.len() > settings.iterations {
            break Status::NotConverged;
        }
        let step = limited(tangent.step(&residual), |i| description.coordinates[i].kind);
        let improved = (0..=HALVINGS).map(|k| 0.5_f64.powi(k.cast_signed())).find_map(|fraction| {
            let pose = q + step * fraction;
            let residual = residual_at(&pose);
            let trial = balance.norm(&residual);
            (trial < norm).then_some((pose, residual, trial, fraction))
        });
        let Some((pose, next, trial, fraction)) = improved else {
            // Pushed, and nothing holds it: a free direction says why no step helps.
            break tangent
                .free_directions(description)
                .map_or(Status::NotConverged, |coordinates| Status::Singular { coordinates });
        };
        (q, residual, norm) = (pose, next, trial);
        history.push(Iteration { residual: norm, fraction });
    };
    Equilibrium { status, q: q.as_slice().to_vec(), history }
}

/// The step, shortened until no coordinate turns by more than [`GREATEST_ROTATION`].
fn limited<const N: usize>(step: SVector<f64, N>, kind: impl Fn(usize) -> CoordinateKind) -> SVector<f64, N> {
    let rotation = (0..N).filter(|&i| kind(i) == CoordinateKind::Rotation).map(|i| step[i].abs()).fold(0.0, f64::max);
    if rotation > GREATEST_ROTATION { step * (GREATEST_ROTATION / rotation) } else { step }
}
