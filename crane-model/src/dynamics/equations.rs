//! The equations of motion as one of first order, with what is integrated along.

use super::state::{NotFinite, finite};
use crate::dyn_crane::DynDynamics;

/// Integrals along an audited motion: work of the drives, energy that the dampers took out.
const INTEGRALS: usize = 2;

/// A crane and how often it was asked for its accelerations.
pub(super) struct Equations<'a> {
    pub crane: &'a dyn DynDynamics,
    /// Number of coordinates.
    pub n: usize,
    audit: bool,
    /// Evaluations of the accelerations so far.
    pub evaluations: usize,
}

impl<'a> Equations<'a> {
    /// Of a crane, with or without integrals.
    pub fn new(crane: &'a dyn DynDynamics, audit: bool) -> Self {
        Self { crane, n: crane.size(), audit, evaluations: 0 }
    }

    /// Numbers of a motion: coordinates, rates and integrals.
    pub fn len(&self) -> usize {
        2 * self.n + if self.audit { INTEGRALS } else { 0 }
    }

    /// Coordinates and rates of a motion.
    pub fn state<'m>(&self, motion: &'m [f64]) -> (&'m [f64], &'m [f64]) {
        motion[..2 * self.n].split_at(self.n)
    }

    /// Accelerations at a pose and its rates.
    pub fn accelerate(&mut self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        self.evaluations += 1;
        self.crane.forward_dynamics(t, q, v, out);
        finite(out)
    }

    /// Powers at a pose and its rates: of the drives, and of the dampers.
    pub fn powers_at(&self, t: f64, q: &[f64], v: &[f64]) -> [f64; INTEGRALS] {
        [self.crane.drive_power(t, q, v), self.crane.dissipation(t, q, v)]
    }

    /// Slope of a motion: rates, accelerations and powers.
    pub fn slope(&mut self, t: f64, motion: &[f64], out: &mut [f64]) -> Result<(), NotFinite> {
        let n = self.n;
        let (q, v) = self.state(motion);
        out[..n].copy_from_slice(v);
        self.accelerate(t, q, v, &mut out[n..2 * n])?;
        self.powers(t, motion, out);
        Ok(())
    }

    /// Powers of a motion into the last numbers of a slope, where it has them.
    pub fn powers(&self, t: f64, motion: &[f64], slope: &mut [f64]) {
        let (q, v) = self.state(motion);
        if self.audit {
            slope[2 * self.n..].copy_from_slice(&self.powers_at(t, q, v));
        }
    }
}
