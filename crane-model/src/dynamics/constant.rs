//! The classical Runge–Kutta method with constant steps that end at every result.

use super::{
    Ahead, Cause, Method, Settings, Statistics, Steered, Stepper, Stopped,
    equations::Equations,
    motion::{add, add_all},
    references::References,
    rk4,
    roughness::Roughness,
    settings::divided,
    state::NotFinite,
    stopped::StepContext,
};
use crate::dyn_crane::Functions;
use crate::memory::{visit_count, visit_flag, visit_numbers};

/// A motion integrated by [`rk4`].
pub struct Rk4<'a> {
    equations: Equations<'a>,
    settings: Settings,
    roughness: Roughness,
    motion: Vec<f64>,
    /// Motion and slope at the start of the last step.
    before: Vec<f64>,
    slope: Vec<f64>,
    /// Slope at its end, and whether it is known: only a motion within the step needs it.
    last_slope: Vec<f64>,
    last_known: bool,
    room: Vec<f64>,
    first_order: FirstOrder,
    steps: EqualSteps,
    done: usize,
}

/// Steps of equal length up to a time ahead.
#[derive(Clone, Copy, Debug, Default)]
struct EqualSteps {
    /// Their start and end, s.
    begin: f64,
    end: f64,
    /// Their number, and the number done.
    count: usize,
    done: usize,
}

impl EqualSteps {
    /// Start and length of the next, s.
    fn next(&self) -> (f64, f64) {
        let h = self.length();
        (self.begin + h * self.done as f64, h)
    }

    /// Length of a step, s.
    fn length(&self) -> f64 {
        (self.end - self.begin) / self.count.max(1) as f64
    }

    /// The time reached, s.
    fn reached(&self) -> f64 {
        if self.done == self.count { self.end } else { self.next().0 }
    }
}

impl<'a> Rk4<'a> {
    /// Creates the motion, with the step of the settings.
    pub fn new(crane: &'a dyn Functions, settings: &Settings) -> Self {
        let equations = Equations::new(crane, References::none(crane));
        let n = equations.n;
        Self {
            motion: vec![0.0; equations.len()],
            before: vec![0.0; equations.len()],
            slope: vec![0.0; equations.len()],
            last_slope: vec![0.0; equations.len()],
            last_known: false,
            room: vec![0.0; rk4::ROOM * n],
            first_order: FirstOrder::new(if equations.states() > 0 { equations.len() } else { 0 }),
            equations,
            settings: *settings,
            roughness: Roughness::new(Vec::new()),
            steps: EqualSteps::default(),
            done: 0,
        }
    }

    fn context(&self, t: f64, h: f64) -> StepContext<'_> {
        let q = &self.motion[..self.equations.n];
        StepContext { method: Method::Rk4, t, h, q, description: self.equations.crane.description() }
    }

    /// Reports growth from step to step if there is any, otherwise the given cause.
    fn rough(&self, context: &StepContext<'_>, otherwise: impl FnOnce(&StepContext<'_>) -> Stopped) -> Stopped {
        let rough = self.roughness.roughest().map(|coordinate| context.stopped(Cause::Step, coordinate));
        rough.unwrap_or_else(|| otherwise(context))
    }
}

/// A step of pose and rates.
fn advance(
    equations: &mut Equations<'_>,
    t: f64,
    h: f64,
    motion: &mut [f64],
    room: &mut [f64],
) -> Result<(), NotFinite> {
    let (pose, rates) = motion.split_at_mut(equations.n);
    rk4::advance(t, h, [pose, rates], room, |_, t, q, v, out| equations.accelerate(t, q, v, out))
}

/// The method applied to all components of a motion in the same way, for cranes with forces that have states.
#[derive(Default)]
struct FirstOrder {
    slopes: [Vec<f64>; rk4::STAGES],
    place: Vec<f64>,
}

impl FirstOrder {
    /// Storage for motions of this many numbers.
    fn new(len: usize) -> Self {
        Self { slopes: std::array::from_fn(|_| vec![0.0; len]), place: vec![0.0; len] }
    }

    /// A step; `first` receives the slope at its start.
    fn advance(
        &mut self,
        equations: &mut Equations<'_>,
        t: f64,
        h: f64,
        motion: &mut [f64],
        first: &mut [f64],
    ) -> Result<(), NotFinite> {
        for stage in 0..rk4::STAGES {
            let fraction = [0.0, 0.5, 0.5, 1.0][stage];
            self.place.copy_from_slice(motion);
            if stage > 0 {
                add(&mut self.place, fraction * h, &self.slopes[stage - 1]);
            }
            equations.slope(t + fraction * h, &self.place, &mut self.slopes[stage])?;
        }
        first.copy_from_slice(&self.slopes[0]);
        add_all(motion, h / 6.0, &[1.0, 2.0, 2.0, 1.0], &self.slopes);
        Ok(())
    }
}

/// Number of steps in an interval of a motion that is shorter than the requested step: a single step would have an error of 25 %.
const PIECE: usize = 16;

impl Stepper for Rk4<'_> {
    fn start(&mut self, t: f64, motion: &[f64]) -> Result<(), Stopped> {
        self.motion.copy_from_slice(motion);
        let n = self.equations.n;
        let mut mass = vec![0.0; n * n];
        self.equations.crane.mass_matrix(&motion[..n], &mut mass);
        self.roughness = Roughness::new(mass.iter().step_by(n + 1).copied().collect());
        self.steps = EqualSteps { begin: t, end: t, count: 0, done: 0 };
        Ok(())
    }

    fn step(&mut self, ahead: &Ahead) -> Result<f64, Stopped> {
        let Self { equations, motion, before, slope, room, steps, .. } = self;
        if steps.done == steps.count {
            let (begin, end) = (steps.end, ahead.result.min(ahead.stop));
            let short = end == ahead.stop && end - begin < self.settings.step;
            let count = if short { PIECE } else { divided(end - begin, self.settings.step).0 };
            *steps = EqualSteps { begin, end, count, done: 0 };
        }
        let (t, h) = steps.next();
        let n = equations.n;
        before.copy_from_slice(motion);
        equations.references.step_within(t, t + h);
        let advanced = if equations.states() > 0 {
            self.first_order.advance(equations, t, h, motion, slope)
        } else {
            let advanced = advance(equations, t, h, motion, room);
            slope[..n].copy_from_slice(&before[n..]);
            slope[n..].copy_from_slice(&room[..n]);
            advanced
        };
        if advanced.is_ok() {
            let (pose, rest) = motion.split_at_mut(n);
            equations.crane.prescribe(t + h, pose, &mut rest[..n]);
        }
        let closed = if advanced.is_ok() { equations.project(motion) } else { Ok(()) };
        if let Err(open) = closed {
            return Err(self.context(t + h, h).opened(self.equations.crane, open));
        }
        if let Err(NotFinite) = advanced {
            let context = self.context(t, h);
            return Err(self.rough(&context, |context| context.failed(Cause::Growth, self.equations.crane)));
        }
        let rates = n..2 * n;
        let grows = self.roughness.grows(h, &before[rates.clone()], &slope[rates.clone()], &motion[rates]);
        if grows || !equations.crane.description().bounded(&motion[..n], self.settings.bound) {
            let context = self.context(t, h);
            return Err(self.rough(&context, |context| context.furthest(Cause::Growth)));
        }
        self.steps.done += 1;
        self.done += 1;
        self.last_known = false;
        Ok(self.steps.reached())
    }

    fn motion(&self) -> &[f64] {
        &self.motion
    }

    /// Every result is at the end of a step. Within it: Hermite's cubic through values and slopes at both ends.
    fn interpolate(&mut self, t: f64, motion: &mut [f64]) {
        motion.copy_from_slice(&self.motion);
        let (end, h) = (self.steps.reached(), self.steps.length());
        if t >= end {
            return;
        }
        if !self.last_known {
            // Where it is not finite, the next step ends the run.
            let _ = self.equations.slope(end, &self.motion, &mut self.last_slope);
            self.last_known = true;
        }
        let (theta, rest) = (1.0 - (end - t) / h, (end - t) / h);
        let of_end = theta * theta * (1.0 + 2.0 * rest);
        let slopes = self.slope.iter().zip(&self.last_slope);
        for ((number, start), (first, last)) in motion.iter_mut().zip(&self.before).zip(slopes) {
            *number = start + of_end * (*number - start) + theta * rest * h * (rest * first - theta * last);
        }
        let (pose, rates) = motion.split_at_mut(self.equations.n);
        self.equations.crane.prescribe(t, pose, &mut rates[..self.equations.n]);
    }

    fn statistics(&self) -> Statistics {
        Statistics { steps: self.done, evaluations: self.equations.evaluations, ..Statistics::default() }
    }
}

impl Steered for Rk4<'_> {
    fn change(&mut self, t: f64, change: &mut dyn FnMut()) -> Result<(), Stopped> {
        change();
        self.equations.forget();
        self.steps = EqualSteps { begin: t, end: t, count: 0, done: 0 };
        Ok(())
    }

    fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let Self { equations, roughness, motion, before, slope, last_slope, last_known, steps, done, .. } = self;
        equations.visit(visit);
        roughness.visit(visit);
        for numbers in [motion, before, slope, last_slope] {
            visit_numbers(numbers, visit);
        }
        visit_flag(last_known, visit);
        [&mut steps.begin, &mut steps.end].into_iter().for_each(&mut *visit);
        for count in [&mut steps.count, &mut steps.done, done] {
            visit_count(count, visit);
        }
    }
}
