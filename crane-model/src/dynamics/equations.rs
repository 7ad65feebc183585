//! The equations of motion in first-order form, with integrals along the motion.

use super::{
    references::References,
    state::{NotFinite, finite},
};
use crate::{
    dyn_crane::DynDynamics,
    force_states::{ForceStates, StateAt},
};

/// Integrals along an audited motion: work of the drives and winches, energy that the dampers dissipated, work of the loads.
pub(super) const INTEGRALS: usize = 3;

/// A crane, the references of its motions, and the number of evaluations of its accelerations.
pub(super) struct Equations<'a> {
    pub crane: &'a dyn DynDynamics,
    /// Number of coordinates.
    pub n: usize,
    audit: bool,
    /// The references of the integrated numbers.
    pub references: References,
    /// Evaluations of the accelerations so far.
    pub evaluations: usize,
    /// Pose and rates of the last evaluated motion.
    state: Vec<f64>,
    force_states: ForceStates,
    /// Rates of their states, for the powers.
    rates: Vec<f64>,
}

impl<'a> Equations<'a> {
    /// The equations of a crane, with or without integrals.
    pub fn new(crane: &'a dyn DynDynamics, references: References, audit: bool) -> Self {
        let n = crane.size();
        let force_states = ForceStates::new(crane.description());
        let rates = vec![0.0; force_states.len()];
        Self { crane, n, audit, references, evaluations: 0, state: vec![0.0; 2 * n], force_states, rates }
    }

    /// The number of components of a motion: coordinates, rates, states of forces and integrals.
    pub fn len(&self) -> usize {
        self.integrals() + if self.audit { INTEGRALS } else { 0 }
    }

    /// Number of states of forces.
    pub fn states(&self) -> usize {
        self.rates.len()
    }

    /// Where the integrals of a motion begin.
    pub fn integrals(&self) -> usize {
        2 * self.n + self.states()
    }

    /// The states of forces in a motion.
    pub fn force_states<'m>(&self, motion: &'m [f64]) -> &'m [f64] {
        &motion[2 * self.n..self.integrals()]
    }

    /// Converts a motion to deviations from the references.
    pub fn make_relative(&mut self, t: f64, motion: &mut [f64]) {
        self.references.make_relative(self.crane, t, self.n, motion);
    }

    /// The motion from its deviations from the references.
    pub fn make_absolute(&mut self, t: f64, motion: &mut [f64]) {
        self.references.add(self.crane, t, 1.0, self.n, motion);
    }

    /// Pose and rates of a motion given relative to the references.
    pub fn state(&mut self, t: f64, motion: &[f64]) -> (&[f64], &[f64]) {
        self.state.copy_from_slice(&motion[..2 * self.n]);
        self.references.add(self.crane, t, 1.0, self.n, &mut self.state);
        self.state.split_at(self.n)
    }

    /// Accelerations at a pose and its rates.
    pub fn accelerate(&mut self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        self.evaluations += 1;
        self.crane.forward_dynamics(t, q, v, out);
        finite(out)
    }

    /// Powers at a pose and its rates: of the drives and winches, of the dampers, and of the loads.
    pub fn powers_at(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; INTEGRALS] {
        let work = self.crane.drive_power(t, q, v) + self.crane.winch_power(t, q, v);
        [work, self.crane.dissipation(t, q, v), self.crane.load_power(t, q, v)]
    }

    /// Slope of a motion given relative to the references: rates, accelerations and powers.
    pub fn slope(&mut self, t: f64, motion: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        self.derivative(t, motion, out)?;
        self.powers(t, motion, out);
        Ok(())
    }

    /// Rates and accelerations of a motion given relative to the references.
    pub fn derivative(&mut self, t: f64, motion: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        let n = self.n;
        out[..n].copy_from_slice(&motion[n..2 * n]);
        self.state(t, motion);
        self.evaluations += 1;
        let (q, v) = self.state.split_at(n);
        let (_, rest) = out.split_at_mut(n);
        let (accelerations, rest) = rest.split_at_mut(n);
        self.crane.forward_dynamics(t, q, v, accelerations);
        if !self.force_states.is_empty() {
            let rates = &mut rest[..self.rates.len()];
            let x = &motion[2 * n..2 * n + rates.len()];
            self.force_states.accelerate(self.crane, &StateAt { t, q, v, x }, rates, accelerations);
            finite(rates)?;
        }
        self.references.subtract_accelerations(self.crane, t, accelerations);
        finite(accelerations)
    }

    /// Writes the powers of a motion given relative to the references into the last components of a slope, if it has them.
    pub fn powers(&mut self, t: f64, motion: &[f64], slope: &mut [f64]) {
        if self.audit {
            self.state(t, motion);
            let (q, v) = self.state.split_at(self.n);
            let mut powers = self.powers_at(t, q, v);
            let begin = self.integrals();
            if !self.force_states.is_empty() {
                let moment = StateAt { t, q, v, x: &motion[2 * self.n..begin] };
                self.force_states.evaluate(self.crane, &moment, &mut self.rates, None);
                let [put_in, taken_out] = self.force_states.powers();
                powers[0] += put_in;
                powers[1] += taken_out;
                powers[0] +=
                    self.force_states.on_rigid_drives(self.crane, q).map(|(j, effort)| effort * v[j]).sum::<f64>();
            }
            slope[begin..].copy_from_slice(&powers);
        }
    }
}
