//! Static equilibrium: Newton's method, and continuation where that fails.

use std::fmt;

use nalgebra::SVector;

use super::{Status, balance::Balance, continuation, guess, newton, tangent::Tangent};
use crate::{CoordinateKind, Statics};

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Greatest scaled residual `‖r/scale‖` of an equilibrium: the part of the balancing forces left over.
    pub tolerance: f64,
    /// Newton steps before giving up.
    pub iterations: usize,
    /// Load steps of a continuation before giving up; 0 for none.
    pub load_steps: usize,
}

impl Default for Settings {
    /// 1e-10 is 1e-5 N on a crane of ten tonnes and 1e4 times the rounding error; sound guesses need 3 to 5 steps. A crane
    /// that sinks by some radians needs some 100 load steps.
    fn default() -> Self {
        Self { tolerance: 1e-10, iterations: 50, load_steps: 1000 }
    }
}

/// One pose of the iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Scaled residual.
    pub residual: f64,
    /// Part of the Newton step that led here: 1 for a full step, 0 at the first pose.
    pub fraction: f64,
}

/// Where the search ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Whether `q` is an equilibrium, and of what kind.
    pub status: Status,
    /// Last pose, m and rad.
    pub q: Vec<f64>,
    /// The first pose, which is the guess or the end of the continuation, and the pose after each Newton step.
    pub history: Vec<Iteration>,
    /// Load steps of the continuation that led to the first pose; `None` where Newton's method needed none.
    pub load_steps: Option<usize>,
}

impl Equilibrium {
    /// Newton steps done, after the continuation if there was one.
    pub fn steps(&self) -> usize {
        self.history.len().saturating_sub(1)
    }

    /// Whether `q` is a stable equilibrium.
    pub fn is_stable(&self) -> bool {
        self.status == Status::Converged
    }

    /// Whether no force is left over at `q`.
    fn at_rest(&self, settings: &Settings) -> bool {
        self.residual() <= settings.tolerance
    }

    /// Scaled residual at `q`.
    pub fn residual(&self) -> f64 {
        self.history.last().map_or(f64::NAN, |last| last.residual)
    }
}

impl fmt::Display for Equilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {} Newton steps", self.status, self.steps())?;
        match self.load_steps {
            Some(count) => write!(f, " after continuation in {count} load steps, since Newton failed from the guess"),
            None => Ok(()),
        }
    }
}

/// Solves `∂E_p/∂q = 0` at t = 0, Eq. (23) with `q̇ = q̈ = 0`, from the [`guess`].
///
/// Newton–Raphson on `r(q) = ∂E_p/∂q` with `K = ∂²E_p/∂q²`: `q ← q − α K⁻¹ r`, α = 1, halved until the residual falls.
/// The residual is measured as `‖r/scale‖`, the scale of a translation being the greatest force that any translation
/// balances at the guess, that of a rotation the greatest moment: N and N m become comparable. Any equilibrium is found,
/// a stable one or not; the tangent stiffness there tells which.
///
/// Where that fails, or leads from a guess that would stand to a pose that would not, the load is applied in steps from
/// the guess on, and [`Equilibrium::load_steps`] says so. Springs hold the crane at the guess and are taken away as its load
/// comes on:
///
/// ```text
/// H(q, λ) = λ r(q) + (1 − λ) S (q − q₀) = 0,   λ from 0 to 1
/// ```
///
/// a path without end where potential energy grows with distance from the guess, so that it reaches an equilibrium for
/// almost every guess. It is followed by arclength, since λ may fall on the way.
/// S. N. Chow, J. Mallet-Paret, J. A. Yorke, Finding zeroes of maps, Math. Comp. 32 (1978) 887; H. B. Keller, Numerical
/// solution of bifurcation and nonlinear eigenvalue problems, in Applications of Bifurcation Theory, Academic Press 1977.
pub fn solve<const N: usize, C: Statics<N> + Clone>(crane: &C, settings: &Settings) -> Equilibrium {
    search(crane, guess(crane), settings, |q| crane.static_residual(q))
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
    search(crane, q, settings, |q| crane.static_residual(q) + springs(0.0, q) - springs(t, q))
}

/// Newton's method, then continuation, on any residual with the crane's tangent stiffness.
fn search<const N: usize, C: Statics<N>>(
    crane: &C,
    start: SVector<f64, N>,
    settings: &Settings,
    mut residual_at: impl FnMut(&SVector<f64, N>) -> SVector<f64, N>,
) -> Equilibrium {
    let balance = Balance::at(crane, &start);
    let first = newton::iterate(crane, start, settings, &balance, &mut residual_at);
    if settings.load_steps == 0 || !missed(crane, &start, settings, &first) {
        return first;
    }
    let mut load_steps = 0;
    let mut arrive = |q: &SVector<f64, N>, steps: usize, residual_at: &mut _| {
        load_steps = steps;
        let found = newton::iterate(crane, *q, settings, &balance, residual_at);
        found.is_stable().then_some(found)
    };
    let found = continuation::follow(crane, &start, settings.load_steps, &balance, &mut residual_at, &mut arrive);
    found.map_or(first, |found| Equilibrium { load_steps: Some(load_steps), ..found })
}

/// Rotation by which an equilibrium may differ from the guess and still be the one that was meant, rad.
const MEANT: f64 = 0.5;

/// Whether there may be a stable equilibrium that Newton's method did not find: no equilibrium was found, or an unstable one
/// far from the guess or from a guess that is stable itself.
fn missed<const N: usize, C: Statics<N>>(
    crane: &C,
    start: &SVector<f64, N>,
    settings: &Settings,
    found: &Equilibrium,
) -> bool {
    let description = crane.description();
    let meant = || {
        let kinds = description.coordinates.iter().map(|coordinate| coordinate.kind);
        let turned = kinds.zip(start.iter().zip(&found.q)).filter(|(kind, _)| *kind == CoordinateKind::Rotation);
        turned.map(|(_, (from, to))| (to - from).abs()).fold(0.0, f64::max) < MEANT
    };
    let stable = || {
        Tangent::new(&crane.tangent_stiffness(start), description)
            .is_some_and(|tangent| tangent.status(description) == Status::Converged)
    };
    match found.status {
        Status::Converged | Status::Overflow => false,
        // Also said of poses where no step helps; at an equilibrium it is the truth.
        Status::Singular { .. } => !found.at_rest(settings),
        Status::NotConverged => true,
        Status::Unstable { .. } => !meant() || stable(),
    }
}
