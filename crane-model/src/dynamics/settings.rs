//! Settings of a run.

use super::Method;
use crate::Description;

/// No crane is 1 km long and no joint of one turns 160 times: beyond this, m or rad, a run has blown up.
const BOUND: f64 = 1e3;
/// Keeps the error of peak drive efforts of all shipped cranes below 1e-3, and that of the load path of the reference crane below
/// 5e-5 of its size. Measured: crane-model/tests/runtime/shipped.rs,
/// docs/error-vs-runtime.md.
const TOLERANCE: f64 = 2e-5;
/// Maximum number of steps of a run: RK4 simulates a quarter of an hour with them, at 1e-4 s, and an adaptive method that needs more is stuck.
const MOST_STEPS: usize = 10_000_000;
/// Whole numbers of steps are recognised to this relative accuracy: 0.01/1e-4 is not 100 in binary.
const WHOLE: f64 = 1e-9;

/// Settings of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Simulated time, s.
    pub duration: f64,
    /// Method of integration.
    pub method: Method,
    /// Largest step of a method with constant step, s. The actual step is the next smaller one of which a whole number fits into the
    /// interval of results.
    pub step: f64,
    /// Error per step that a one-step adaptive method accepts, m and rad; `bdf` accepts a tenth of it, since its errors add up over
    /// more steps. The error of a run of the reference crane is about ten times as large, on a path of 10 m.
    pub tolerance: f64,
    /// Interval between results, s.
    pub output: f64,
    /// Whether to integrate the work of the drives and of the dampers along with the motion.
    pub audit: bool,
    /// Largest absolute value of a coordinate, m or rad, before the run counts as divergent.
    pub bound: f64,
    /// Maximum number of steps before the run is stopped.
    pub most_steps: usize,
}

impl Settings {
    /// Smallest tolerance: rounding errors of coordinates of several metres and of their stiff springs. Largest tolerance, m and rad:
    /// beyond it a result means nothing.
    pub const TOLERANCES: (f64, f64) = (1e-12, 1.0);
    /// Shortest and longest run and interval of results, s: below a nanosecond steps are lost in rounding; the longest is about four
    /// months of a crane.
    pub const TIMES: (f64, f64) = (1e-9, 1e7);
    /// Maximum number of results of a run that are kept in memory.
    pub const MOST_RESULTS: f64 = 1e6;
    /// Maximum number of steps of constant length: these take days.
    pub const MOST_STEPS: f64 = 1e10;
    /// From this number of steps of constant length on, a run has to be asked for twice: a crane of 25 coordinates takes half an hour.
    pub const MANY_STEPS: f64 = 1e8;

    /// The run that the crane's spec describes, with the default method, without audit.
    pub fn from_description(description: &Description) -> Self {
        let &Description { duration, step, output, .. } = description;
        Self {
            duration,
            method: Method::default(),
            step,
            tolerance: TOLERANCE,
            output,
            audit: false,
            bound: BOUND,
            most_steps: MOST_STEPS,
        }
    }

    /// Number and length, s, of the intervals between results.
    pub fn intervals(&self) -> (usize, f64) {
        let count = divided(self.duration, self.output).0;
        (count, self.duration / count as f64)
    }

    /// The step that a run takes, s: the longest one of which a whole number fits into the interval of results.
    pub fn step_taken(&self) -> f64 {
        divided(self.output, self.step).1
    }
}

/// The smallest number of equal parts of `length` that are not longer than `part`, and their length.
pub(super) fn divided(length: f64, part: f64) -> (usize, f64) {
    let count = (length / part * (1.0 - WHOLE)).ceil().max(1.0);
    // Saturates if the ratio is NaN.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = count as usize;
    (whole, length / count)
}
