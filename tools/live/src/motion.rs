//! A crane in motion: the crane and the integration that borrows it, in one value.

use std::ops::ControlFlow;

use crane_model::dyn_crane::DynCrane;
use crane_model::dynamics::{InitialState, Integration, Run, Sample, Settings, Stopped, without_events};
use self_cell::self_cell;

self_cell!(
    struct Moving {
        owner: Box<dyn DynCrane>,
        #[covariant]
        dependent: Integration,
    }
);

/// A motion of a live or compiled crane that continues from a state as far as requested, with the history of its method.
pub struct Motion(Moving);

impl Motion {
    /// From a state at a time, s.
    ///
    /// # Errors
    /// As [`Integration::new`], and a motion step by step has no events.
    pub fn new(
        crane: Box<dyn DynCrane>,
        begin: f64,
        start: &InitialState,
        settings: &Settings,
    ) -> Result<Self, Stopped> {
        without_events(crane.description(), settings, "motions that go on step by step")?;
        Moving::try_new(crane, |crane| Integration::new(crane.as_ref(), begin, start, settings)).map(Self)
    }

    /// Continues to a later time, s. `step` receives the time after every step, and may stop the motion: then the last result is kept.
    ///
    /// # Errors
    /// As [`Integration::advance`].
    pub fn advance(
        &mut self,
        result: f64,
        step: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Stopped> {
        self.0.with_dependent_mut(|_, integration| integration.advance(result, step))
    }

    /// Continues from the last result after `change`, which sets inputs of the crane.
    ///
    /// # Errors
    /// As [`Integration::change`].
    pub(crate) fn change(&mut self, change: &mut dyn FnMut()) -> Result<(), Stopped> {
        self.0.with_dependent_mut(|_, integration| integration.change(change))
    }

    /// All numbers on which the further motion depends, besides the crane and the settings.
    pub(crate) fn memory(&mut self) -> Vec<f64> {
        self.0.with_dependent_mut(|_, integration| integration.memory())
    }

    /// Continues as the motion of the same crane from which `memory` is; returns whether it can be from such a one.
    pub(crate) fn recall(&mut self, memory: &[f64]) -> bool {
        self.0.with_dependent_mut(|_, integration| integration.recall(memory))
    }

    /// The state reached.
    #[must_use]
    pub fn sample(&self) -> Sample<'_> {
        self.0.borrow_dependent().sample()
    }

    /// Summary of the run so far.
    #[must_use]
    pub fn run(&self) -> Run {
        self.0.borrow_dependent().run()
    }
}
