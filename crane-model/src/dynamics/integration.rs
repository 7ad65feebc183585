//! A motion that is advanced from result to result.

use std::ops::ControlFlow;

use super::{
    Ahead, Cause, InitialState, Method, Run, Sample, Settings, Steered, Stepper, Stopped,
    bdf::Bdf,
    constant::Rk4,
    dormand_prince::DormandPrince,
    energy_integrals::{EnergyIntegrals, INTEGRALS},
    rosenbrock::Rosenbrock,
    stopped::{StepContext, check_inertia},
    stops::Stops,
    switches::first_change,
};
use crate::memory::{Visit, visit_count, visit_flag, visit_numbers};
use crate::{
    StateAt,
    dyn_crane::Functions,
    force_states::ForceStates,
    loop_joints::{Loops, Open},
};

/// Steps and rejections after which an adaptive method's pace is measured: a fraction of a second of computing, and many times as many steps
/// as an impact takes.
const PACE: usize = 20_000;

/// Most bisections for the time at which something happens: they end before, where no number is in between.
const BISECTIONS: usize = 100;

/// Whether something has happened, of a time, s, and the motion there.
pub(super) type Happens<'h> = &'h mut dyn FnMut(f64, &[f64]) -> bool;

/// How far a run has been advanced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Advanced {
    /// To the result.
    Reached,
    /// To the time at which something happened.
    Happened,
    /// It was stopped on the way.
    Stopped,
}

/// A run that is advanced from result to result. It keeps its step size and its history from one result to the next.
pub struct Integration<'a, S: Stepper + ?Sized = dyn Steered + 'a> {
    crane: &'a dyn Functions,
    stepper: Box<S>,
    settings: Settings,
    stops: Stops,
    /// Beginning and end of the run, s.
    begin: f64,
    end: f64,
    /// Time that the steps have reached, s: at or beyond `time`.
    reached: f64,
    /// Steps and rejections when the pace was last measured, and the time reached then, s.
    paced: (usize, f64),
    /// Whether something was changed at the last result: if so, it may change again at the next one, where a step therefore ends.
    is_steered: bool,
    /// Time and motion of the last result.
    time: f64,
    motion: Vec<f64>,
    /// The last time for which it is known whether something happened, s, and room for a motion.
    asked: f64,
    room: Vec<f64>,
    /// The loops of the crane, onto which interpolated results are moved.
    loops: Loops,
    /// Work and dissipation up to there, in an audited run.
    energy: Option<EnergyIntegrals<'a>>,
}

impl<'a> Integration<'a> {
    /// Starts from a state at time `begin`, s, with the method of the settings. Their duration may be infinite; their interval of results
    /// is not used for stepping.
    ///
    /// # Errors
    /// [`Stopped`] if the mass matrix is not positive definite or accelerations are not finite.
    ///
    /// # Panics
    /// If the start does not have as many numbers as the crane has coordinates, or, unless `x` is empty, as its forces have states.
    pub fn new(
        crane: &'a dyn Functions,
        begin: f64,
        start: &InitialState,
        settings: &Settings,
    ) -> Result<Self, Stopped> {
        let stepper: Box<dyn Steered + 'a> = match settings.method {
            Method::Rk4 => Box::new(Rk4::new(crane, settings)),
            Method::DormandPrince => Box::new(DormandPrince::new(crane, settings)),
            Method::Rosenbrock => Box::new(Rosenbrock::new(crane, settings)),
            Method::Bdf => Box::new(Bdf::new(crane, settings)),
        };
        Self::by(stepper, crane, begin, start, settings)
    }
}

impl<'a, S: Stepper + ?Sized> Integration<'a, S> {
    /// The same with a stepper made for this crane and these settings.
    pub(super) fn by(
        mut stepper: Box<S>,
        crane: &'a dyn Functions,
        begin: f64,
        start: &InitialState,
        settings: &Settings,
    ) -> Result<Self, Stopped> {
        let (n, method) = (crane.size(), settings.method);
        check_inertia(crane, &start.q).map_err(|index| {
            let context =
                StepContext { method, t: begin, h: settings.step, q: &start.q, description: crane.description() };
            context.stopped(Cause::MassMatrix, index)
        })?;
        let mut force_states = ForceStates::new(crane.description());
        let states = force_states.start(crane, begin, &start.q, &start.x);
        assert_eq!(states.len(), force_states.len(), "one number for each state of a force");
        let mut motion = [start.q.as_slice(), &start.v, &states].concat();
        let (pose, rates) = motion[..2 * n].split_at_mut(n);
        crane.prescribe(begin, pose, rates);
        let mut loops = Loops::new(crane);
        close(crane, &mut loops, pose, rates).map_err(|open| {
            StepContext { method, t: begin, h: settings.step, q: pose, description: crane.description() }
                .open(crane, open)
        })?;
        stepper.start(begin, &motion)?;
        let end = begin + settings.duration;
        let stops = Stops::between([crane as &dyn Functions], begin, end);
        let energy = settings.audit.then(|| EnergyIntegrals::new(crane, begin, settings.tolerance));
        let settings = *settings;
        Ok(Self {
            crane,
            stepper,
            settings,
            stops,
            begin,
            end,
            reached: begin,
            paced: (0, begin),
            is_steered: false,
            time: begin,
            asked: begin,
            room: motion.clone(),
            motion,
            loops,
            energy,
        })
    }

    /// Advances to a later time, s. `step` receives the time after every step and may stop the motion: the last result then stays.
    ///
    /// # Errors
    /// [`Stopped`] if the motion grows without bound, no step meets the tolerance, or there are more steps than the settings allow.
    pub fn advance(
        &mut self,
        result: f64,
        step: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Stopped> {
        Ok(match self.advance_until(result, step, None)? {
            Advanced::Stopped => ControlFlow::Break(()),
            Advanced::Reached | Advanced::Happened => ControlFlow::Continue(()),
        })
    }

    /// The same, or only to the time at which something happens, which `happens` says of times and motions, in their order. It is asked at the ends
    /// of steps and at the result, and the time is found to rounding.
    pub(super) fn advance_until(
        &mut self,
        result: f64,
        step: &mut dyn FnMut(f64) -> ControlFlow<()>,
        mut happens: Option<Happens<'_>>,
    ) -> Result<Advanced, Stopped> {
        let (n, description) = (self.crane.size(), self.crane.description());
        loop {
            let known = self.reached.min(result);
            if let Some(at) = happens.as_mut().and_then(|happens| self.first(known, happens)) {
                return self.arrive(at).map(|()| Advanced::Happened);
            }
            if self.reached >= result {
                return self.arrive(result).map(|()| Advanced::Reached);
            }
            let before = self.reached;
            self.integrate_powers(before);
            let stop = self.stops.after(before).min(if self.is_steered { result } else { f64::INFINITY });
            self.reached = self.stepper.step(&Ahead { result, stop })?;
            let too_many = self.stepper.statistics().steps >= self.settings.most_steps || self.is_too_slow();
            let q = &self.stepper.motion()[..n];
            let (t, h) = (self.reached, self.reached - before);
            let context = StepContext { method: self.settings.method, t, h, q, description };
            if !description.bounded(q, self.settings.bound) {
                return Err(context.furthest(Cause::Growth));
            }
            if too_many && self.reached < self.end {
                return Err(context.furthest(Cause::Steps));
            }
            if step(self.reached).is_break() {
                return Ok(Advanced::Stopped);
            }
        }
    }

    /// The first time at which something happens, between the last one that was asked for and one that steps have reached, s.
    fn first(&mut self, until: f64, happens: &mut Happens<'_>) -> Option<f64> {
        if until <= self.asked {
            return None;
        }
        let Self { stepper, asked, room, .. } = self;
        let mut has_happened = |t: f64| {
            stepper.interpolate(t, room);
            happens(t, room)
        };
        let begin = std::mem::replace(asked, until);
        has_happened(until).then(|| first_change([begin, until], BISECTIONS, &mut has_happened))
    }

    /// Makes a time that steps have reached, s, that of the last result.
    fn arrive(&mut self, time: f64) -> Result<(), Stopped> {
        let (n, description) = (self.crane.size(), self.crane.description());
        self.integrate_powers(time);
        self.stepper.interpolate(time, &mut self.motion);
        let (q, rest) = self.motion.split_at_mut(n);
        if let Err(open) = self.loops.project(self.crane, q, &mut rest[..n]) {
            let context = StepContext { method: self.settings.method, t: time, h: self.settings.step, q, description };
            return Err(context.opened(self.crane, open));
        }
        (self.time, self.is_steered) = (time, false);
        Ok(())
    }

    /// Whether an adaptive method would need more than the maximum number of steps if it went on like this. A wrong unit makes forces that
    /// change within microseconds: the run would take hours to find that out.
    fn is_too_slow(&mut self) -> bool {
        let statistics = self.stepper.statistics();
        let done = statistics.steps + statistics.rejections;
        let (before, since) = self.paced;
        if done < before + PACE || !self.settings.method.is_adaptive() {
            return false;
        }
        self.paced = (done, self.reached);
        let left = (self.end - self.reached) / (self.reached - since) * (done - before) as f64;
        // A motion without an end has no number of steps left.
        left.is_finite() && left > self.settings.most_steps as f64
    }

    /// Integrates work and dissipation up to a time in the last step.
    fn integrate_powers(&mut self, to: f64) {
        let Self { energy, stepper, .. } = self;
        if let Some(energy) = energy {
            energy.advance(to, &mut |t, motion| stepper.interpolate(t, motion));
        }
    }

    /// The last result.
    pub fn sample(&self) -> Sample<'_> {
        let [work, dissipated, load_work] = self.energy.as_ref().map_or([0.0; INTEGRALS], |energy| energy.values);
        Sample {
            work,
            dissipated,
            load_work,
            ..Sample::new(StateAt::from_motion(self.time, self.crane.size(), &self.motion), &[])
        }
    }

    /// The next step that reaches a result ends there.
    pub(super) fn end_step_at_result(&mut self) {
        self.is_steered = true;
    }

    /// The motion.
    pub(super) fn stepper(&mut self) -> &mut S {
        &mut self.stepper
    }

    /// The same, as it is.
    pub(super) fn stepper_now(&self) -> &S {
        &self.stepper
    }

    /// Statistics up to the last result.
    pub fn run(&self) -> Run {
        let statistics = self.stepper.statistics();
        let step = match (self.settings.method.is_adaptive(), statistics.steps) {
            (true, 1..) => (self.time - self.begin) / statistics.steps as f64,
            _ => self.settings.step_taken(),
        };
        Run { statistics, step, time: self.time, efforts: self.stepper.efforts() }
    }
}

impl<S: Stepper> Integration<'_, S> {
    /// The motion, once the run has ended.
    pub(super) fn into_stepper(self) -> S {
        *self.stepper
    }
}

impl Integration<'_> {
    /// Continues from the last result after `change`, which changes forces or the motions of drives of the crane, but neither positions
    /// nor rates, neither masses nor which drives follow their specs. Not after a motion that was stopped before its result.
    ///
    /// # Errors
    /// [`Stopped`] if accelerations are not finite.
    pub fn change(&mut self, change: &mut dyn FnMut()) -> Result<(), Stopped> {
        self.stepper.change(self.time, change)?;
        (self.reached, self.is_steered) = (self.time, true);
        Ok(())
    }

    /// All numbers on which the further motion depends, besides the crane and the settings: the history of the method, too.
    pub fn memory(&mut self) -> Vec<f64> {
        let mut memory = Vec::new();
        self.visit(&mut |number| memory.push(*number));
        memory
    }

    /// Continues as the integration of the same crane, from the same beginning and with the same settings, from which `memory` is; returns
    /// whether it can be from such a one.
    pub fn recall(&mut self, memory: &[f64]) -> bool {
        let (mut numbers, mut missing) = (memory.iter(), false);
        self.visit(&mut |number| match numbers.next() {
            Some(remembered) => *number = *remembered,
            None => missing = true,
        });
        !missing && numbers.next().is_none()
    }

    fn visit(&mut self, visit: Visit<'_>) {
        let Self { stepper, reached, paced: (done, since), is_steered, time, motion, loops, energy, .. } = self;
        stepper.visit(visit);
        [reached, since, time].into_iter().for_each(&mut *visit);
        visit_count(done, visit);
        visit_flag(is_steered, visit);
        visit_numbers(motion, visit);
        loops.visit(visit);
        if let Some(energy) = energy {
            energy.visit(visit);
        }
    }
}

/// Moves a start onto the loops of a crane, by the smallest change in the metric of its mass matrix.
pub(super) fn close(crane: &dyn Functions, loops: &mut Loops, q: &mut [f64], v: &mut [f64]) -> Result<(), Open> {
    loops.assemble(crane, q, &mut |q, r, x| crane.solve_mass(q, r, x))?;
    loops.project(crane, q, v)
}
