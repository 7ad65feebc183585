//! Samples and summary of a run.

use std::ops::Deref;

use super::{EffortAccuracy, Statistics};
use crate::StateAt;

/// One moment of a run: its state, also by [`Deref`], and the energies that crossed the boundary of the crane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<'a> {
    /// The state of the crane.
    pub state: StateAt<'a>,
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

impl<'a> Sample<'a> {
    /// Of a run without audit.
    pub fn new(state: StateAt<'a>, event_times: &'a [f64]) -> Self {
        Self { state, work: 0.0, dissipated: 0.0, load_work: 0.0, event_work: 0.0, event_times }
    }
}

impl<'a> Deref for Sample<'a> {
    type Target = StateAt<'a>;

    fn deref(&self) -> &StateAt<'a> {
        &self.state
    }
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
