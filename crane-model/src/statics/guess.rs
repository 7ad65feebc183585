//! Start of the static solution.

use nalgebra::SVector;

use crate::{
    CraneModel,
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
    let description = crane.description();
    let mut q = description.guess.to_vec();
    let mut motions = vec![[0.0; 2]; description.drives.len()];
    crane.drive_motions(0.0, &mut motions);
    for (drive, [position, _]) in description.drives.iter().zip(&motions) {
        let (guess, moved) = (&mut q[drive.coordinate], position - drive.start);
        // The guess of default parameters is unchanged bit for bit.
        if (*guess - drive.start).abs() < ROUNDING && moved.abs() > ROUNDING {
            *guess += moved;
        }
    }
    let mut rates = vec![0.0; q.len()];
    crane.prescribe(0.0, &mut q, &mut rates);
    q
}
