//! The equations of motion in first-order form.

use super::{
    references::References,
    state::{NotFinite, finite},
};
use crate::memory::{Visit, visit_count};
use crate::{
    StateAt,
    dyn_crane::Functions,
    force_states::ForceStates,
    loop_joints::{Loops, Open},
};

/// A crane, the references of its motions, and the number of evaluations of its accelerations.
pub(super) struct Equations<'a> {
    pub crane: &'a dyn Functions,
    /// Number of coordinates.
    pub n: usize,
    /// The references of the integrated numbers.
    pub references: References,
    /// Evaluations of the accelerations so far.
    pub evaluations: usize,
    /// Pose and rates of the last evaluated motion.
    state: Vec<f64>,
    /// Accelerations in full.
    accelerations: Vec<f64>,
    force_states: ForceStates,
    loops: Loops,
    /// Number of their states.
    states: usize,
}

impl<'a> Equations<'a> {
    /// The equations of a crane.
    pub fn new(crane: &'a dyn Functions, references: References) -> Self {
        let n = crane.size();
        let force_states = ForceStates::new(crane.description());
        let states = force_states.len();
        let loops = Loops::new(crane);
        Self {
            crane,
            n,
            references,
            evaluations: 0,
            state: vec![0.0; 2 * n],
            accelerations: vec![0.0; n],
            force_states,
            loops,
            states,
        }
    }

    /// The number of components of a motion: coordinates, rates and states of forces.
    pub fn len(&self) -> usize {
        2 * self.n + self.states
    }

    /// Number of states of forces.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Whether joints close loops.
    pub fn has_loops(&self) -> bool {
        !self.loops.is_empty()
    }

    /// Motions and commands change: what is kept of the last time does not hold any more.
    pub fn forget(&mut self) {
        self.references.forget();
        self.force_states.forget();
    }

    /// Visits what further evaluations depend on.
    pub fn visit(&mut self, visit: Visit<'_>) {
        self.forget();
        visit_count(&mut self.evaluations, visit);
        self.loops.visit(visit);
    }

    /// Converts a motion to deviations from the references.
    pub fn make_relative(&mut self, t: f64, motion: &mut [f64]) {
        self.references.make_relative(self.crane, t, self.n, motion);
    }

    /// The motion from its deviations from the references.
    pub fn make_absolute(&mut self, t: f64, motion: &mut [f64]) {
        self.references.add(self.crane, t, 1.0, self.n, motion);
    }

    /// The state of a motion given relative to the references.
    pub fn state<'s>(&'s mut self, t: f64, motion: &'s [f64]) -> StateAt<'s> {
        self.state.copy_from_slice(&motion[..2 * self.n]);
        self.references.add(self.crane, t, 1.0, self.n, &mut self.state);
        StateAt { x: &motion[2 * self.n..], ..StateAt::from_motion(t, self.n, &self.state) }
    }

    /// Accelerations at a pose and its rates.
    pub fn accelerate(&mut self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        self.evaluations += 1;
        self.loops.open(self.crane, &StateAt { t, q, v, x: &[] }, out);
        self.loops.close(out);
        finite(out)
    }

    /// Slope of a motion given relative to the references: rates, accelerations, and rates of the states of forces. At the end of the step
    /// it is that of the step, whatever changes there.
    pub fn slope(&mut self, t: f64, motion: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        let (t, n) = (self.references.inside(t), self.n);
        out[..n].copy_from_slice(&motion[n..2 * n]);
        self.state(t, motion);
        self.evaluate(t, motion, out)?;
        self.references.subtract_accelerations(self.crane, t, &mut out[n..2 * n]);
        finite(&out[n..2 * n])
    }

    /// What a rate of change lacks to be the slope of a motion given relative to the references: forces `e + f − A q̈` instead of accelerations, which
    /// take half as long. Of a crane without loops.
    pub fn shortfall(
        &mut self,
        crane: &dyn Functions,
        t: f64,
        motion: &[f64],
        rate: &[f64],
        out: &mut [f64],
    ) -> Result<(), NotFinite> {
        let (t, n) = (self.references.inside(t), self.n);
        self.evaluations += 1;
        self.state(t, motion);
        let (q, v) = self.state.split_at(n);
        let (of_q, rest) = out.split_at_mut(n);
        let (forces, of_x) = rest.split_at_mut(n);
        self.accelerations.copy_from_slice(&rate[n..2 * n]);
        self.references.add_accelerations(crane, t, &mut self.accelerations);
        crane.dynamic_residual(t, q, v, &self.accelerations, forces);
        for force in &mut *forces {
            *force = -*force;
        }
        if !self.force_states.is_empty() {
            self.force_states.push(crane, &StateAt { t, q, v, x: &motion[2 * n..] }, of_x, forces);
            finite(of_x)?;
        }
        of_q.iter_mut().zip(motion[n..2 * n].iter().zip(rate)).for_each(|(out, (v, rate))| *out = v - rate);
        of_x.iter_mut().zip(&rate[2 * n..]).for_each(|(out, rate)| *out -= rate);
        finite(forces)
    }

    /// Slope of a motion given in full.
    pub fn slope_in_full(&mut self, t: f64, motion: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        let n = self.n;
        out[..n].copy_from_slice(&motion[n..2 * n]);
        self.state.copy_from_slice(&motion[..2 * n]);
        self.evaluate(t, motion, out)?;
        finite(&out[n..2 * n])
    }

    /// Accelerations of the pose and the rates in `self.state`, and rates of the states of forces in `motion`.
    fn evaluate(&mut self, t: f64, motion: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        let n = self.n;
        self.evaluations += 1;
        let state = StateAt { x: &motion[2 * n..], ..StateAt::from_motion(t, n, &self.state) };
        let (_, rest) = out.split_at_mut(n);
        let (accelerations, rest) = rest.split_at_mut(n);
        self.loops.open(self.crane, &state, accelerations);
        if !self.force_states.is_empty() {
            self.force_states.accelerate(self.crane, &state, rest, accelerations);
            finite(rest)?;
        }
        self.loops.close(accelerations);
        Ok(())
    }

    /// Moves a motion, given in full, onto the loops of the crane.
    pub fn project(&mut self, motion: &mut [f64]) -> Result<(), Open> {
        let (q, rest) = motion.split_at_mut(self.n);
        self.loops.project(self.crane, q, &mut rest[..self.n])
    }

    /// Moves the end of a step, given relative to the references, onto the loops of the crane. `moved` receives the change, if there is any.
    pub fn project_end(&mut self, t: f64, end: &mut [f64], moved: &mut [f64]) -> Result<bool, Open> {
        if self.loops.is_empty() {
            return Ok(false);
        }
        moved.copy_from_slice(end);
        self.make_absolute(t, moved);
        self.state.copy_from_slice(&moved[..2 * self.n]);
        self.project(moved)?;
        for (moved, before) in moved.iter_mut().zip(&self.state) {
            *moved -= before;
        }
        moved[2 * self.n..].fill(0.0);
        end.iter_mut().zip(&*moved).for_each(|(end, moved)| *end += *moved);
        Ok(true)
    }
}
