//! Samples and summary of a run.

use super::{EffortAccuracy, Statistics};

/// One moment of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<'a> {
    /// Time, s.
    pub t: f64,
    /// Generalized coordinates, m and rad.
    pub q: &'a [f64],
    /// Their rates, m/s and rad/s.
    pub v: &'a [f64],
    /// States of forces: of the oil of cylinders with a valve, in the order of [`hydraulics`](crate::hydraulics), Pa and shares; then
    /// deflections of bristles, m and rad.
    pub x: &'a [f64],
    /// Work of the drives' motions and of cylinders since t = 0, J; 0 without audit.
    pub work: f64,
    /// Energy that the dampers dissipated since t = 0, J; 0 without audit.
    pub dissipated: f64,
    /// Work done by the applied loads since t = 0, J; 0 without audit.
    pub load_work: f64,
    /// Energy that came with events since t = 0, J; negative for what left.
    pub event_work: f64,
    /// When the events [on conditions](crate::Description::conditions) happened, s, in their order; 0 for those that have not.
    pub event_times: &'a [f64],
}

/// Summary of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Counts of steps and evaluations.
    pub statistics: Statistics,
    /// Step size, s; for an adaptive method, its mean.
    pub step: f64,
    /// Time reached, s.
    pub time: f64,
    /// The drives' efforts and their estimated errors, if the method monitors them.
    pub efforts: Vec<EffortAccuracy>,
}
