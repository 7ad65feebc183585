//! Motions of the drives, relative to which driven coordinates are integrated.
//!
//! A stiff drive follows its prescribed motion `p(t)` closely, `q = p + u`, and its effort `−s u − d u̇` depends on the deviation.
//! Any error of q, however small, is multiplied by the stiffness; so implicit methods integrate u, and `q = p + u` holds at every
//! stage and wherever a result is interpolated. Then a stiff drive is not forced at all: u is driven by the accelerations `−p̈`,
//! which do not depend on the stiffness. The deviation of a rigid drive is zero, with every method.

use super::rk4::just_within;
use crate::{CoordinateRole, Description, dyn_crane::Functions};

/// Distance from either end of a step at which derivatives of functions of time are evaluated there, relative to its length.
pub(super) const INSIDE: f64 = 1e-7;

/// Coordinates that are relative to the motions of their drives.
pub(super) struct References {
    driven: Vec<Reference>,
    /// `p`, `ṗ` of all drives at the last evaluated time, which is NaN if they are not known, and at two times near it.
    motions: Vec<[f64; 2]>,
    at: f64,
    near: [Vec<[f64; 2]>; 2],
    /// `p̈` of the driven coordinates at the last time at which they were asked for within a step: the time and the step, s.
    accelerations: Vec<f64>,
    accelerated_at: [f64; 3],
    /// The current step, s.
    within: [f64; 2],
}

/// A coordinate that is relative to a motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reference {
    pub coordinate: usize,
    /// Index of its drive.
    pub drive: usize,
    /// Whether the drive is rigid.
    pub rigid: bool,
}

impl References {
    /// Fraction of a step over which rates are differenced: the error is of second order in it.
    const DIFFERENCE: f64 = 1e-3;
    /// Shortest time between differenced rates, s: rounding of a rate then causes an error of 1e-8 m/s² or rad/s².
    const LEAST: f64 = 1e-8;

    /// All driven coordinates, unless the rate of a motion jumps: a flexibly driven coordinate does not follow a jump.
    pub fn new(crane: &dyn Functions) -> Self {
        let jumps = jumps(crane);
        Self::where_drives(crane, |drive, rigid| rigid || !jumps[drive])
    }

    /// No coordinate.
    pub fn none(crane: &dyn Functions) -> Self {
        Self::where_drives(crane, |_, _| false)
    }

    /// Only the coordinates of rigid drives.
    pub fn rigid(crane: &dyn Functions) -> Self {
        Self::where_drives(crane, |_, rigid| rigid)
    }

    fn where_drives(crane: &dyn Functions, has_reference: impl Fn(usize, bool) -> bool) -> Self {
        let Description { drives, coordinates, cylinders, .. } = crane.description();
        let driven = drives.iter().enumerate().map(|(drive, info)| {
            let rigid = coordinates[info.coordinate].role == CoordinateRole::Prescribed;
            Reference { coordinate: info.coordinate, drive, rigid }
        });
        // A joint that is moved by oil does not follow its drive's motion closely.
        let by_oil =
            |drive: usize| cylinders.iter().any(|cylinder| cylinder.drive == drive && cylinder.valve.is_some());
        let driven: Vec<_> = driven
            .filter(|reference| has_reference(reference.drive, reference.rigid) && !by_oil(reference.drive))
            .collect();
        let motions = vec![[0.0; 2]; drives.len()];
        Self {
            accelerations: vec![0.0; driven.len()],
            accelerated_at: [f64::NAN; 3],
            driven,
            near: [motions.clone(), motions.clone()],
            motions,
            at: f64::NAN,
            within: [0.0; 2],
        }
    }

    /// The coordinates that are relative to a motion.
    pub fn coordinates(&self) -> impl Iterator<Item = usize> {
        self.driven.iter().map(|reference| reference.coordinate)
    }

    /// The references.
    pub fn all(&self) -> &[Reference] {
        &self.driven
    }

    /// Sets the step from `begin` to `end`, s.
    pub fn step_within(&mut self, begin: f64, end: f64) {
        self.within = [begin, end];
    }

    /// A time within the step, slightly away from its ends, where functions of time may have another branch.
    pub fn strictly_inside(&self, t: f64) -> f64 {
        let [begin, end] = self.within;
        let inside = INSIDE * (end - begin);
        if end > begin { t.clamp(begin + inside, end - inside) } else { t }
    }

    /// The time at which functions of time count at `t`: within the step, because what changes at its end belongs to the next one.
    pub fn inside(&self, t: f64) -> f64 {
        just_within(t, self.within)
    }

    /// Motions change: those of the last time are not known any more.
    pub fn forget(&mut self) {
        self.at = f64::NAN;
        self.accelerated_at = [f64::NAN; 3];
    }

    /// The motions at a time; a step asks for those at its end several times.
    fn evaluate(&mut self, crane: &dyn Functions, t: f64) {
        if self.at.to_bits() != t.to_bits() {
            crane.drive_motions(t, &mut self.motions);
            self.at = t;
        }
    }

    /// Makes a motion of `n` coordinates relative to the drives' motions.
    pub fn make_relative(&mut self, crane: &dyn Functions, t: f64, n: usize, motion: &mut [f64]) {
        self.add(crane, t, -1.0, n, motion);
        for reference in self.driven.iter().filter(|reference| reference.rigid) {
            motion[reference.coordinate] = 0.0;
            motion[n + reference.coordinate] = 0.0;
        }
    }

    /// Adds `sign (p, ṗ)` to a motion of `n` coordinates.
    pub fn add(&mut self, crane: &dyn Functions, t: f64, sign: f64, n: usize, motion: &mut [f64]) {
        if self.driven.is_empty() {
            return;
        }
        self.evaluate(crane, t);
        for reference in &self.driven {
            let [position, rate] = self.motions[reference.drive];
            motion[reference.coordinate] += sign * position;
            motion[n + reference.coordinate] += sign * rate;
        }
    }

    /// Subtracts `p̈` from accelerations.
    pub fn subtract_accelerations(&mut self, crane: &dyn Functions, t: f64, accelerations: &mut [f64]) {
        self.evaluate_accelerations(crane, t);
        for (reference, of_motion) in self.driven.iter().zip(&self.accelerations) {
            let acceleration = &mut accelerations[reference.coordinate];
            *acceleration = if reference.rigid { 0.0 } else { *acceleration - of_motion };
        }
    }

    /// Adds `p̈` to accelerations.
    pub fn add_accelerations(&mut self, crane: &dyn Functions, t: f64, accelerations: &mut [f64]) {
        self.evaluate_accelerations(crane, t);
        for (reference, of_motion) in self.driven.iter().zip(&self.accelerations) {
            accelerations[reference.coordinate] += of_motion;
        }
    }

    /// `p̈` at a time. Rates are differenced within the step, because a motion may be less smooth at its ends.
    fn evaluate_accelerations(&mut self, crane: &dyn Functions, t: f64) {
        let [begin, end] = self.within;
        let at = [t, begin, end];
        if self.driven.is_empty() || self.accelerated_at.map(f64::to_bits) == at.map(f64::to_bits) {
            return;
        }
        self.accelerated_at = at;
        let (shifts, weights, by) = self.differences(t);
        self.evaluate(crane, t);
        for (shift, near) in shifts.iter().zip(&mut self.near) {
            crane.drive_motions(t + shift, near);
        }
        for (reference, acceleration) in self.driven.iter().zip(&mut self.accelerations) {
            let rates = [&self.motions, &self.near[0], &self.near[1]].map(|motions| motions[reference.drive][1]);
            *acceleration = rates.iter().zip(weights).map(|(rate, weight)| rate * weight).sum::<f64>() / by;
        }
    }

    /// How rates are differenced at a time: with those at two further times, whose distances are in s; the weights of the three; and the
    /// time by which their sum is divided, s.
    pub fn differences(&self, t: f64) -> ([f64; 2], [f64; 3], f64) {
        let [begin, end] = self.within;
        let by = ((end - begin) * Self::DIFFERENCE).max(Self::LEAST);
        // In the middle of the step the weight of the rate at the time itself is zero.
        let (shifts, weights) = if t - by < begin {
            ([by, 2.0 * by], [-3.0, 4.0, -1.0])
        } else if t + by > end {
            ([-by, -2.0 * by], [3.0, -4.0, 1.0])
        } else {
            ([by, -by], [0.0, 1.0, -1.0])
        };
        (shifts, weights, 2.0 * by)
    }
}

/// Whether the rate of each drive's motion jumps where one of its intervals begins or ends.
fn jumps(crane: &dyn Functions) -> Vec<bool> {
    /// Distance in time from a jump, s: no smooth motion of a crane changes its rate in such a short time.
    const BESIDE: f64 = 1e-7;
    /// A change of rate is a jump if it exceeds the change next to it by this factor.
    const STEEP: f64 = 10.0;
    /// Rates below this, m/s and rad/s, are rounding.
    const REST: f64 = 1e-12;
    let drives = &crane.description().drives;
    let mut pieces = vec![[f64::NAN; 2]; drives.iter().map(|drive| drive.pieces).sum()];
    crane.drive_pieces(&mut pieces);
    let mut rest = pieces.as_slice();
    let own = drives.iter().map(|drive| {
        let (own, others) = rest.split_at(drive.pieces);
        rest = others;
        own.as_flattened()
    });
    let mut motions = vec![[0.0; 2]; drives.len()];
    let mut rate = |drive: usize, t: f64| {
        crane.drive_motions(t, &mut motions);
        motions[drive][1]
    };
    let mut jumps_at = |drive: usize, t: f64| {
        let [far_before, before, after, far_after] = [-2.0, -1.0, 1.0, 2.0].map(|k| rate(drive, t + k * BESIDE));
        let beside = (far_after - after).abs() + (before - far_before).abs();
        (after - before).abs() > STEEP * beside + REST
    };
    own.enumerate().map(|(drive, times)| times.iter().any(|&t| jumps_at(drive, t))).collect()
}
