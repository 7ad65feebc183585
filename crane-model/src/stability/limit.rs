//! What limits the step.

use super::StabilityFunction;
use crate::modes::DampedMode;

/// The largest stable step and the mode that limits it.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Largest stable step, s.
    pub step: f64,
    /// The mode whose hλ meets the boundary of the region first.
    pub mode: DampedMode,
}

/// The largest stable step for the damped modes of a crane; `None` where nothing limits it.
pub fn limit(modes: &[DampedMode], function: &StabilityFunction) -> Option<Limit> {
    modes
        .iter()
        .filter_map(|mode| Some((function.largest_step(mode.eigenvalue)?, mode)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(step, mode)| Limit { step, mode: mode.clone() })
}
