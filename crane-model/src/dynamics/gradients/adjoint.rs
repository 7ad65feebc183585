//! The derivatives of one number of a motion with respect to any number of others: from the end of the motion to its start.
//!
//! The steps of [`follower`](super::follower) are linear maps of derivatives. Transposed, and in reverse order, they carry the derivative of one
//! number by the motion at the end of a step to that by the motion at its start, and collect the derivatives by parameters and inputs on the way:
//! the result is that of the forward mode with the same steps, up to rounding (A. Griewank, A. Walther, Evaluating Derivatives, SIAM 2008,
//! chapter 3). Steps are kept as their starts and are taken a second time, so that memory grows by two motions per step.

use std::ops::ControlFlow;

use super::{
    Covector, Numbers, PullBacks, SAME, Slopes,
    follower::{Follower, motion_of},
    jump::of_functions_of_time,
    pass,
    passage::Passage,
    rates::Rates,
};
use crate::{
    dyn_crane::DynCrane,
    dynamics::{
        Ahead, Course, EffortAccuracy, InitialState, Integration, NotFinite, Quantities, Run, Settings, Statistics,
        Stepper, Stopped, Watch,
        adaptive::{Adaptive, FIRST},
        course::Observe,
        equations::Equations,
        motion::add,
        references::INSIDE,
        rosenbrock::{A, C, STAGES, Stages, WEIGHTS},
        step::Step,
    },
};

/// A step that was taken.
struct Kept {
    t: f64,
    length: f64,
    start: Vec<f64>,
    /// The slope at its start.
    slope: Vec<f64>,
    /// Whether it ended where functions of time are not smooth.
    at_stop: bool,
}

/// A motion that keeps its steps.
struct Keeper<'a, 's> {
    follower: Follower<'a, 's>,
    kept: Vec<Kept>,
}

impl Keeper<'_, '_> {
    fn keep(&mut self, at_stop: bool) {
        let (.., step) = self.follower.motion.last();
        let [slope, _] = &step.slopes;
        self.kept.push(Kept {
            t: step.t,
            length: step.length,
            start: step.start.clone(),
            slope: slope.clone(),
            at_stop,
        });
    }
}

impl Stepper for Keeper<'_, '_> {
    fn start(&mut self, t: f64, motion: &[f64]) -> Result<(), Stopped> {
        self.follower.start(t, motion)?;
        self.keep(false);
        Ok(())
    }

    fn step(&mut self, ahead: &Ahead) -> Result<f64, Stopped> {
        let reached = self.follower.step(ahead)?;
        self.keep(reached >= ahead.stop);
        Ok(reached)
    }

    fn motion(&self) -> &[f64] {
        self.follower.motion()
    }

    fn interpolate(&mut self, t: f64, motion: &mut [f64]) {
        self.follower.interpolate(t, motion);
    }

    fn statistics(&self) -> Statistics {
        self.follower.statistics()
    }

    fn efforts(&self) -> Vec<EffortAccuracy> {
        self.follower.efforts()
    }
}

/// A phase of a motion, from one event to the next.
struct Leg {
    /// The crane after the events before it; none for the first.
    crane: Option<Box<dyn DynCrane>>,
    kept: Vec<Kept>,
    /// The motion at the end of its last step.
    end: Vec<f64>,
    /// The event that ends it.
    passage: Option<Passage>,
}

/// A motion whose numbers can be differentiated.
pub struct Trace<'a> {
    crane: &'a dyn DynCrane,
    tolerance: f64,
    legs: Vec<Leg>,
    /// The phase and the step in which each sample is, and its time, s.
    samples: Vec<(usize, usize, f64)>,
    run: Run,
}

/// Notes where samples are, and passes them on.
struct Noted<'w> {
    watch: &'w mut dyn Watch,
    leg: usize,
    samples: &'w mut Vec<(usize, usize, f64)>,
}

impl Observe<Keeper<'_, '_>> for Noted<'_> {
    fn sample(
        &mut self,
        _: &dyn DynCrane,
        integration: &mut Integration<'_, Keeper<'_, '_>>,
        course: &Course,
    ) -> ControlFlow<()> {
        let step = integration.stepper().kept.len() - 1;
        let sample = course.sample(integration);
        self.samples.push((self.leg, step, sample.t));
        self.watch.sample(&sample)
    }

    fn step(&mut self, t: f64) -> ControlFlow<()> {
        self.watch.step(t)
    }
}

/// The derivatives of a number by what a motion has, from which those by the start follow.
#[derive(Clone, Copy, Debug)]
pub struct Weights<'a> {
    /// By the motion at samples, given by their indices in increasing order, and by all numbers.
    pub samples: &'a [(usize, Covector)],
    /// By the times of events on conditions.
    pub times: &'a [f64],
}

impl<'a> Trace<'a> {
    /// A motion from a start at t = 0, by the W-method; the method of the settings is not used. Its steps also allow the errors of a few derivatives,
    /// `probes`, whose start is `along`: what is differentiated may change faster than the motion itself.
    ///
    /// # Errors
    /// As [`simulate`](super::simulate).
    pub fn new(
        crane: &'a dyn DynCrane,
        start: &InitialState,
        (probes, mut along): (&mut dyn Slopes, Vec<Vec<f64>>),
        settings: &Settings,
        quantities: &Quantities,
        watch: &mut dyn Watch,
    ) -> Result<Self, Stopped> {
        let mut course = Course::new(crane, 0.0, start, settings, quantities);
        let (mut legs, mut samples): (Vec<Leg>, _) = (Vec::new(), Vec::new());
        let mut changed = None::<(Box<dyn DynCrane>, Box<dyn Slopes>)>;
        let mut times = vec![0.0; along.len()];
        loop {
            let (present, probes): (&dyn DynCrane, &mut dyn Slopes) = match &mut changed {
                Some((crane, probes)) => (&**crane, &mut **probes),
                None => (crane, &mut *probes),
            };
            let (begin, state, settings) = course.phase();
            let any: &dyn DynCrane = present;
            let keeper = Keeper { follower: Follower::new(present, any, probes, along, &settings), kept: Vec::new() };
            let mut integration = Integration::by(Box::new(keeper), any, begin, state, &settings)?;
            let mut noted = Noted { watch: &mut *watch, leg: legs.len(), samples: &mut samples };
            let happening = course.follow(present, &mut integration, &mut noted)?;
            let mut event = None;
            if let Some(happening) = happening {
                let t = integration.sample().t;
                let mut derivatives = integration.stepper().follower.at_event(t)?;
                let (after, passage) = pass(&mut course, present, &integration, happening)?;
                let probes = integration.stepper().follower.slopes();
                passage.push(present, probes, &mut derivatives, &mut times);
                let probes = probes.after(passage.event());
                let probes = probes.map_err(|error| course.refuse(present, happening, &error.to_string()))?;
                event = Some((derivatives, passage, (after, probes)));
            }
            let run = course.run(&integration);
            let Keeper { mut follower, kept } = integration.into_stepper();
            let end = follower.motion.last().2.end.clone();
            drop(follower);
            let own = changed.take().map(|(crane, _)| crane);
            let Some((derivatives, passage, next)) = event else {
                legs.push(Leg { crane: own, kept, end, passage: None });
                return Ok(Self { crane, tolerance: settings.tolerance, legs, samples, run });
            };
            legs.push(Leg { crane: own, kept, end, passage: Some(passage) });
            (along, changed) = (derivatives, Some(next));
        }
    }

    /// Statistics of the run.
    #[must_use]
    pub fn run(&self) -> Run {
        self.run.clone()
    }

    /// The functions of the crane after each of the events, from those before.
    pub fn functions_after(&self, functions: &dyn PullBacks) -> Option<Vec<Box<dyn PullBacks>>> {
        let mut all: Vec<Box<dyn PullBacks>> = Vec::new();
        for passage in self.legs.iter().filter_map(|leg| leg.passage.as_ref()) {
            all.push(all.last().map_or(functions, |last| &**last).after(passage.event())?);
        }
        Some(all)
    }

    /// The number of events before a sample, and the crane after them.
    #[must_use]
    pub fn crane_at(&self, sample: usize) -> (usize, &dyn DynCrane) {
        let leg = self.samples[sample].0;
        (leg, self.crane_of(leg))
    }

    fn crane_of(&self, leg: usize) -> &dyn DynCrane {
        self.legs[leg].crane.as_deref().unwrap_or(self.crane)
    }

    /// The derivative of a number with respect to the start and all numbers, from its weights. `functions` are those of the crane from the beginning on
    /// and [after each of the events](Self::functions_after). `proceed` receives the time of every step and may end the way back.
    ///
    /// # Errors
    /// A derivative is not finite, or not known because `proceed` has ended the way back.
    pub fn pull_back(
        &self,
        functions: &mut [&mut dyn PullBacks],
        weights: Weights<'_>,
        proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Covector, NotFinite> {
        let Some(first) = functions.first() else { return Err(NotFinite) };
        let mut sum = Covector::zero(self.legs[0].end.len(), first.count());
        let own = |leg: usize| {
            let samples = weights.samples;
            let from = samples.partition_point(|(sample, _)| self.samples[*sample].0 < leg);
            let to = samples.partition_point(|(sample, _)| self.samples[*sample].0 <= leg);
            &samples[from..to]
        };
        let of_time = |leg: &Leg| {
            let condition = leg.passage.as_ref().and_then(Passage::condition);
            condition.map_or(0.0, |condition| weights.times[condition])
        };
        // The number does not depend on what comes later.
        let is_last = |leg: usize| !own(leg).is_empty() || of_time(&self.legs[leg]) != 0.0;
        let last = (0..self.legs.len()).rev().find(|leg| is_last(*leg)).unwrap_or_default();
        let mut earlier = 0.0;
        for leg in (0..=last).rev() {
            let Leg { passage, .. } = &self.legs[leg];
            let functions = &mut *functions[leg];
            let mut ending = None;
            if let Some(passage) = passage.as_ref().filter(|_| leg < last || of_time(&self.legs[leg]) != 0.0) {
                let cranes = [self.crane_of(leg), self.crane_of(leg + 1)];
                let time = earlier + of_time(&self.legs[leg]);
                earlier = passage.pull(cranes, &*functions, &mut sum, time);
                ending = Some((passage.time(), Covector { motion: sum.motion.clone(), numbers: sum.numbers.clone() }));
                sum.motion.fill(0.0);
            }
            let samples =
                own(leg).iter().map(|(sample, covector)| (self.samples[*sample].1, self.samples[*sample].2, covector));
            let samples: Vec<_> = samples.collect();
            self.pull_back_leg(leg, functions, &samples, ending.as_ref(), &mut sum, proceed)?;
        }
        Ok(sum)
    }

    /// The same over a phase, from the weights of its samples and of the motion at the event that ends it: adds the derivatives by its beginning.
    fn pull_back_leg(
        &self,
        leg: usize,
        functions: &mut dyn PullBacks,
        samples: &[(usize, f64, &Covector)],
        event: Option<&(f64, Covector)>,
        sum: &mut Covector,
        proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(), NotFinite> {
        let Leg { kept, end, .. } = &self.legs[leg];
        let (crane, len) = (self.crane_of(leg), end.len());
        let mut motion = motion_of(crane, self.tolerance);
        let mut sweep = Sweep::new(crane, functions);
        // Weights of the slope at the end of a step.
        let mut of_slope = vec![0.0; len];
        let mut ahead = samples.len();
        let last = if event.is_some() { kept.len() - 1 } else { samples.last().map_or(0, |(step, ..)| *step) };
        for index in (0..=last).rev() {
            let end = kept.get(index + 1).map_or(end, |next| &next.start);
            let own = &kept[index];
            if index > 0 {
                motion.repeat([own.t, own.length], [&own.start, &own.slope], end)?;
            } else {
                motion.go_back(own.t, end)?;
            }
            let mut before = Before::zero(len);
            if let Some((t, covector)) = event.filter(|_| index == last) {
                if own.at_stop {
                    sweep.complete(motion.last().1, (*t, end));
                    sweep.add_jump(*t, &covector.motion, &mut sum.numbers)?;
                }
                sweep.add_sample(&mut motion, *t, covector, sum, &mut of_slope, &mut before);
            }
            while let Some((step, t, covector)) = ahead.checked_sub(1).map(|last| &samples[last]) {
                if *step != index {
                    break;
                }
                ahead -= 1;
                add(&mut sum.numbers, 1.0, &covector.numbers);
                sweep.add_sample(&mut motion, *t, covector, sum, &mut of_slope, &mut before);
            }
            if index == 0 {
                sweep.begin(&mut motion, &of_slope, sum)?;
                break;
            }
            let (stages, equations, step) = motion.last();
            sweep.pull_back(equations, (step.reached(), &step.end), &of_slope, sum)?;
            sweep.project(equations, (step.reached(), &step.end), sum);
            sweep.through(stages, equations, step, sum, &mut before)?;
            of_slope = before.slope;
            if kept[index - 1].at_stop {
                let before = &kept[index - 1];
                sweep.jump(equations, (own.t, &own.start), [before.t, before.length], &of_slope, sum)?;
                of_slope.fill(0.0);
            }
            if proceed(own.t).is_break() {
                return Err(NotFinite);
            }
        }
        Ok(())
    }
}

/// Weights of the start of a step and of the slope there.
struct Before {
    start: Vec<f64>,
    slope: Vec<f64>,
}

impl Before {
    fn zero(len: usize) -> Self {
        Self { start: vec![0.0; len], slope: vec![0.0; len] }
    }
}

/// Transposed maps of derivatives; motions and their weights are relative to those of the drives' motions, unless they are in full.
struct Sweep<'a, 'f> {
    crane: &'a dyn DynCrane,
    functions: &'f mut dyn PullBacks,
    rates: Rates<'a>,
    n: usize,
    /// Times at which functions of time are not smooth, with their derivatives.
    stops: Vec<(f64, Vec<f64>)>,
    /// The motion in full.
    motion: Vec<f64>,
    /// Weights of the drives' motions, and of their accelerations.
    motions: Vec<[f64; 2]>,
    of_drives: Vec<f64>,
}

impl<'a, 'f> Sweep<'a, 'f> {
    fn new(crane: &'a dyn DynCrane, functions: &'f mut dyn PullBacks) -> Self {
        let drives = crane.description().drives.len();
        let rates = Rates::new(crane, 0);
        Self {
            n: crane.size(),
            motion: Vec::new(),
            motions: vec![[0.0; 2]; drives],
            of_drives: vec![0.0; drives],
            stops: functions.stops(),
            crane,
            functions,
            rates,
        }
    }

    /// Writes the motion in full.
    fn complete(&mut self, equations: &mut Equations<'_>, (t, motion): (f64, &[f64])) {
        self.motion.clear();
        self.motion.extend_from_slice(motion);
        equations.make_absolute(t, &mut self.motion);
    }

    /// From weights in full to relative ones: adds what the drives' motions contribute.
    fn make_relative(&mut self, equations: &Equations<'_>, t: f64, sum: &mut Covector) {
        self.add_motions(equations, t, 1.0, |_| true, sum);
        for reference in equations.references.all().iter().filter(|reference| reference.rigid) {
            (sum.motion[reference.coordinate], sum.motion[self.n + reference.coordinate]) = (0.0, 0.0);
        }
    }

    /// From relative weights to weights in full; those of prescribed coordinates are zero.
    fn make_absolute(&mut self, equations: &Equations<'_>, t: f64, sum: &mut Covector) {
        for reference in equations.references.all().iter().filter(|reference| reference.rigid) {
            (sum.motion[reference.coordinate], sum.motion[self.n + reference.coordinate]) = (0.0, 0.0);
        }
        self.add_motions(equations, t, -1.0, |rigid| !rigid, sum);
    }

    fn add_motions(
        &mut self,
        equations: &Equations<'_>,
        t: f64,
        sign: f64,
        counts: impl Fn(bool) -> bool,
        sum: &mut Covector,
    ) {
        let t = equations.references.strictly_inside(t);
        self.motions.fill([0.0; 2]);
        for reference in equations.references.all().iter().filter(|reference| counts(reference.rigid)) {
            for (weight, index) in self.motions[reference.drive].iter_mut().zip([0, self.n]) {
                *weight += sign * sum.motion[index + reference.coordinate];
            }
        }
        self.functions.drive_motions(t, &self.motions, sum);
    }

    /// Adds the weights of a motion, from those of its slope.
    fn pull_back(
        &mut self,
        equations: &mut Equations<'_>,
        (t, motion): (f64, &[f64]),
        weights: &[f64],
        sum: &mut Covector,
    ) -> Result<(), NotFinite> {
        if weights.iter().all(|weight| *weight == 0.0) {
            return Ok(());
        }
        self.complete(equations, (t, motion));
        let (t, n) = (equations.references.strictly_inside(t), self.n);
        let mut weights = weights.to_vec();
        self.of_drives.fill(0.0);
        self.motions.fill([0.0; 2]);
        for reference in equations.references.all() {
            let [position, rate] = [reference.coordinate, n + reference.coordinate];
            if reference.rigid {
                (weights[position], weights[rate]) = (0.0, 0.0);
            }
            self.motions[reference.drive][1] -= weights[position];
            self.of_drives[reference.drive] -= weights[rate];
        }
        let mut own = Covector::zero(sum.motion.len(), sum.numbers.len());
        self.rates.pull_back(self.functions, (t, &self.motion), &weights, &mut self.of_drives, &mut own)?;
        for reference in equations.references.all() {
            let [position, rate] = [reference.coordinate, n + reference.coordinate].map(|index| own.motion[index]);
            let motions = &mut self.motions[reference.drive];
            *motions = [motions[0] + position, motions[1] + rate];
            if reference.rigid {
                (own.motion[reference.coordinate], own.motion[n + reference.coordinate]) = (0.0, 0.0);
            }
        }
        add(&mut sum.motion, 1.0, &own.motion);
        add(&mut sum.numbers, 1.0, &own.numbers);
        self.functions.drive_motions(t, &self.motions, sum);
        let (shifts, factors, by) = equations.references.differences(t);
        for (shift, factor) in [0.0, shifts[0], shifts[1]].into_iter().zip(factors) {
            for (motions, of_drive) in self.motions.iter_mut().zip(&self.of_drives) {
                *motions = [0.0, of_drive * factor / by];
            }
            self.functions.drive_motions(t + shift, &self.motions, sum);
        }
        Ok(())
    }

    /// The transpose of moving derivatives onto the loops of the crane.
    fn project(&mut self, equations: &mut Equations<'_>, (t, motion): (f64, &[f64]), sum: &mut Covector) {
        if !equations.has_loops() {
            return;
        }
        self.complete(equations, (t, motion));
        self.make_absolute(equations, t, sum);
        self.rates.pull_back_projection(self.functions, (t, &self.motion), sum);
        self.make_relative(equations, t, sum);
    }

    /// From the weights of the end of a step to those of its start, and of the slope there.
    fn through(
        &mut self,
        stages: &mut Stages<'_>,
        equations: &mut Equations<'_>,
        step: &Step,
        sum: &mut Covector,
        before: &mut Before,
    ) -> Result<(), NotFinite> {
        let len = sum.motion.len();
        let mut of_u: Vec<Vec<f64>> =
            WEIGHTS.iter().map(|weight| sum.motion.iter().map(|of_end| weight * of_end).collect()).collect();
        add(&mut before.start, 1.0, &sum.motion);
        let mut of_rates = vec![0.0; len];
        for stage in (0..STAGES).rev() {
            let (earlier, own) = of_u.split_at_mut(stage);
            stages.pull_back(&own[0], &mut of_rates);
            for (of_u, factor) in earlier.iter_mut().zip(C[stage]) {
                add(of_u, factor / step.length, &of_rates);
            }
            if stage == 0 {
                add(&mut before.slope, 1.0, &of_rates);
                break;
            }
            let (after, place) = stages.place(stage, step.length);
            sum.motion.fill(0.0);
            self.pull_back(equations, (step.t + after, place), &of_rates, sum)?;
            add(&mut before.start, 1.0, &sum.motion);
            for (of_u, factor) in earlier.iter_mut().zip(A[stage]) {
                add(of_u, *factor, &sum.motion);
            }
        }
        sum.motion.copy_from_slice(&before.start);
        Ok(())
    }

    /// Adds what a sample at a time within the last step contributes: to the weights of its end and of the slope there, and of its start.
    fn add_sample(
        &mut self,
        own: &mut Adaptive<'_, Stages<'_>>,
        t: f64,
        by_sample: &Covector,
        sum: &mut Covector,
        of_slope: &mut [f64],
        before: &mut Before,
    ) {
        let n = self.n;
        let mut motion = vec![0.0; by_sample.motion.len()];
        own.interpolate(t, &mut motion);
        let (_, equations, step) = own.last();
        equations.make_relative(t, &mut motion);
        let mut sample = Covector { motion: by_sample.motion.clone(), numbers: vec![0.0; sum.numbers.len()] };
        self.make_relative(equations, t, &mut sample);
        self.project(equations, (t, &motion), &mut sample);
        add(&mut sum.numbers, 1.0, &sample.numbers);
        let mut weights = sample.motion;
        for coordinate in equations.references.coordinates() {
            let weight = std::mem::take(&mut weights[n + coordinate]);
            step.pull_back_rate(t, n, coordinate, weight, [&mut before.start, &mut sum.motion]);
        }
        step.pull_back(t, &weights, [&mut before.start, &mut sum.motion], [&mut before.slope, of_slope]);
    }

    /// From the weights of the slope and the motion after a time at which functions of time are not smooth to those of the motion before.
    fn jump(
        &mut self,
        equations: &mut Equations<'_>,
        (t, motion): (f64, &[f64]),
        [begin, length]: [f64; 2],
        of_slope: &[f64],
        sum: &mut Covector,
    ) -> Result<(), NotFinite> {
        equations.references.step_within(t, t + length);
        self.pull_back(equations, (t, motion), of_slope, sum)?;
        self.make_absolute(equations, t, sum);
        equations.references.step_within(begin, t);
        self.complete(equations, (t, motion));
        let Covector { motion: weights, numbers } = sum;
        self.add_jump(t, weights, numbers)?;
        self.make_relative(equations, t, sum);
        Ok(())
    }

    /// Adds what a jump of functions of time at the motion in full contributes, from weights in full.
    fn add_jump(&self, t: f64, weights: &[f64], sum: &mut [f64]) -> Result<(), NotFinite> {
        let here = self.stops.iter().filter(|(time, _)| (time - t).abs() <= SAME * (1.0 + t));
        let here: Vec<&[f64]> = here.map(|(_, times)| times.as_slice()).collect();
        let numbers: &dyn Numbers = &*self.functions;
        let jumps = of_functions_of_time(self.crane, numbers, &here, (t, &self.motion))?;
        for (number, jump) in sum.iter_mut().zip(&jumps) {
            *number += jump.iter().zip(weights).map(|(jump, weight)| jump * weight).sum::<f64>();
        }
        Ok(())
    }

    /// From the weights of the slope and the motion at the beginning to those of the start in full.
    fn begin(
        &mut self,
        own: &mut Adaptive<'_, Stages<'_>>,
        of_slope: &[f64],
        sum: &mut Covector,
    ) -> Result<(), NotFinite> {
        let (_, equations, step) = own.last();
        let (t, end) = (step.t, step.end.clone());
        let mut beside = end.clone();
        add(&mut beside, INSIDE * FIRST, &step.slopes[1]);
        self.pull_back(equations, (t, &beside), of_slope, sum)?;
        self.project(equations, (t, &end), sum);
        self.make_absolute(equations, t, sum);
        Ok(())
    }
}
