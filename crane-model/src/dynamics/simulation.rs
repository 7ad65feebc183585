//! A run over time, with results at a given interval.

use std::ops::ControlFlow;

use super::{
    InitialState, Integration, Quantities, Run, Sample, Settings, Stepper, Stopped, Watch, course::follow_events,
    settings::divided, watch::Samples,
};
use crate::{
    Part,
    dyn_crane::{AnyCrane, CraneRef, DynCrane},
};

/// A run: the integration of Eq. (23) from a start.
///
/// This is the one entry of the solver, for cranes of a size in their type and of any size. A run begins at t = 0, unless [`at_time`](Self::at_time) says
/// otherwise. [`run`](Self::run) runs it, [`observe`](Self::observe) and [`watch`](Self::watch) do so with an observer.
///
/// With `audit` in the settings, the work W of drives and loads and the dissipated energy D are integrated along with the motion:
/// `E(t) − E(0) − W + D`, which is zero for the exact motion, measures the error of the run.
#[must_use = "it is run by `run`, `observe` or `watch`"]
pub struct Simulation<'a> {
    way: Way<'a>,
    begin: f64,
    start: InitialState,
    settings: &'a Settings,
}

/// What moves the crane.
enum Way<'a> {
    /// The method of the settings.
    Method(CraneRef<'a>),
    /// The same, from event to event.
    Events(&'a dyn DynCrane, &'a Quantities),
    /// A given stepper.
    Stepper(&'a mut dyn Stepper, CraneRef<'a>),
}

/// # Panics
/// Methods that run it do so if the start does not have as many numbers as the crane has coordinates.
impl<'a> Simulation<'a> {
    /// A run of a crane by the method of the settings. Its events do not happen.
    pub fn new<Size, C: AnyCrane<'a, Size>>(crane: C, start: impl Into<InitialState>, settings: &'a Settings) -> Self {
        const { Part::Dynamics.require(C::PARTS) }
        Self { way: Way::Method(crane.on_slices()), begin: 0.0, start: start.into(), settings }
    }

    /// The same with the events of the crane; `quantities`: the results to which conditions refer. A result at the time of an event is that after
    /// it. Events before the start do not happen.
    pub fn with_events(
        crane: &'a dyn DynCrane,
        quantities: &'a Quantities,
        start: impl Into<InitialState>,
        settings: &'a Settings,
    ) -> Self {
        Self { way: Way::Events(crane, quantities), begin: 0.0, start: start.into(), settings }
    }

    /// A run with a stepper made for this crane and these settings.
    pub fn with_stepper<Size, C: AnyCrane<'a, Size>>(
        stepper: &'a mut dyn Stepper,
        crane: C,
        start: impl Into<InitialState>,
        settings: &'a Settings,
    ) -> Self {
        const { Part::Dynamics.require(C::PARTS) }
        Self { way: Way::Stepper(stepper, crane.on_slices()), begin: 0.0, start: start.into(), settings }
    }

    /// From time `t`, s, over the settings' duration: the drives' motions continue from there. A run in pieces is reproduced exactly if it is
    /// divided into the same pieces.
    pub fn at_time(self, t: f64) -> Self {
        Self { begin: t, ..self }
    }

    /// Runs it.
    ///
    /// # Errors
    /// [`Stopped`] if the motion grows from step to step or beyond the bound, if no step meets the tolerance, if there are too many
    /// steps, if the mass matrix is not positive definite, or if the parameters that an event sets break a rule of the spec language.
    pub fn run(self) -> Result<Run, Stopped> {
        self.observe(|_| ControlFlow::Continue(()))
    }

    /// Runs it, and passes `observe` a sample at the beginning, at every interval and at the end. It may stop the run.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn observe(self, observe: impl FnMut(&Sample<'_>) -> ControlFlow<()>) -> Result<Run, Stopped> {
        self.watch(&mut Samples(observe))
    }

    /// Runs it, and passes `watch` these samples, and the time after every step. It may stop the run.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn watch(self, watch: &mut dyn Watch) -> Result<Run, Stopped> {
        let Self { way, begin, start, settings } = self;
        match way {
            Way::Events(crane, quantities) if !crane.description().events.is_empty() => {
                follow_events(crane, begin, &start, settings, watch, quantities)
            }
            Way::Events(crane, _) => follow(Integration::new(crane, begin, &start, settings)?, begin, settings, watch),
            Way::Method(crane) => follow(Integration::new(&*crane, begin, &start, settings)?, begin, settings, watch),
            Way::Stepper(stepper, crane) => {
                let integration = Integration::by(Box::new(stepper), &*crane, begin, &start, settings)?;
                follow(integration, begin, settings, watch)
            }
        }
    }
}

/// Follows a motion to the end of its run, from result to result.
pub(super) fn follow<S: Stepper + ?Sized>(
    mut integration: Integration<'_, S>,
    begin: f64,
    settings: &Settings,
    watch: &mut dyn Watch,
) -> Result<Run, Stopped> {
    let end = begin + settings.duration;
    let intervals = divided(settings.duration, settings.output).0;
    for interval in 0..=intervals {
        if watch.sample(&integration.sample()).is_break() || interval == intervals {
            break;
        }
        let result = (begin + settings.output * (interval + 1) as f64).min(end);
        if integration.advance(result, &mut |t| watch.step(t))?.is_break() {
            break;
        }
    }
    Ok(integration.run())
}
