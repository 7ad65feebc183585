//! A run over time, with results at a given interval.

use std::ops::ControlFlow;

use super::{InitialState, Integration, Run, Sample, Settings, State, Stepper, Stopped, settings::divided};
use crate::{
    Implicit,
    dyn_crane::{DynDynamics, DynImplicit, Instance},
};

/// Integrates Eq. (23) from `start` at t = 0 and passes `observe` a sample at t = 0, at every interval and at the end.
/// `observe` may stop the run.
///
/// With `audit`, the work W of drives and loads and the dissipated energy D are integrated along with the motion:
/// `E(t) − E(0) − W + D`, which is zero for the exact motion, measures the error of the run.
///
/// # Errors
/// [`Stopped`] if the motion grows from step to step or beyond the bound, if no step meets the tolerance, if there are too many
/// steps, or if the mass matrix is not positive definite.
pub fn simulate<const N: usize, C: Implicit<N>>(
    crane: &C,
    start: State<N>,
    settings: &Settings,
    mut observe: impl FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    simulate_dyn(&Instance::<N, _>(crane), &InitialState::from(&start), settings, &mut observe)
}

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
pub(crate) struct Samples<'a>(pub(crate) &'a mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>);

impl Watch for Samples<'_> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        (self.0)(sample)
    }
}

/// Like [`simulate`], for a crane of any size.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// If the start does not have as many numbers as the crane has coordinates.
pub fn simulate_dyn(
    crane: &dyn DynImplicit,
    start: &InitialState,
    settings: &Settings,
    observe: &mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    simulate_watched(crane, start, settings, &mut Samples(observe))
}

/// Like [`simulate_dyn`], but also observed after every step.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// If the start does not have as many numbers as the crane has coordinates.
pub fn simulate_watched(
    crane: &dyn DynImplicit,
    start: &InitialState,
    settings: &Settings,
    watch: &mut dyn Watch,
) -> Result<Run, Stopped> {
    simulate_from(crane, 0.0, start, settings, watch)
}

/// Like [`simulate_watched`], from time `begin`, s, over the settings' duration: the drives' motions continue from there. A run in
/// pieces is reproduced exactly if it is divided into the same pieces.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// If the start does not have as many numbers as the crane has coordinates.
pub fn simulate_from(
    crane: &dyn DynImplicit,
    begin: f64,
    start: &InitialState,
    settings: &Settings,
    watch: &mut dyn Watch,
) -> Result<Run, Stopped> {
    follow(Integration::new(crane, begin, start, settings)?, begin, settings, watch)
}

/// Like [`simulate_dyn`], with a stepper made for this crane and these settings: explicit ones only require [`DynDynamics`].
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// If the start does not have as many numbers as the crane has coordinates.
pub fn run(
    crane: &dyn DynDynamics,
    stepper: &mut dyn Stepper,
    start: &InitialState,
    settings: &Settings,
    observe: &mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    let integration = Integration::by(Box::new(stepper), crane, 0.0, start, settings)?;
    follow(integration, 0.0, settings, &mut Samples(observe))
}

/// Follows a motion to the end of its run, from result to result.
fn follow<S: Stepper + ?Sized>(
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
