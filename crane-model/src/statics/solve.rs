//! Static equilibrium: Newton's method, and continuation if it fails.

use nalgebra::{DVector, SVector};

use super::{
    Equilibrium, Settings, Status,
    balance::Balance,
    continuation, guess_dyn, newton,
    tangent::{Tangent, stiffness_at},
};
use crate::{
    CoordinateKind, CoordinateRole, Description, Statics,
    dyn_crane::{DynStatics, Instance},
};

/// Solves `∂E_p/∂q = 0` at t = 0, Eq. (23) with `q̇ = q̈ = 0`, from [`super::guess()`].
///
/// Newton–Raphson on `r(q) = ∂E_p/∂q` with `K = ∂²E_p/∂q²`: `q ← q − α K⁻¹ r`, α = 1, halved until the residual falls.
/// The residual is measured as `‖r/scale‖`, the scale of a translation being the largest force that any translation
/// balances at the guess, that of a rotation the largest moment: N and N m become comparable. Any equilibrium is found,
/// stable or not; the tangent stiffness there decides which.
///
/// If that fails, or leads from a stable guess to an unstable pose, the load is applied in steps, starting at the guess, and
/// [`Equilibrium::load_steps`] is their number. Springs hold the crane at the guess and are removed as its load is applied:
///
/// ```text
/// H(q, λ) = λ r(q) + (1 − λ) S (q − q₀) = 0,   λ from 0 to 1
/// ```
///
/// a path without end if the potential energy grows with the distance from the guess, so that it reaches an equilibrium for
/// almost every guess. It is followed by arclength, since λ may decrease along it.
/// S. N. Chow, J. Mallet-Paret, J. A. Yorke, Finding zeroes of maps, Math. Comp. 32 (1978) 887; H. B. Keller, Numerical
/// solution of bifurcation and nonlinear eigenvalue problems, in Applications of Bifurcation Theory, Academic Press 1977.
pub fn solve<const N: usize, C: Statics<N>>(crane: &C, settings: &Settings) -> Equilibrium {
    solve_dyn(&Instance::<N, _>(crane), settings)
}

/// As [`solve`], for a crane of any size.
pub fn solve_dyn(crane: &dyn DynStatics, settings: &Settings) -> Equilibrium {
    let found = search(crane, &guess_dyn(crane).into(), settings, &mut |q, out| crane.static_residual(q, out));
    prescribed(crane, found)
}

/// As [`solve`], with the drives where their motions are at time `t`, s, and from the pose `q`: where the crane would rest
/// if its motion stopped. This gives poses during a manoeuvre, each starting from the previous one.
pub fn solve_at<const N: usize, C: Statics<N>>(
    crane: &C,
    t: f64,
    q: SVector<f64, N>,
    settings: &Settings,
) -> Equilibrium {
    solve_at_dyn(&Instance::<N, _>(crane), t, q.as_slice(), settings)
}

/// As [`solve_at`], for a crane of any size.
pub fn solve_at_dyn(crane: &dyn DynStatics, t: f64, q: &[f64], settings: &Settings) -> Equilibrium {
    let mut motions = vec![[0.0; 2]; crane.description().drives.len()];
    crane.drive_motions(t, &mut motions);
    let positions: Vec<f64> = motions.iter().map(|[position, _]| *position).collect();
    solve_held(crane, t, &positions, q, settings)
}

/// As [`solve_at_dyn`] at t = 0, with the drives at given positions, one per drive, instead of where their motions are.
pub fn solve_holding_dyn(crane: &dyn DynStatics, positions: &[f64], q: &[f64], settings: &Settings) -> Equilibrium {
    solve_held(crane, 0.0, positions, q, settings)
}

/// The equilibrium with the drives at given positions and the loads as at time `t`.
fn solve_held(crane: &dyn DynStatics, t: f64, positions: &[f64], q: &[f64], settings: &Settings) -> Equilibrium {
    let Description { drives, coordinates, loads, .. } = crane.description();
    let loads_change = !loads.is_empty() && t != 0.0;
    // Rigid drives move their coordinates, and leave no residual.
    let is_rigid = |coordinate: usize| coordinates[coordinate].role == CoordinateRole::Prescribed;
    let prescribe = |q: &mut [f64]| {
        for (drive, position) in drives.iter().zip(positions).filter(|(drive, _)| is_rigid(drive.coordinate)) {
            q[drive.coordinate] = *position;
        }
    };
    let mut motions = vec![[0.0; 2]; drives.len()];
    crane.drive_motions(0.0, &mut motions);
    let (mut rates, mut forces) = (vec![0.0; q.len()], vec![0.0; q.len()]);
    for (drive, [_, rate]) in drives.iter().zip(&motions) {
        rates[drive.coordinate] = *rate;
    }
    let mut start = DVector::from_column_slice(q);
    prescribe(start.as_mut_slice());
    let mut moved = vec![0.0; q.len()];
    let mut found = search(crane, &start, settings, &mut |q, out| {
        crane.static_residual(q, out);
        // A drive feels how far its coordinate is from its position alone; at the prescribed rates the dampers are unloaded.
        moved.copy_from_slice(q);
        for (drive, (position, [at_start, _])) in drives.iter().zip(positions.iter().zip(&motions)) {
            moved[drive.coordinate] -= position - at_start;
        }
        for (sign, q) in [(1.0, q), (-1.0, moved.as_slice())] {
            crane.drive_forces(0.0, q, &rates, &mut forces);
            for drive in drives.iter().filter(|drive| !is_rigid(drive.coordinate)) {
                out[drive.coordinate] += sign * forces[drive.coordinate];
            }
        }
        for (sign, t) in [(1.0, 0.0), (-1.0, t)].into_iter().filter(|_| loads_change) {
            crane.load_forces(t, q, &mut forces);
            for (index, force) in forces.iter().enumerate().filter(|(index, _)| !is_rigid(*index)) {
                out[index] += sign * force;
            }
        }
    });
    prescribe(&mut found.q);
    found
}

/// The pose found, with the exact positions of rigid drives: the steps change them only by rounding.
fn prescribed(crane: &dyn DynStatics, mut found: Equilibrium) -> Equilibrium {
    let mut rates = vec![0.0; found.q.len()];
    crane.prescribe(0.0, &mut found.q, &mut rates);
    found
}

/// Newton's method, then continuation, on any residual with the crane's tangent stiffness.
fn search(
    crane: &dyn DynStatics,
    start: &DVector<f64>,
    settings: &Settings,
    residual_at: &mut newton::Residual<'_>,
) -> Equilibrium {
    let balance = Balance::at(crane, start);
    let first = newton::iterate(crane, start.clone(), settings, &balance, residual_at);
    if settings.load_steps == 0 || !missed(crane, start, settings, &first) {
        return first;
    }
    let mut load_steps = 0;
    let mut arrive = |q: DVector<f64>, steps: usize, residual_at: &mut newton::Residual<'_>| {
        load_steps = steps;
        let found = newton::iterate(crane, q, settings, &balance, residual_at);
        found.is_stable().then_some(found)
    };
    let found = continuation::follow(crane, start, settings.load_steps, &balance, residual_at, &mut arrive);
    found.map_or(first, |found| Equilibrium { load_steps: Some(load_steps), ..found })
}

/// Rotation by which an equilibrium may differ from the guess and still be the intended one, rad.
const MEANT: f64 = 0.5;

/// Whether there may be a stable equilibrium that Newton's method did not find: no equilibrium was found, or an unstable one
/// far from the guess or from a guess that is stable itself.
fn missed(crane: &dyn DynStatics, start: &DVector<f64>, settings: &Settings, found: &Equilibrium) -> bool {
    let description = crane.description();
    let meant = || {
        let kinds = description.coordinates.iter().map(|coordinate| coordinate.kind);
        let turned = kinds.zip(start.iter().zip(&found.q)).filter(|(kind, _)| *kind == CoordinateKind::Rotation);
        turned.map(|(_, (from, to))| (to - from).abs()).fold(0.0, f64::max) < MEANT
    };
    let stable = || {
        Tangent::new(&stiffness_at(crane, start), description)
            .is_some_and(|tangent| tangent.status(description) == Status::Converged)
    };
    match found.status {
        Status::Converged | Status::TipsOver { .. } | Status::Overflow => false,
        // Also reported for poses where no step helps; at an equilibrium it is exact.
        Status::Singular { .. } => !found.at_rest(settings),
        Status::NotConverged => true,
        Status::Unstable { .. } => !meant() || stable(),
    }
}
