//! Steps as long as a tolerance allows, for one-step methods.

use super::{
    Ahead, Cause, EffortAccuracy, Method, Statistics, Steered, Stepper, Stopped,
    equations::Equations,
    norm::Norm,
    state::NotFinite,
    step::Step,
    stopped::StepContext,
    switches::{Switches, Watched},
};
use crate::memory::{Visit, visit_count, visit_flag, visit_numbers};

/// First step tried, s: a crane starts smoothly, and steps may grow by a factor of three.
pub(super) const FIRST: f64 = 1e-4;
/// Longest first step after a drive has reached or left its limit, s.
const AFRESH: f64 = 1e-3;
/// Longest step, s: ten steps per period for a load that swings once per second.
pub(super) const LONGEST: f64 = 0.1;
/// Safety factor on the step size at which the error would equal the tolerance.
const SAFETY: f64 = 0.9;
/// Smallest and largest ratio of a step to the previous one.
const RATIO: (f64, f64) = (0.2, 3.0);
/// A step as short as this, relative to the time of the next result, makes no progress.
pub(super) const LEAST: f64 = 1e-14;
/// A step that would end this close to a stop, relative to its length, ends there.
pub(super) const SLIVER: f64 = 0.01;

/// A formula that takes a step.
pub(super) trait Formula {
    /// Its name.
    const METHOD: Method;

    /// Tries a step, given its start, length and initial slope.
    fn attempt(&mut self, equations: &mut Equations<'_>, step: &mut Step) -> Result<(), NotFinite>;

    /// Factorisations so far.
    fn factorisations(&self) -> usize;

    /// Motions and commands change: what is kept of the last time does not hold any more.
    fn forget(&mut self) {}

    /// Visits what further steps depend on.
    fn visit(&mut self, _visit: Visit<'_>) {}
}

/// A motion with adaptive steps, which may pass the times of results; results are interpolated.
pub(super) struct Adaptive<'a, F> {
    formula: F,
    equations: Equations<'a>,
    norm: Norm,
    /// Step to try next, s.
    next: f64,
    step: Step,
    /// Whether the last step ended where motions are not smooth: its last slope is not the first of the next step.
    at_stop: bool,
    switches: Switches,
    /// The laws at whose changes also a step ends whose error is small.
    watched: Watched,
    /// Motion at the time reached.
    motion: Vec<f64>,
    steps: usize,
    rejections: usize,
}

impl<'a, F: Formula> Adaptive<'a, F> {
    /// Creates the motion, with a measure of errors.
    pub fn new(formula: F, equations: Equations<'a>, norm: Norm) -> Self {
        let (step, motion) = (Step::new(equations.len()), vec![0.0; equations.len()]);
        let switches = Switches::new(equations.crane, equations.len());
        Self {
            formula,
            equations,
            norm,
            next: FIRST,
            step,
            at_stop: false,
            switches,
            watched: Watched::Contacts,
            motion,
            steps: 0,
            rejections: 0,
        }
    }

    /// Ends steps also where forces with states of their own change their branch.
    pub fn watching_all(mut self) -> Self {
        self.watched = Watched::All;
        self.switches.is_exact = true;
        self
    }

    /// The last step, for motions that follow this one: its formula, the equations and the step.
    pub fn last(&mut self) -> (&mut F, &mut Equations<'a>, &Step) {
        (&mut self.formula, &mut self.equations, &self.step)
    }

    /// Takes a step again, from its start and the slope there: its formula and its motion within are then those of the step.
    pub fn repeat(&mut self, [t, length]: [f64; 2], [start, slope]: [&[f64]; 2], end: &[f64]) -> Result<(), NotFinite> {
        let Self { formula, equations, step, .. } = self;
        (step.t, step.length) = (t, length);
        step.start.copy_from_slice(start);
        step.slopes[0].copy_from_slice(slope);
        equations.references.step_within(t, step.reached());
        formula.attempt(equations, step)?;
        step.end.copy_from_slice(end);
        Ok(())
    }

    /// Goes back to the beginning of the first step.
    pub fn go_back(&mut self, t: f64, start: &[f64]) -> Result<(), NotFinite> {
        let Self { equations, step, .. } = self;
        (step.t, step.length) = (t, 0.0);
        step.end.copy_from_slice(start);
        equations.references.step_within(t, t + FIRST);
        equations.slope(t, start, &mut step.slopes[1])
    }

    /// Shortens the next step to what an error at the end of the last one allows that is not an error of the motion itself, but of a change of it,
    /// in proportion to this change if it is large.
    pub fn heed(&mut self, error: &[f64], change: &[f64]) {
        let Self { norm, step, .. } = self;
        let size = norm.size(&step.end, error) / norm.size_of_change(&step.end, change).max(1.0);
        if size > 1.0 {
            let ideal = SAFETY * size.powf(-1.0 / F::METHOD.order() as f64);
            self.next = self.next.min(self.step.length * ideal.max(RATIO.0));
        }
    }

    /// The error that no further step is possible.
    pub fn stuck(&self, t: f64, h: f64) -> Stopped {
        let Equations { crane, n, .. } = self.equations;
        let q = &self.motion[..n];
        StepContext { method: F::METHOD, t, h, q, description: crane.description() }.failed(Cause::Tolerance, crane)
    }

    /// The first time in a step at which a law changes its branch, s.
    fn change(&mut self, watched: Watched) -> Option<f64> {
        let Self { switches, equations, step, .. } = self;
        switches.find_change(equations, watched, [step.t, step.reached()], &|t, motion| step.at(t, motion))
    }

    /// Returns whether a tried step meets the tolerance, and sets the length to try next.
    fn judge(&mut self, tried: Result<(), NotFinite>) -> bool {
        let Step { length, end, error, .. } = &self.step;
        let error = match tried {
            Ok(()) => self.norm.size(end, error),
            Err(NotFinite) => f64::INFINITY,
        };
        let ideal = SAFETY * error.powf(-1.0 / F::METHOD.order() as f64);
        let meets = error <= 1.0;
        let next = length * ideal.clamp(RATIO.0, if meets { RATIO.1 } else { 1.0 });
        // A step shortened by a stop does not limit the intended length.
        self.next = if meets && *length < self.next { next.max(self.next) } else { next }.min(LONGEST);
        meets
    }
}

impl<F: Formula> Adaptive<'_, F> {
    /// Evaluates the slope at the start of a step after a time at which motions are not smooth.
    fn start_after_stop(&mut self) -> Result<(), Stopped> {
        let Self { equations, step: Step { t, start, slopes: [slope, _], .. }, next, .. } = self;
        equations.references.step_within(*t, *t + *next);
        equations.slope(*t, start, slope).map_err(|NotFinite| self.stuck(self.step.t, self.next))
    }

    /// Begins at the present motion, with the length of the first step to try, s.
    fn begin(&mut self, t: f64, next: f64) -> Result<(), Stopped> {
        (self.step.t, self.step.length, self.next, self.at_stop) = (t, 0.0, next, false);
        self.switches.start();
        let Step { end, slopes: [_, slope], .. } = &mut self.step;
        end.copy_from_slice(&self.motion);
        self.equations.make_relative(t, end);
        self.equations.references.step_within(t, t + next);
        self.equations.slope(t, end, slope).map_err(|NotFinite| self.stuck(t, next))
    }

    /// Moves to the end of a step, onto the loops of the crane.
    fn accept(&mut self, reached: f64) -> Result<(), Stopped> {
        let n = self.equations.n;
        // The error of the step is known; its storage holds the change until the next one.
        let Self { equations, step, .. } = self;
        let length = step.length;
        self.norm.note(&step.end, &step.error);
        if let Err(open) = equations.project_end(reached, &mut step.end, &mut step.error) {
            let q = &self.motion[..n];
            let description = equations.crane.description();
            let context = StepContext { method: F::METHOD, t: reached, h: length, q, description };
            return Err(context.opened(equations.crane, open));
        }
        self.motion.copy_from_slice(&self.step.end);
        self.equations.make_absolute(reached, &mut self.motion);
        let (q, v) = self.motion[..2 * n].split_at(n);
        self.norm.note_state(self.equations.crane, reached, q, v);
        Ok(())
    }
}

impl<F: Formula + Send> Stepper for Adaptive<'_, F> {
    fn start(&mut self, t: f64, motion: &[f64]) -> Result<(), Stopped> {
        self.motion.copy_from_slice(motion);
        let mut start = motion.to_vec();
        self.equations.make_relative(t, &mut start);
        self.norm.start(&mut self.equations, t, &start);
        self.begin(t, FIRST)
    }

    fn step(&mut self, ahead: &Ahead) -> Result<f64, Stopped> {
        self.step.proceed();
        if self.at_stop {
            self.start_after_stop()?;
        }
        let t = self.step.t;
        let (mut change, mut repeats) = (f64::INFINITY, 0);
        loop {
            if self.next < LEAST * ahead.result {
                return Err(self.stuck(t, self.next));
            }
            let stop = ahead.stop.min(change);
            let stops = t + self.next * (1.0 + SLIVER) >= stop || change < f64::INFINITY;
            self.step.length = if stops { stop - t } else { self.next };
            self.equations.references.step_within(t, self.step.reached());
            let tried = self.formula.attempt(&mut self.equations, &mut self.step);
            let meets = self.judge(tried);
            let watched = if meets { self.watched } else { Watched::All };
            let found = tried.ok().filter(|()| repeats < Switches::REPEATS).and_then(|()| self.change(watched));
            if meets && found.is_none() {
                self.steps += 1;
                let reached = if stops { stop } else { self.step.reached() };
                self.at_stop = stops && stop >= ahead.stop;
                if change < f64::INFINITY && self.switches.is_of_limit() {
                    self.next = self.next.min(AFRESH);
                }
                self.switches.proceed(change < f64::INFINITY);
                self.accept(reached)?;
                return Ok(reached);
            }
            self.rejections += 1;
            change = found.unwrap_or(f64::INFINITY);
            repeats += usize::from(found.is_some());
        }
    }

    fn motion(&self) -> &[f64] {
        &self.motion
    }

    fn interpolate(&mut self, t: f64, motion: &mut [f64]) {
        self.step.at(t, motion);
        for coordinate in self.equations.references.coordinates() {
            motion[self.equations.n + coordinate] = self.step.rate_at(t, self.equations.n, coordinate);
        }
        self.equations.make_absolute(t, motion);
    }

    fn statistics(&self) -> Statistics {
        Statistics {
            steps: self.steps,
            rejections: self.rejections,
            evaluations: self.equations.evaluations,
            factorisations: self.formula.factorisations(),
        }
    }

    fn efforts(&self) -> Vec<EffortAccuracy> {
        self.norm.efforts().collect()
    }
}

impl<F: Formula + Send> Steered for Adaptive<'_, F> {
    /// The length of the next step stays as intended; its error decides.
    fn change(&mut self, t: f64, change: &mut dyn FnMut()) -> Result<(), Stopped> {
        let mut motion = std::mem::take(&mut self.motion);
        self.interpolate(t, &mut motion);
        change();
        self.equations.forget();
        self.formula.forget();
        self.motion = motion;
        self.begin(t, self.next)
    }

    fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let Self { formula, equations, norm, next, step, at_stop, switches, motion, steps, rejections, .. } = self;
        formula.visit(visit);
        equations.visit(visit);
        norm.visit(visit);
        visit(next);
        step.visit(visit);
        visit_flag(at_stop, visit);
        switches.visit(visit);
        visit_numbers(motion, visit);
        for count in [steps, rejections] {
            visit_count(count, visit);
        }
    }
}
