//! Where the static solution starts.

use nalgebra::SVector;

use crate::CraneModel;

/// A guess is the drive's position up to this, m or rad: above rounding, below what a spec would tell apart.
const ROUNDING: f64 = 1e-9;

/// The description's guess, made with default parameters, for the crane's own parameters.
///
/// A driven coordinate whose guess is the drive's position at t = 0 follows that position as parameters change; what the
/// spec guesses otherwise stays.
pub fn guess<const N: usize, C: CraneModel<N> + Clone>(crane: &C) -> SVector<f64, N> {
    let description = crane.description();
    let mut q = SVector::from_fn(|i, _| description.guess[i]);
    let mut at_defaults = crane.clone();
    let defaults: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
    // The spec's own values keep its rules.
    let _ = at_defaults.set_parameters(&defaults);
    let [own, default] = [crane, &at_defaults].map(|crane| {
        let mut motions = vec![[0.0; 2]; description.drives.len()];
        crane.drive_motions(0.0, &mut motions);
        motions
    });
    for (drive, ([own, _], [default, _])) in description.drives.iter().zip(own.iter().zip(&default)) {
        if (q[drive.coordinate] - default).abs() < ROUNDING {
            // A difference, so that default parameters leave the guess as it is to the last bit.
            q[drive.coordinate] += own - default;
        }
    }
    q
}
