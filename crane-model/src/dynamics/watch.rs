//! Observers of runs.

use std::ops::ControlFlow;

use super::Sample;

/// An observer of a run, which may stop it.
pub trait Watch {
    /// Receives a sample: at the beginning, at every interval of results, and at the end.
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()>;

    /// Receives the time after every step, s.
    fn step(&mut self, _t: f64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Passes samples to a function.
pub(super) struct Samples<F>(pub F);

impl<F: FnMut(&Sample<'_>) -> ControlFlow<()>> Watch for Samples<F> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        (self.0)(sample)
    }
}
