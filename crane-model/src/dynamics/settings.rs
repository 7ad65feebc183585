//! How to run.

use super::Method;
use crate::Description;

/// No crane is 1 km long and no joint of one turns 160 times: beyond this, m or rad, a run has blown up.
const BOUND: f64 = 1e3;
/// What keeps peak efforts of the drives of all shipped cranes within 1e-3, and the load path of the reference crane within 5e-5 of
/// its size. Measured: crane-model/tests/shipped.rs,
/// docs/error-vs-runtime.md.
const TOLERANCE: f64 = 2e-5;
/// Most steps of a run: RK4 simulates a quarter of an hour in so many, at 1e-4 s, and an adaptive method that takes more is stuck.
const MOST_STEPS: usize = 10_000_000;
/// Whole numbers of steps are recognised to this relative accuracy: 0.01/1e-4 is not 100 in binary.
const WHOLE: f64 = 1e-9;

/// How to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Simulated time, s.
    pub duration: f64,
    /// Method of integration.
    pub method: Method,
    /// Greatest step of a method with constant step, s. The step is the next smaller one that fits the interval of results a
    /// whole number of times.
    pub step: f64,
    /// Error that a one-step adaptive method allows a step, m and rad; `bdf` allows a tenth of it, as its errors add up over more
    /// steps. That of a run on the reference crane's coordinates is ten times as large, on a path of 10 m.
    pub tolerance: f64,
    /// Interval between results, s.
    pub output: f64,
    /// Whether to integrate the work of the drives and of the dampers along with the motion.
    pub audit: bool,
    /// Greatest size of a coordinate, m or rad, before the run counts as blown up.
    pub bound: f64,
    /// Most steps, before the run is given up.
    pub most_steps: usize,
}

impl Settings {
    /// Least tolerance: rounding errors of coordinates of some metres and of their stiff springs. Greatest tolerance, m and rad:
    /// beyond it nothing is held any more.
    pub const TOLERANCES: (f64, f64) = (1e-12, 1.0);
    /// Shortest and longest run and interval of results, s: below a nanosecond steps are lost in rounding, and nobody waits for four
    /// months of a crane.
    pub const TIMES: (f64, f64) = (1e-9, 1e7);
    /// Most results of a run that are kept in memory.
    pub const MOST_RESULTS: f64 = 1e6;
    /// Most steps of constant length that are begun: hours of waiting.
    pub const MOST_STEPS: f64 = 1e10;

    /// The run that the crane's spec asks for, by the default method, without audit.
    pub fn of(description: &Description) -> Self {
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

    /// The step that a run takes, s: the longest that fits the interval of results a whole number of times.
    pub fn step_taken(&self) -> f64 {
        divided(self.output, self.step).1
    }
}

/// The least whole number of parts of `length`, none longer than `part`, and their length.
pub(super) fn divided(length: f64, part: f64) -> (usize, f64) {
    let count = (length / part * (1.0 - WHOLE)).ceil().max(1.0);
    // Saturates where the ratio is not a number.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = count as usize;
    (whole, length / count)
}
