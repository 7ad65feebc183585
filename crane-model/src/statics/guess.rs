//! Start of the static solution.

use nalgebra::{SVector, Vector3};

use crate::{
    Count, CraneModel, Tension,
    dyn_crane::{DynModel, Instance},
};

/// A guess within this distance of the drive's position is equal to it, m or rad: above rounding, below the differences that matter in a
/// spec.
const ROUNDING: f64 = 1e-9;

/// The description's guess, which is for default parameters, adapted to the parameters of the crane.
///
/// A driven coordinate whose guess is the drive's position at t = 0 follows that position as parameters change; other guesses
/// of the spec are unchanged.
pub fn guess<const N: usize, C: CraneModel<N>>(crane: &C) -> SVector<f64, N> {
    SVector::from_vec(guess_dyn(&Instance::<N, _>(crane)))
}

/// As [`guess`], of a crane of any size.
pub fn guess_dyn(crane: &(impl DynModel + ?Sized)) -> Vec<f64> {
    let mut motions = vec![[0.0; 2]; crane.description().drives.len()];
    crane.drive_motions(0.0, &mut motions);
    let mut q = guess_with(crane, motions.iter().map(|[position, _]| *position));
    let mut rates = vec![0.0; q.len()];
    crane.prescribe(0.0, &mut q, &mut rates);
    q
}

/// The guess with the drives at given positions, one per drive, instead of those of their motions: driven coordinates that the description
/// has where their drives begin, and coordinates that follow them by couplings, move with them.
pub(super) fn guess_with(crane: &(impl DynModel + ?Sized), positions: impl Iterator<Item = f64>) -> Vec<f64> {
    let description = crane.description();
    let mut q = description.guess.to_vec();
    let mut has_moved = vec![false; q.len()];
    for (drive, position) in description.drives.iter().zip(positions) {
        let (guess, moved) = (&mut q[drive.coordinate], position - drive.start);
        // The guess of default parameters is unchanged bit for bit.
        if (*guess - drive.start).abs() < ROUNDING && moved.abs() > ROUNDING {
            *guess += moved;
            has_moved[drive.coordinate] = true;
        }
    }
    if has_moved.contains(&true) {
        follow_couplings(crane, &mut q, &mut has_moved);
    }
    q
}

/// Moves coordinates that follow others: a coupling that the guess of the description leaves without force remains so.
fn follow_couplings(crane: &(impl DynModel + ?Sized), q: &mut [f64], has_moved: &mut [bool]) {
    let description = crane.description();
    let couplings = relaxed_couplings(crane, &description.guess);
    let is_driven = |coordinate: usize| description.drives.iter().any(|drive| drive.coordinate == coordinate);
    // A coordinate that follows one that follows another is known one pass later.
    for _ in &couplings {
        for row in &couplings {
            let mut coupled = (0..row.len()).filter(|&i| row[i] != 0.0);
            let (Some(one), Some(other)) = (coupled.next(), coupled.next()) else { continue };
            for (follower, leader) in [(one, other), (other, one)] {
                if has_moved[leader] && !has_moved[follower] && !is_driven(follower) {
                    q[follower] -= row[leader] / row[follower] * (q[leader] - description.guess[leader]);
                    has_moved[follower] = true;
                }
            }
        }
    }
}

/// The rows of the couplings that are without force at a pose, or that hold exactly and are closed there.
fn relaxed_couplings(crane: &(impl DynModel + ?Sized), q: &[f64]) -> Vec<Vec<f64>> {
    let (description, n) = (crane.description(), q.len());
    let (count, equations) = (description.connectors.len(), crane.count(Count::LoopEquations));
    let rest = vec![0.0; n];
    let (mut tensions, mut jacobians) = (vec![Tension::ZERO; count], vec![0.0; count * n]);
    crane.connector_tensions(0.0, q, &rest, &mut tensions);
    crane.connector_jacobians(q, &mut jacobians);
    let is_relaxed = |index: &usize| {
        let Tension { force, stiffness, .. } = tensions[*index];
        description.connectors[*index].points.is_empty() && force.abs() <= ROUNDING * stiffness.abs()
    };
    let springs = (0..count).filter(is_relaxed).map(|index| jacobians[index * n..][..n].to_vec());
    let (mut states, mut rows) = (vec![Vector3::zeros(); equations], vec![0.0; equations * n]);
    crane.loop_states(q, &rest, &mut states);
    crane.loop_jacobians(q, &mut rows);
    let ties = crane.loop_joints().iter().flat_map(|joint| joint.equations.iter().map(|_| joint.is_coupling()));
    let exact = ties.enumerate().filter(|(index, ties)| *ties && states[*index].x.abs() <= ROUNDING);
    springs.chain(exact.map(|(index, _)| rows[index * n..][..n].to_vec())).collect()
}
