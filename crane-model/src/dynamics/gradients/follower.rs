//! The derivatives of a motion, step by step behind the motion itself.

use super::{SAME, Slopes, jump::of_functions_of_time, rates::Rates};
use crate::{
    dyn_crane::DynCrane,
    dynamics::{
        Ahead, EffortAccuracy, NotFinite, Settings, Statistics, Stepper, Stopped,
        adaptive::{Adaptive, FIRST},
        equations::Equations,
        motion::add,
        norm::Norm,
        references::{INSIDE, References},
        rosenbrock::{STAGES, Stages, add_error, add_stages},
        step::Step,
    },
};

/// A motion of a crane by the W-method, whose steps end where derivatives need it.
pub(super) fn motion_of(crane: &dyn DynCrane, tolerance: f64) -> Adaptive<'_, Stages<'_>> {
    let equations = Equations::new(crane, References::new(crane));
    let stages = Stages::new(crane, equations.len());
    let norm = Norm::with_efforts(crane, &equations.references, tolerance);
    Adaptive::new(stages, equations, norm).watching_all()
}

/// A motion integrated by the W-method, and its derivatives along directions.
pub(super) struct Follower<'a, 's> {
    crane: &'a dyn DynCrane,
    pub motion: Adaptive<'a, Stages<'a>>,
    variation: Variation<'a, 's>,
    /// The derivatives of the start.
    start: Vec<Vec<f64>>,
    /// The last step of each derivative, relative to those of the drives' motions.
    steps: Vec<Step>,
    /// uᵢ of each derivative.
    u: Vec<Vec<Vec<f64>>>,
    /// Places and rates of the derivatives.
    places: Vec<Vec<f64>>,
    rates: Vec<Vec<f64>>,
    /// Times at which functions of time are not smooth, with their derivatives.
    stops: Vec<(f64, Vec<f64>)>,
    /// Whether the last step ended at a stop.
    at_stop: bool,
}

/// The derivative of the rates of a motion that is relative to the motions of drives.
struct Variation<'a, 's> {
    slopes: &'s mut dyn Slopes,
    rates: Rates<'a>,
    n: usize,
    /// The motion and its derivatives in full.
    motion: Vec<f64>,
    along: Vec<Vec<f64>>,
    /// Derivatives of the drives' motions, direction by direction, at three times; and of their accelerations.
    motions: [Vec<Vec<[f64; 2]>>; 3],
    of_drives: Vec<Vec<f64>>,
}

impl<'a, 's> Follower<'a, 's> {
    /// Creates the motion, with the derivatives of its start, in full.
    pub fn new(
        crane: &'a dyn DynCrane,
        any: &'a dyn DynCrane,
        slopes: &'s mut dyn Slopes,
        start: Vec<Vec<f64>>,
        settings: &Settings,
    ) -> Self {
        let motion = motion_of(any, settings.tolerance);
        let (n, len, count) = (crane.size(), motion.motion().len(), start.len());
        let stops = slopes.stops();
        let zeros = || vec![vec![0.0; len]; count];
        let drives = crane.description().drives.len();
        let motions = || vec![vec![[0.0; 2]; drives]; count];
        let variation = Variation {
            slopes,
            rates: Rates::new(crane, count),
            n,
            motion: vec![0.0; len],
            along: zeros(),
            motions: [motions(), motions(), motions()],
            of_drives: vec![vec![0.0; drives]; count],
        };
        Self {
            crane,
            motion,
            variation,
            start,
            steps: (0..count).map(|_| Step::new(len)).collect(),
            u: vec![vec![vec![0.0; len]; STAGES]; count],
            places: zeros(),
            rates: zeros(),
            stops,
            at_stop: false,
        }
    }

    /// Derivatives of the motion at a time within the last step, direction by direction.
    pub fn derivatives(&mut self, t: f64) -> Vec<Vec<f64>> {
        let Self { motion: own, variation, steps, places, .. } = self;
        let mut motion = own.motion().to_vec();
        own.interpolate(t, &mut motion);
        let (_, equations, ..) = own.last();
        let n = variation.n;
        for (place, step) in places.iter_mut().zip(&*steps) {
            step.at(t, place);
            for coordinate in equations.references.coordinates() {
                place[n + coordinate] = step.rate_at(t, n, coordinate);
            }
        }
        equations.make_relative(t, &mut motion);
        variation.project(equations, t, &motion, places);
        variation.complete(equations, t, &motion, places);
        variation.along.clone()
    }

    /// The same at the event that ends a phase, where functions of time may not be smooth, too.
    pub fn at_event(&mut self, t: f64) -> Result<Vec<Vec<f64>>, Stopped> {
        if t >= self.motion.last().2.reached() {
            self.jump().map_err(|NotFinite| self.motion.stuck(t, FIRST))?;
        }
        Ok(self.derivatives(t))
    }

    /// The numbers by which it is differentiated.
    pub fn slopes(&self) -> &dyn Slopes {
        self.variation.slopes
    }

    /// Follows the last step of the motion.
    fn follow(&mut self) -> Result<(), NotFinite> {
        let Self { motion, variation, steps, u, places, rates, .. } = self;
        let (stages, equations, step) = motion.last();
        let (t, h) = (step.t, step.length);
        for own in steps.iter_mut() {
            own.proceed();
            (own.t, own.length) = (t, h);
        }
        for stage in 0..STAGES {
            if stage > 0 {
                for ((place, own), u) in places.iter_mut().zip(&*steps).zip(&*u) {
                    place.copy_from_slice(&own.start);
                    add_stages(stage, u, place);
                }
                let (after, motion) = stages.place(stage, h);
                variation.differentiate(equations, t + after, motion, places, rates)?;
            }
            for ((rates, own), u) in rates.iter().zip(&*steps).zip(&mut *u) {
                stages.follow(stage, h, if stage > 0 { rates } else { &own.slopes[0] }, u);
            }
        }
        for ((place, own), u) in places.iter_mut().zip(&*steps).zip(&*u) {
            place.copy_from_slice(&own.start);
            add_stages(STAGES, u, place);
        }
        variation.project(equations, step.reached(), &step.end, places);
        variation.differentiate(equations, step.reached(), &step.end, places, rates)?;
        for ((place, rates), own) in places.iter().zip(&*rates).zip(&mut *steps) {
            own.end.copy_from_slice(place);
            own.slopes[1].copy_from_slice(rates);
        }
        let (error, change) = (&mut vec![0.0; variation.motion.len()], &mut vec![0.0; variation.motion.len()]);
        for (direction, (u, step)) in u.iter().zip(&*steps).enumerate() {
            let scale = variation.slopes.scale(direction);
            error.fill(0.0);
            add_error(scale, u, error);
            change.iter_mut().zip(&step.end).for_each(|(change, slope)| *change = scale * slope);
            motion.heed(error, change);
        }
        Ok(())
    }

    /// Lets the derivatives jump where the last step ended at a time at which functions of time are not smooth.
    fn jump(&mut self) -> Result<(), NotFinite> {
        if !self.at_stop {
            return Ok(());
        }
        let Self { crane, motion, variation, steps, rates, stops, .. } = self;
        let (_, equations, step) = motion.last();
        let (t, h, end) = (step.reached(), step.length, step.end.clone());
        // Derivatives before the change, in full.
        let ends: Vec<Vec<f64>> = steps.iter().map(|step| step.end.clone()).collect();
        variation.complete(equations, t, &end, &ends);
        let mut along = variation.along.clone();
        let here = stops.iter().filter(|(time, _)| (time - t).abs() <= SAME * (1.0 + t));
        let here: Vec<&[f64]> = here.map(|(_, times)| times.as_slice()).collect();
        let jumps = of_functions_of_time(*crane, &*variation.slopes, &here, (t, &variation.motion))?;
        along.iter_mut().zip(&jumps).for_each(|(along, jump)| add(along, 1.0, jump));
        // What follows is evaluated after the change.
        equations.references.step_within(t, t + h);
        variation.make_relative(equations, t, &mut along);
        variation.differentiate(equations, t, &end, &along, rates)?;
        for ((along, rates), own) in along.iter().zip(&*rates).zip(steps) {
            own.end.copy_from_slice(along);
            own.slopes[1].copy_from_slice(rates);
        }
        Ok(())
    }
}

impl Variation<'_, '_> {
    /// Derivatives of the drives' motions at a time, slightly inside the present step; whether there are any.
    fn drives_at(&mut self, equations: &Equations<'_>, t: f64) -> (f64, bool) {
        let t = equations.references.strictly_inside(t);
        (t, self.slopes.drive_motions(t, &mut self.motions[0]))
    }

    /// Writes the motion and its derivatives in full; returns the time at which functions of time are evaluated, and whether the motions of
    /// drives have derivatives.
    fn complete(&mut self, equations: &mut Equations<'_>, t: f64, motion: &[f64], along: &[Vec<f64>]) -> (f64, bool) {
        let (inside, moves) = self.drives_at(equations, t);
        self.motion.copy_from_slice(motion);
        equations.make_absolute(t, &mut self.motion);
        for ((own, along), motions) in self.along.iter_mut().zip(along).zip(&self.motions[0]) {
            own.copy_from_slice(along);
            if moves {
                for reference in equations.references.all() {
                    let [position, rate] = motions[reference.drive];
                    own[reference.coordinate] += position;
                    own[self.n + reference.coordinate] += rate;
                }
            }
        }
        (inside, moves)
    }

    /// Makes derivatives relative to those of the drives' motions; those of prescribed coordinates are then zero.
    fn make_relative(&mut self, equations: &Equations<'_>, t: f64, along: &mut [Vec<f64>]) {
        let (_, moves) = self.drives_at(equations, t);
        for (along, motions) in along.iter_mut().zip(&self.motions[0]) {
            for reference in equations.references.all() {
                let [position, rate] = if moves { motions[reference.drive] } else { [0.0; 2] };
                for (index, of_drive) in [(reference.coordinate, position), (self.n + reference.coordinate, rate)] {
                    along[index] = if reference.rigid { 0.0 } else { along[index] - of_drive };
                }
            }
        }
    }

    /// The derivatives of the rates, of a motion with derivatives, all relative to the motions of drives.
    fn differentiate(
        &mut self,
        equations: &mut Equations<'_>,
        t: f64,
        motion: &[f64],
        along: &[Vec<f64>],
        out: &mut [Vec<f64>],
    ) -> Result<(), NotFinite> {
        let (t, moves) = self.complete(equations, t, motion, along);
        if moves {
            let (shifts, weights, by) = equations.references.differences(t);
            let [now, near @ ..] = &mut self.motions;
            for (shift, near) in shifts.iter().zip(near.iter_mut()) {
                self.slopes.drive_motions(t + shift, near);
            }
            for (direction, of_drives) in self.of_drives.iter_mut().enumerate() {
                for (drive, acceleration) in of_drives.iter_mut().enumerate() {
                    let rates = [&*now, &near[0], &near[1]].map(|motions| motions[direction][drive][1]);
                    *acceleration = rates.iter().zip(weights).map(|(rate, weight)| rate * weight).sum::<f64>() / by;
                }
            }
        }
        let Self { slopes, rates, motion, along, of_drives, motions, n, .. } = self;
        rates.differentiate(&mut **slopes, (t, motion), along, of_drives, out)?;
        for reference in equations.references.all() {
            for ((out, motions), of_drives) in out.iter_mut().zip(&motions[0]).zip(&*of_drives) {
                let [position, rate] = [reference.coordinate, *n + reference.coordinate];
                if reference.rigid {
                    (out[position], out[rate]) = (0.0, 0.0);
                } else if moves {
                    out[position] -= motions[reference.drive][1];
                    out[rate] -= of_drives[reference.drive];
                }
            }
        }
        Ok(())
    }

    /// Moves derivatives, relative to those of the drives' motions, onto the loops of the crane.
    fn project(&mut self, equations: &mut Equations<'_>, t: f64, motion: &[f64], along: &mut [Vec<f64>]) {
        if !equations.has_loops() {
            return;
        }
        self.complete(equations, t, motion, along);
        let mut full = std::mem::take(&mut self.along);
        self.rates.project(self.slopes, (t, &self.motion), &mut full);
        self.make_relative(equations, t, &mut full);
        along.iter_mut().zip(&full).for_each(|(along, full)| along.copy_from_slice(full));
        self.along = full;
    }
}

impl Stepper for Follower<'_, '_> {
    fn start(&mut self, t: f64, motion: &[f64]) -> Result<(), Stopped> {
        self.motion.start(t, motion)?;
        let Self { motion: own, variation, start, steps, rates, .. } = self;
        let (_, equations, step) = own.last();
        let mut end = step.end.clone();
        let mut along = start.clone();
        variation.make_relative(equations, t, &mut along);
        variation.project(equations, t, &end, &mut along);
        // Where a law changes its branch right at the start, as that of a side at tank pressure, what follows is on the branch to which it goes.
        add(&mut end, INSIDE * FIRST, &step.slopes[1]);
        let found = variation.differentiate(equations, t, &end, &along, rates);
        for ((own, along), rates) in steps.iter_mut().zip(&along).zip(&*rates) {
            (own.t, own.length) = (t, 0.0);
            own.end.copy_from_slice(along);
            own.slopes[1].copy_from_slice(rates);
        }
        found.map_err(|NotFinite| own.stuck(t, FIRST))
    }

    fn step(&mut self, ahead: &Ahead) -> Result<f64, Stopped> {
        let stuck = |follower: &mut Self| {
            let (_, _, step) = follower.motion.last();
            let (t, h) = (step.t, step.length);
            follower.motion.stuck(t, h)
        };
        self.jump().map_err(|NotFinite| stuck(self))?;
        let reached = self.motion.step(ahead)?;
        self.follow().map_err(|NotFinite| stuck(self))?;
        self.at_stop = reached >= ahead.stop;
        Ok(reached)
    }

    fn motion(&self) -> &[f64] {
        self.motion.motion()
    }

    fn interpolate(&mut self, t: f64, motion: &mut [f64]) {
        self.motion.interpolate(t, motion);
    }

    fn statistics(&self) -> Statistics {
        self.motion.statistics()
    }

    fn efforts(&self) -> Vec<EffortAccuracy> {
        self.motion.efforts()
    }
}
