//! Derivatives of the rates of a motion at one moment.

use super::{Covector, PullBacks, Slopes, rates::Rates};
use crate::{dyn_crane::DynCrane, dynamics::NotFinite};

/// Changes of the rates `[q̇, q̈, ẋ]` of a motion `[q, v, x]` at a time, s, along directions, in which the motion changes by `along`. Motions of rigid drives,
/// which prescribe accelerations, do not change.
///
/// # Errors
/// A rate or its change is not finite.
pub fn push_rates(
    crane: &dyn DynCrane,
    slopes: &mut dyn Slopes,
    (t, motion): (f64, &[f64]),
    along: &[Vec<f64>],
) -> Result<Vec<Vec<f64>>, NotFinite> {
    let mut out = vec![vec![0.0; motion.len()]; along.len()];
    let of_drives = vec![vec![0.0; crane.description().drives.len()]; along.len()];
    Rates::new(crane, along.len()).differentiate(slopes, (t, motion), along, &of_drives, &mut out)?;
    Ok(out)
}

/// The transpose of [`push_rates`]: derivatives of the sum of rates, times weights.
///
/// # Errors
/// A rate or a derivative is not finite.
pub fn pull_rates(
    crane: &dyn DynCrane,
    functions: &mut dyn PullBacks,
    (t, motion): (f64, &[f64]),
    weights: &[f64],
) -> Result<Covector, NotFinite> {
    let mut sum = Covector::zero(motion.len(), functions.count());
    let mut of_drives = vec![0.0; crane.description().drives.len()];
    Rates::new(crane, 0).pull_back(functions, (t, motion), weights, &mut of_drives, &mut sum)?;
    Ok(sum)
}
