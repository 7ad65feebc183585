//! Drives at the limit of their effort in a pose at rest.

use crate::{Text, dyn_crane::DynCrane};

/// Fraction of its limit from which a drive is reported to be at it: the rest is the rounded corner of its law.
pub(crate) const REACHED: f64 = 0.985;

/// A drive at the limit of its effort.
pub(crate) struct Reached {
    pub drive: usize,
    /// N m or N.
    pub effort: f64,
    pub limit: f64,
}

/// Drives at their limits in a pose at rest.
pub(crate) fn reached(crane: &dyn DynCrane, q: &[f64]) -> Vec<Reached> {
    let drives = crane.drive_limits_at().into_iter().zip(crane.drive_efforts_at_rest(q)).enumerate();
    drives
        .filter_map(|(drive, (limit, effort))| {
            let limit = limit?;
            (effort.abs() >= REACHED * limit).then_some(Reached { drive, effort, limit })
        })
        .collect()
}

/// Names of the coordinates whose drives are at their limits in a pose at rest.
pub(super) fn overloaded(crane: &dyn DynCrane, q: &[f64]) -> Vec<Text> {
    let description = crane.description();
    let name = |reached: Reached| description.coordinates[description.drives[reached.drive].coordinate].name.clone();
    reached(crane, q).into_iter().map(name).collect()
}
