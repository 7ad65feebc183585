//! A run over time, with results at a given interval.

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use super::{
    Ahead, Cause, InitialState, Method, Run, Sample, Settings, State, Stepper, Stopped,
    bdf::Bdf,
    constant::Rk4,
    dormand_prince::DormandPrince,
    rosenbrock::Rosenbrock,
    settings::divided,
    stopped::{Place, without_inertia},
    stops::Stops,
};
use crate::{
    Implicit,
    dyn_crane::{DynDynamics, DynImplicit, DynModel, Instance},
};

/// Integrates Eq. (23) from `start` at t = 0 and passes `observe` a sample at t = 0, at every interval and at the end.
/// `observe` may stop the run.
///
/// With `audit`, work W of the drives and dissipated energy D are integrated along with the motion, so that
/// `E(t) − E(0) − W + D`, zero for the exact motion, measures the error of the run.
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
struct Samples<'a>(&'a mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>);

impl Watch for Samples<'_> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        (self.0)(sample)
    }
}

/// As [`simulate`], of a crane of any size.
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

/// As [`simulate_dyn`], looked at after every step, too.
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

/// As [`simulate_watched`], from a time on, s, over the settings' duration: the drives' motions go on from there. A run in pieces is
/// the same as long as the pieces are.
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
    match settings.method {
        Method::Rk4 => run_from(crane, &mut Rk4::new(crane, settings), begin, start, settings, watch),
        Method::DormandPrince => {
            run_from(crane, &mut DormandPrince::new(crane, settings), begin, start, settings, watch)
        }
        Method::Rosenbrock => run_from(crane, &mut Rosenbrock::new(crane, settings), begin, start, settings, watch),
        Method::Bdf => run_from(crane, &mut Bdf::new(crane, settings), begin, start, settings, watch),
    }
}

/// As [`simulate_dyn`], by a stepper made for this crane and these settings: explicit ones ask for no more than [`DynDynamics`].
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
    run_from(crane, stepper, 0.0, start, settings, &mut Samples(observe))
}

/// A run from a time on.
fn run_from(
    crane: &dyn DynDynamics,
    stepper: &mut dyn Stepper,
    begin: f64,
    start: &InitialState,
    settings: &Settings,
    watch: &mut dyn Watch,
) -> Result<Run, Stopped> {
    let (n, description) = (crane.size(), crane.description());
    let method = settings.method;
    check_inertia(crane, &start.q).map_err(|index| {
        let place = Place { method, t: begin, h: settings.step, q: &start.q, description };
        place.stopped(Cause::MassMatrix, index)
    })?;
    let mut motion = [start.q.as_slice(), &start.v, if settings.audit { &[0.0; 2] } else { &[] }].concat();
    let (pose, rates) = motion[..2 * n].split_at_mut(n);
    crane.prescribe(begin, pose, rates);
    stepper.start(begin, &motion)?;
    let mut time = begin;
    let mut reached = begin;
    let end = begin + settings.duration;
    let stops = Stops::between([crane as &dyn DynModel], begin, end);
    let intervals = divided(settings.duration, settings.output).0;
    let mut broken_off = false;

    for interval in 0..=intervals {
        let (q, rest) = motion.split_at(n);
        let (v, integrals) = rest.split_at(n);
        let [work, dissipated] = *integrals.first_chunk().unwrap_or(&[0.0; 2]);
        if watch.sample(&Sample { t: time, q, v, work, dissipated }).is_break() || interval == intervals {
            break;
        }
        let result = (begin + settings.output * (interval + 1) as f64).min(end);
        while reached < result && !broken_off {
            let before = reached;
            reached = stepper.step(&Ahead { result, stop: stops.after(reached) })?;
            let steps = stepper.statistics().steps;
            let q = &stepper.motion()[..n];
            let place = Place { method, t: reached, h: reached - before, q, description };
            if !description.bounded(q, settings.bound) {
                return Err(place.furthest(Cause::Growth));
            }
            if steps >= settings.most_steps && reached < end {
                return Err(place.furthest(Cause::Steps));
            }
            broken_off = watch.step(reached).is_break();
        }
        if broken_off {
            break;
        }
        stepper.interpolate(result, &mut motion);
        time = result;
    }
    let statistics = stepper.statistics();
    let step = match (settings.method.is_adaptive(), statistics.steps) {
        (true, 1..) => (time - begin) / statistics.steps as f64,
        _ => settings.step_taken(),
    };
    Ok(Run { statistics, step, time, efforts: stepper.efforts() })
}

/// Checks that the mass matrix at a pose is positive definite: the recursion of O(n) divides by inertias one by one and would go on
/// with negative ones. Otherwise returns the coordinate responsible.
fn check_inertia(crane: &dyn DynDynamics, q: &[f64]) -> Result<(), usize> {
    let mut mass = DMatrix::zeros(q.len(), q.len());
    crane.mass_matrix(q, mass.as_mut_slice());
    without_inertia(&mass).map_or(Ok(()), Err)
}
