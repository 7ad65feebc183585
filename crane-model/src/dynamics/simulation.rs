//! A run over time, with results at their own interval.

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

/// Integrates Eq. (23) from `start` at t = 0 and shows `observe` a sample at t = 0, at every interval and at the end.
/// `observe` may break off the run.
///
/// With `audit`, work W of the drives and dissipated energy D are integrated along with the motion, so that
/// `E(t) − E(0) − W + D`, zero for the exact motion, measures the error of the run.
///
/// # Errors
/// [`Stopped`] where the motion grows from step to step or beyond the bound, where no step meets the tolerance, where steps are
/// more than allowed, or where the mass matrix is not positive definite.
pub fn simulate<const N: usize, C: Implicit<N>>(
    crane: &C,
    start: State<N>,
    settings: &Settings,
    mut observe: impl FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    simulate_dyn(&Instance::<N, _>(crane), &InitialState::from(&start), settings, &mut observe)
}

/// As [`simulate`], of a crane of any size.
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// Where the start has not as many numbers as the crane has coordinates.
pub fn simulate_dyn(
    crane: &dyn DynImplicit,
    start: &InitialState,
    settings: &Settings,
    observe: &mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    match settings.method {
        Method::Rk4 => run(crane, &mut Rk4::new(crane, settings), start, settings, observe),
        Method::DormandPrince => run(crane, &mut DormandPrince::new(crane, settings), start, settings, observe),
        Method::Rosenbrock => run(crane, &mut Rosenbrock::new(crane, settings), start, settings, observe),
        Method::Bdf => run(crane, &mut Bdf::new(crane, settings), start, settings, observe),
    }
}

/// As [`simulate_dyn`], by a stepper made for this crane and these settings: explicit ones ask for no more than [`DynDynamics`].
///
/// # Errors
/// As [`simulate`].
///
/// # Panics
/// Where the start has not as many numbers as the crane has coordinates.
pub fn run(
    crane: &dyn DynDynamics,
    stepper: &mut dyn Stepper,
    start: &InitialState,
    settings: &Settings,
    observe: &mut dyn FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    let (n, description) = (crane.size(), crane.description());
    let method = settings.method;
    check_inertia(crane, &start.q).map_err(|index| {
        let place = Place { method, t: 0.0, h: settings.step, q: &start.q, description };
        place.stopped(Cause::MassMatrix, index)
    })?;
    let mut motion = [start.q.as_slice(), &start.v, if settings.audit { &[0.0; 2] } else { &[] }].concat();
    let (pose, rates) = motion[..2 * n].split_at_mut(n);
    crane.prescribe(0.0, pose, rates);
    stepper.start(0.0, &motion)?;
    let mut time = 0.0;
    let mut reached = 0.0;
    let stops = Stops::of([crane as &dyn DynModel], settings.duration);
    let intervals = divided(settings.duration, settings.output).0;

    for interval in 0..=intervals {
        let (q, rest) = motion.split_at(n);
        let (v, integrals) = rest.split_at(n);
        let [work, dissipated] = *integrals.first_chunk().unwrap_or(&[0.0; 2]);
        if observe(&Sample { t: time, q, v, work, dissipated }).is_break() || interval == intervals {
            break;
        }
        let result = (settings.output * (interval + 1) as f64).min(settings.duration);
        while reached < result {
            let before = reached;
            reached = stepper.step(&Ahead { result, stop: stops.after(reached) })?;
            let steps = stepper.statistics().steps;
            let q = &stepper.motion()[..n];
            let place = Place { method, t: reached, h: reached - before, q, description };
            if !description.bounded(q, settings.bound) {
                return Err(place.furthest(Cause::Growth));
            }
            if steps >= settings.most_steps && reached < settings.duration {
                return Err(place.furthest(Cause::Steps));
            }
        }
        stepper.interpolate(result, &mut motion);
        time = result;
    }
    let statistics = stepper.statistics();
    let step = match (settings.method.is_adaptive(), statistics.steps) {
        (true, 1..) => time / statistics.steps as f64,
        _ => settings.step_taken(),
    };
    Ok(Run { statistics, step, time, efforts: stepper.efforts() })
}

/// Checks that the mass matrix at a pose is positive definite: the recursion of O(n) divides by inertias one by one and would go on
/// with negative ones. Otherwise the coordinate to blame.
fn check_inertia(crane: &dyn DynDynamics, q: &[f64]) -> Result<(), usize> {
    let mut mass = DMatrix::zeros(q.len(), q.len());
    crane.mass_matrix(q, mass.as_mut_slice());
    without_inertia(&mass).map_or(Ok(()), Err)
}
