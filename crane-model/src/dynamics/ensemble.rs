//! Many cranes at a time, one crane per lane, with the same steps.
//!
//! With the classical Runge–Kutta method, the operations of a lane are those of [`rk4`], in the same order, with the accelerations of
//! [`LaneDynamics`] or [`DynBlock`]: a crane's motion does not depend on the other lanes. With adaptive methods the cranes are a
//! [fleet](crate::dyn_crane::DynCrane::fleet), one crane with the coordinates of all: the crane with the largest error decides on each step.

use std::convert::Infallible;

use nalgebra::SVector;

use super::{
    Cause, EffortAccuracy, InitialState, Integration, Method, Run, Sample, Settings, State, Statistics, Stopped, Watch,
    integration::close,
    rk4,
    settings::divided,
    simulation::follow,
    stopped::{StepContext, check_inertia},
    stops::Stops,
};
use crate::{
    CoordinateRole, CraneModel, Description, LaneDynamics, ParameterError, Part, StateAt,
    dyn_crane::{Block, DynBlock, DynCrane, Functions, Instance},
    force_states::ForceStates,
    loop_joints::Loops,
    rt::lanes::f64x8,
};

/// Cranes per vector.
pub const LANES: usize = 8;

/// A crane of an ensemble.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Values of its live parameters, in the order of the description.
    pub parameters: Vec<f64>,
    /// Pose and rates at t = 0.
    pub start: InitialState,
}

impl Member {
    /// The crane from which it differs, with its parameters.
    ///
    /// # Errors
    /// They break a rule of the spec language.
    pub(crate) fn crane(&self, of: &dyn DynCrane) -> Result<Box<dyn DynCrane>, ParameterError> {
        let mut crane = of.boxed_clone();
        crane.set_parameters(&self.parameters)?;
        Ok(crane)
    }
}

/// Poses and velocities of eight cranes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct States<const N: usize> {
    /// Generalized coordinates, m and rad.
    pub q: SVector<f64x8, N>,
    /// Their rates, m/s and rad/s.
    pub v: SVector<f64x8, N>,
}

impl<const N: usize> States<N> {
    /// One state per lane.
    pub fn from_lanes(states: [&State<N>; LANES]) -> Self {
        let lanes = |of: fn(&State<N>) -> &SVector<f64, N>| {
            SVector::from_fn(|i, _| f64x8::new(states.map(|state| of(state)[i])))
        };
        Self { q: lanes(|state| &state.q), v: lanes(|state| &state.v) }
    }

    /// The state of a lane, below [`LANES`].
    pub fn lane(&self, lane: usize) -> State<N> {
        State { q: self.q.map(|x| x.to_array()[lane]), v: self.v.map(|x| x.to_array()[lane]) }
    }
}

/// Moves eight cranes from `t` to `t + h`, both in s. No allocation.
pub fn step<const N: usize, L: LaneDynamics<N>>(cranes: &L, t: f64, h: f64, states: &mut States<N>) {
    let mut room = [[f64x8::splat(0.0); N]; rk4::ROOM];
    let States { q, v } = states;
    let Ok(()) =
        rk4::advance(t, h, [q.as_mut_slice(), v.as_mut_slice()], room.as_flattened_mut(), |_, t, q, v, out| {
            let [q, v] = [q, v].map(SVector::from_column_slice);
            out.copy_from_slice(cranes.forward_dynamics(f64x8::splat(t), &q, &v).as_slice());
            Ok::<(), Infallible>(())
        });
}

/// The cranes of an ensemble, with their starts: a list of cranes of a size in their type, `&[(C, State<N>)]`, or a crane of any size and those that
/// differ from it in their parameters, `(&dyn DynCrane, &[Member])`.
pub trait Members {
    /// Why parameters are refused; [`Infallible`] for cranes that have theirs.
    type Refused;

    /// Passes on as many at a time as there are lanes, with the index of the first.
    ///
    /// # Errors
    /// The parameters of a member break a rule of the spec language.
    fn in_batches(self, run: &mut dyn FnMut(usize, Batch<'_>)) -> Result<(), Self::Refused>;
}

impl<const N: usize, C: CraneModel<N>> Members for &[(C, State<N>)] {
    type Refused = Infallible;

    fn in_batches(self, run: &mut dyn FnMut(usize, Batch<'_>)) -> Result<(), Infallible> {
        const { Part::Dynamics.require(C::PARTS) }
        for (index, cranes) in self.chunks(LANES).enumerate() {
            let mut block = Block::<N, _>(C::lanes(std::array::from_fn(|lane| &cranes[lane.min(cranes.len() - 1)].0)));
            let starts: Vec<InitialState> = cranes.iter().map(|(_, start)| start.into()).collect();
            let models: Vec<_> = cranes.iter().map(|(crane, _)| Instance::<N, _>(crane.clone())).collect();
            let models = models.iter().map(|model| model as &dyn DynCrane).collect();
            run(index * LANES, Batch::new(&mut block, starts.iter(), models));
        }
        Ok(())
    }
}

impl Members for (&dyn DynCrane, &[Member]) {
    type Refused = ParameterError;

    fn in_batches(self, run: &mut dyn FnMut(usize, Batch<'_>)) -> Result<(), ParameterError> {
        let (crane, members) = self;
        for (index, members) in members.chunks(LANES).enumerate() {
            let parameters = |lane: usize| members[lane.min(members.len() - 1)].parameters.as_slice();
            let mut block = crane.block(&(0..LANES).map(parameters).collect::<Vec<_>>())?;
            let starts = members.iter().map(|member| &member.start);
            let models: Vec<_> = members.iter().map(|member| member.crane(crane)).collect::<Result<_, _>>()?;
            let models = models.iter().map(|model| model.as_ref() as &dyn DynCrane).collect();
            run(index * LANES, Batch::new(block.as_mut(), starts, models));
        }
        Ok(())
    }
}

/// Integrates Eq. (23) of every crane from its state at t = 0, as many at a time as there are lanes, and passes `observe` its index and a sample at
/// t = 0, at every interval and at the end, like a [`Simulation`](super::Simulation) with RK4 and without audit. Events do not happen.
///
/// A crane that leaves the bound of the settings ends with [`Stopped`], and the others continue. Returns one result per crane.
///
/// # Errors
/// The parameters of a member break a rule of the spec language.
///
/// # Panics
/// If a start does not have as many numbers as the crane has coordinates.
pub fn simulate<M: Members>(
    members: M,
    settings: &Settings,
    mut observe: impl FnMut(usize, &Sample<'_>),
) -> Result<Vec<Result<Run, Stopped>>, M::Refused> {
    let mut results = Vec::new();
    members.in_batches(&mut |first, batch| {
        results.extend(batch.run(settings, &mut |lane, sample| observe(first + lane, sample)));
    })?;
    Ok(results)
}

/// Runs cranes with an adaptive method as one crane, a fleet, whose steps are so short that each crane meets the tolerance. `watch` receives
/// samples of the fleet. Returns the run of each crane, with the steps of all.
///
/// # Errors
/// [`Stopped`] if one of the cranes does not reach the end.
pub(crate) fn simulate_fleet(
    fleet: &dyn Functions,
    cranes: &[(&dyn DynCrane, InitialState)],
    settings: &Settings,
    watch: &mut dyn Watch,
) -> Result<Vec<Run>, Stopped> {
    let count = fleet.cranes();
    let starts =
        cranes.iter().map(|(crane, start)| own_start(*crane, start, settings)).collect::<Result<Vec<_>, _>>()?;
    let joined = |of: fn(&InitialState) -> &Vec<f64>| -> Vec<f64> {
        let of_lane = |lane: usize| of(&starts[lane.min(starts.len() - 1)]);
        (0..count * of_lane(0).len()).map(|index| of_lane(index % count)[index / count]).collect()
    };
    let start = InitialState { q: joined(|start| &start.q), v: joined(|start| &start.v), x: joined(|start| &start.x) };
    let run = follow(Integration::new(fleet, 0.0, &start, settings)?, 0.0, settings, watch)?;
    let of_lane = |lane: usize| {
        let own = run.efforts.iter().filter(|effort| effort.coordinate % count == lane);
        let efforts = own.map(|effort| EffortAccuracy { coordinate: effort.coordinate / count, ..*effort }).collect();
        Run { efforts, ..run.clone() }
    };
    Ok((0..cranes.len()).map(of_lane).collect())
}

/// The start of a crane of a fleet, checked, with the states of its forces and its loops closed: a fleet does not do this crane by crane.
fn own_start(crane: &dyn DynCrane, start: &InitialState, settings: &Settings) -> Result<InitialState, Stopped> {
    let description = crane.description();
    let context = StepContext { method: settings.method, t: 0.0, h: settings.step, q: &start.q, description };
    check_inertia(crane, &start.q).map_err(|index| context.stopped(Cause::MassMatrix, index))?;
    let InitialState { mut q, mut v, x } = start.clone();
    let x = ForceStates::new(description).start(crane, 0.0, &q, &x);
    close(crane, &mut Loops::new(crane), &mut q, &mut v).map_err(|open| context.open(crane, open))?;
    Ok(InitialState { q, v, x })
}

/// Eight moving cranes, one in each lane.
pub struct Batch<'a> {
    block: &'a mut dyn DynBlock,
    description: &'a Description,
    /// The cranes one by one; copies of the last one fill the remaining lanes, whose results are ignored.
    models: Vec<&'a dyn DynCrane>,
    /// Whether rigid drives prescribe coordinates.
    prescribes: bool,
    /// Pose and rates of a lane.
    own: [Vec<f64>; 2],
    q: Vec<f64x8>,
    v: Vec<f64x8>,
    start: [Vec<f64x8>; 2],
    room: Vec<f64x8>,
}

impl<'a> Batch<'a> {
    fn new<'s>(
        block: &'a mut dyn DynBlock,
        starts: impl ExactSizeIterator<Item = &'s InitialState> + Clone,
        models: Vec<&'a dyn DynCrane>,
    ) -> Self {
        let description = models[0].description();
        assert!(!description.has_force_states(), "states of forces have no lanes");
        assert!(models.iter().all(|model| model.loop_joints().is_empty()), "closed loops have no lanes");
        let n = description.coordinates.len();
        let prescribes = description.coordinates.iter().any(|info| info.role == CoordinateRole::Prescribed);
        let mut start = [(); 2].map(|()| vec![f64x8::splat(0.0); n]);
        for (lane, state) in starts.clone().chain(starts.last().into_iter().cycle()).take(LANES).enumerate() {
            for (lanes, numbers) in start.iter_mut().zip([&state.q, &state.v]) {
                assert_eq!(numbers.len(), n, "as many numbers as coordinates");
                for (lanes, number) in lanes.iter_mut().zip(numbers) {
                    lanes.as_mut_array()[lane] = *number;
                }
            }
        }
        let [q, v] = start.clone();
        let room = vec![f64x8::splat(0.0); rk4::ROOM * q.len()];
        let own = [vec![0.0; n], vec![0.0; n]];
        let mut batch = Self { block, description, models, prescribes, own, q, v, start, room };
        batch.prescribe(0.0);
        batch
    }

    /// Whether a lane stays within `bound`, m and rad; false for NaN.
    fn bounded(&self, lane: usize, bound: f64) -> bool {
        self.q.iter().all(|x| x.as_array()[lane].abs() <= bound)
    }

    /// Whether all lanes stay within `bound`.
    fn all_bounded(&self, bound: f64) -> bool {
        let bound = f64x8::splat(bound);
        let within = self.q.iter().fold(f64x8::splat(0.0).simd_le(bound), |within, x| within & x.abs().simd_le(bound));
        within.to_bitmask() & 0xff == 0xff
    }

    /// Resets a lane to its start: unbounded numbers would slow down all lanes.
    fn reset(&mut self, lane: usize) {
        for (lanes, start) in [&mut self.q, &mut self.v].into_iter().zip(&self.start) {
            for (x, start) in lanes.iter_mut().zip(start) {
                x.as_mut_array()[lane] = start.as_array()[lane];
            }
        }
    }

    /// Sets the coordinates of rigid drives, crane by crane.
    fn prescribe(&mut self, t: f64) {
        if !self.prescribes {
            return;
        }
        let [mut q, mut v] = std::mem::take(&mut self.own);
        for lane in 0..self.models.len() {
            copy_lane(lane, &self.q, &mut q);
            copy_lane(lane, &self.v, &mut v);
            self.models[lane].prescribe(t, &mut q, &mut v);
            for (lanes, own) in [(&mut self.q, &q), (&mut self.v, &v)] {
                for (lanes, x) in lanes.iter_mut().zip(own) {
                    lanes.as_mut_array()[lane] = *x;
                }
            }
        }
        self.own = [q, v];
    }

    fn step(&mut self, t: f64, h: f64) {
        let Self { block, q, v, room, .. } = self;
        let Ok(()) = rk4::advance(t, h, [q, v], room, |_, t, q, v, out| {
            block.forward_dynamics(t, q, v, out);
            Ok::<(), Infallible>(())
        });
    }

    /// Runs the batch. No step passes the time of a result or a stop.
    fn run(mut self, settings: &Settings, observe: &mut dyn FnMut(usize, &Sample<'_>)) -> Vec<Result<Run, Stopped>> {
        let run =
            Run { statistics: Statistics::default(), step: settings.step_taken(), time: 0.0, efforts: Vec::new() };
        let mut results = vec![Ok(run); self.models.len()];
        let stops = Stops::between(self.models.iter().map(|model| *model as &dyn Functions), 0.0, settings.duration);
        let n = self.description.coordinates.len();
        let (mut q, mut v) = (vec![0.0; n], vec![0.0; n]);
        let intervals = divided(settings.duration, settings.output).0;

        let mut begin = 0.0;
        for interval in 0..=intervals {
            for (lane, _) in results.iter().enumerate().filter(|(_, result)| result.is_ok()) {
                copy_lane(lane, &self.q, &mut q);
                copy_lane(lane, &self.v, &mut v);
                observe(lane, &Sample::new(StateAt { t: begin, q: &q, v: &v, x: &[] }, &[]));
            }
            if results.iter().all(Result::is_err) {
                break;
            }
            let result = (settings.output * (interval + 1) as f64).min(settings.duration);
            while begin < result {
                let end = result.min(stops.after(begin));
                self.advance(begin, end, settings, &mut results);
                begin = end;
            }
        }
        results
    }

    /// Moves all lanes from `begin` to `end`, s, in equal steps; a crane that leaves the bound ends with [`Stopped`].
    fn advance(&mut self, begin: f64, end: f64, settings: &Settings, results: &mut [Result<Run, Stopped>]) {
        let (steps, h) = divided(end - begin, settings.step);
        for k in 0..steps {
            let t = begin + h * k as f64;
            self.step(t, h);
            self.prescribe(t + h);
            if !self.all_bounded(settings.bound) {
                self.stop_lanes(t, h, settings.bound, results);
            }
        }
        for run in results.iter_mut().flatten() {
            run.statistics.steps += steps;
            run.statistics.evaluations += rk4::STAGES * steps;
            run.time = end;
        }
    }

    /// Ends the runs of cranes beyond the bound.
    fn stop_lanes(&mut self, t: f64, h: f64, bound: f64, results: &mut [Result<Run, Stopped>]) {
        for lane in 0..LANES {
            if self.bounded(lane, bound) {
                continue;
            }
            if let Some(result @ Ok(_)) = results.get_mut(lane) {
                let mut q = vec![0.0; self.description.coordinates.len()];
                copy_lane(lane, &self.q, &mut q);
                let context = StepContext { method: Method::Rk4, t, h, q: &q, description: self.description };
                *result = Err(context.furthest(Cause::Growth));
            }
            self.reset(lane);
        }
    }
}

/// Copies the numbers of a lane.
fn copy_lane(lane: usize, of: &[f64x8], out: &mut [f64]) {
    out.iter_mut().zip(of).for_each(|(out, lanes)| *out = lanes.as_array()[lane]);
}
