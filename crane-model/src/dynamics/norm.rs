//! The size of an error of a motion, in units of the tolerance.

use super::{equations::Equations, references::References};
use crate::memory::Visit;
use crate::{
    CoordinateKind, StateAt,
    dyn_crane::{Functions, drive_stiffness},
    force_states::ForceStates,
    rt::lanes::f64x8,
    statics::open_guess,
};

/// Weight of an error of a rate relative to one of its coordinate, s: 1/ω of the slow swinging of a load, about 5 rad/s.
const RATE: f64 = 0.2;
/// Error of a drive's effort, in units of its scale, that counts as much as an error of 1 m or rad.
const EFFORT: f64 = 20.0;
/// Error of a state of a force, in units of its scale such as the pump's pressure, that counts as much as an error of 1 m or rad.
const OIL: f64 = 5.0;
/// Smallest scale of an effort, as a fraction of the largest force or moment of the crane's weight on a coordinate.
const LEAST: f64 = 0.01;
/// Stiffness divided by the scale of an effort, if nothing else is known about the scale, 1/m or 1/rad.
const UNKNOWN: f64 = 2e3;
/// Number of rounding errors of a coordinate and of the sums that contain it.
const ROUNDINGS: f64 = 4.0;
/// Maximum amplification of rounding by successive stages: their coefficients are up to 40.
const MAGNIFIED: f64 = 1e3;

/// The measure of errors: of coordinates, rates, states of forces and the efforts of drives.
pub(super) struct Norm {
    n: usize,
    /// Allowed error of a step, m and rad.
    tolerance: f64,
    efforts: Vec<Effort>,
    /// Motions of all drives.
    motions: Vec<[f64; 2]>,
    /// Scales of the states of forces.
    states: Vec<f64>,
}

/// The effort of a drive, `−s u − d u̇` with the deviation u from its motion.
#[derive(Clone, Copy, Debug)]
struct Effort {
    coordinate: usize,
    /// Its drive, if the integrated motion is not relative to that of the drive.
    drive: Option<usize>,
    /// s and d.
    stiffness: f64,
    damping: f64,
    /// The scale of errors.
    scale: f64,
    /// Largest effort so far.
    peak: f64,
    /// Largest error of a step so far, and the error due to rounding.
    error: f64,
    rounding: f64,
}

/// The effort of a drive over a run, and its estimated error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffortAccuracy {
    /// Its coordinate.
    pub coordinate: usize,
    /// Largest effort at the end of a step, N or N m.
    pub peak: f64,
    /// Estimated error, N or N m.
    pub error: f64,
}

impl Norm {
    /// For coordinates and rates only.
    pub fn new(n: usize, tolerance: f64) -> Self {
        Self { n, tolerance, efforts: Vec::new(), motions: Vec::new(), states: Vec::new() }
    }

    /// For coordinates, rates and states of forces.
    pub fn with_states(crane: &dyn Functions, tolerance: f64) -> Self {
        let states = ForceStates::new(crane.description()).scales();
        Self { states, ..Self::new(crane.description().coordinates.len(), tolerance) }
    }

    /// Also for the drives' efforts, for a motion relative to the drives' motions.
    pub fn with_efforts(crane: &dyn Functions, references: &References, tolerance: f64) -> Self {
        let n = crane.size();
        let mut stiffness_and_damping = vec![[0.0; 2]; n];
        crane.joint_stiffness_and_damping(&mut stiffness_and_damping);
        // At the guess, drives with an effort limit are far from it.
        let stiffness = drive_stiffness(crane, &open_guess(crane));
        let effort = |(drive, (coordinate, stiffness)): (usize, (usize, f64))| {
            let [_, damping] = stiffness_and_damping[coordinate];
            let drive = (!references.coordinates().any(|relative| relative == coordinate)).then_some(drive);
            Effort { coordinate, drive, stiffness, damping, scale: 0.0, peak: 0.0, error: 0.0, rounding: 0.0 }
        };
        let coordinates = crane.description().drives.iter().map(|drive| drive.coordinate);
        let drives = coordinates.zip(stiffness).enumerate().map(effort);
        let drives = drives.filter(|effort| effort.stiffness > 0.0);
        let motions = vec![[0.0; 2]; crane.description().drives.len()];
        Self { efforts: drives.collect(), motions, ..Self::with_states(crane, tolerance) }
    }

    /// Starts at a pose: the crane's weight there gives the scale of the efforts.
    pub fn start(&mut self, equations: &mut Equations<'_>, t: f64, motion: &[f64]) {
        if self.efforts.is_empty() {
            return;
        }
        let (crane, n) = (equations.crane, self.n);
        let mut weight = vec![0.0; n];
        let StateAt { q, v, .. } = equations.state(t, motion);
        crane.bias(q, &vec![0.0; n], &mut weight);
        let (q, v) = (q.to_vec(), v.to_vec());
        let (coordinates, cranes) = (&crane.description().coordinates, crane.cranes());
        // Of the same crane of a fleet.
        let greatest = |kind: CoordinateKind, of_crane: usize| {
            let own = coordinates.iter().zip(&weight).skip(of_crane).step_by(cranes);
            let alike = own.filter(|(coordinate, _)| coordinate.kind == kind);
            alike.map(|(_, force)| force.abs()).fold(0.0, f64::max)
        };
        for effort in &mut self.efforts {
            let least = LEAST * greatest(coordinates[effort.coordinate].kind, effort.coordinate % cranes);
            effort.scale = if least > 0.0 { least } else { effort.stiffness / UNKNOWN };
        }
        self.note(motion, &vec![0.0; motion.len()]);
        self.note_state(crane, t, &q, &v);
    }

    /// Size of an error of a motion: the largest of `|δq|` in m and rad, `|δv|/(1 + |v|)` times [`RATE`], and of states of forces
    /// and efforts divided by [`OIL`] and [`EFFORT`] times their scales; all relative to the tolerance. Infinite if one is not finite.
    pub fn size(&self, motion: &[f64], error: &[f64]) -> f64 {
        let n = self.n;
        let mut greatest = Greatest::none();
        let (of_q, of_v, of_x) = (&error[..n], &error[n..2 * n], &error[2 * n..]);
        let rates = &motion[n..2 * n];
        greatest.note_all(of_q, rates, |error, _| error.abs());
        greatest.note_all(of_v, rates, |error, rate| error.abs() * RATE / (rate.abs() + 1.0));
        greatest.note_each(of_x.iter().zip(&self.states), |(error, scale)| error.abs() / (OIL * scale));
        greatest.note_each(self.efforts.iter(), |effort| effort.effort(n, error, f64::abs) / (EFFORT * effort.scale));
        greatest.value() / self.tolerance
    }

    /// Size of a change of a motion, as that of an error, but 1 for a change of 1 m or rad.
    pub fn size_of_change(&self, motion: &[f64], change: &[f64]) -> f64 {
        self.size(motion, change) * self.tolerance
    }

    /// Records the efforts after a completed step, and their errors.
    pub fn note(&mut self, motion: &[f64], error: &[f64]) {
        let n = self.n;
        for effort in &mut self.efforts {
            if effort.drive.is_none() {
                effort.peak = effort.peak.max(effort.effort(n, motion, |x| x).abs());
            }
            effort.error = effort.error.max(effort.effort(n, error, f64::abs));
            effort.scale = effort.scale.max(effort.peak);
        }
    }

    /// Records what follows from a pose and its rates at time t: the efforts where the motion is not relative to that of their drives, and the error of all
    /// due to rounding, which shorter steps cannot reduce.
    pub fn note_state(&mut self, crane: &dyn Functions, t: f64, q: &[f64], v: &[f64]) {
        if self.efforts.iter().any(|effort| effort.drive.is_some()) {
            crane.drive_motions(t, &mut self.motions);
        }
        for effort in &mut self.efforts {
            let Effort { coordinate, drive, stiffness, damping, .. } = *effort;
            if let Some([position, rate]) = drive.map(|drive| self.motions[drive]) {
                let value = stiffness * (q[coordinate] - position) + damping * (v[coordinate] - rate);
                effort.peak = effort.peak.max(value.abs());
                effort.scale = effort.scale.max(effort.peak);
            }
            let rounding = ROUNDINGS * f64::EPSILON * (stiffness * q[coordinate].abs() + damping * v[coordinate].abs());
            effort.rounding = effort.rounding.max(rounding);
            effort.scale = effort.scale.max(MAGNIFIED * rounding / (EFFORT * self.tolerance));
        }
    }

    /// Visits what further steps depend on.
    pub fn visit(&mut self, visit: Visit<'_>) {
        for Effort { scale, peak, error, rounding, .. } in &mut self.efforts {
            [scale, peak, error, rounding].into_iter().for_each(&mut *visit);
        }
    }

    /// The efforts so far.
    pub fn efforts(&self) -> impl Iterator<Item = EffortAccuracy> {
        self.efforts.iter().map(|effort| EffortAccuracy {
            coordinate: effort.coordinate,
            peak: effort.peak,
            error: effort.error + effort.rounding,
        })
    }
}

impl Effort {
    /// `s x + d ẋ` of a motion, with `part` applied to x and ẋ.
    #[inline]
    fn effort(&self, n: usize, motion: &[f64], part: fn(f64) -> f64) -> f64 {
        self.stiffness * part(motion[self.coordinate]) + self.damping * part(motion[n + self.coordinate])
    }
}

/// The largest of some sizes.
#[derive(Clone, Copy, Debug)]
struct Greatest {
    sizes: f64x8,
    /// NaN if a size was not finite.
    spoilt: f64x8,
}

impl Greatest {
    fn none() -> Self {
        Self { sizes: f64x8::splat(0.0), spoilt: f64x8::splat(0.0) }
    }

    /// Compares with the sizes of errors, which may depend on numbers beside them, eight at a time.
    #[inline]
    fn note_all(&mut self, errors: &[f64], beside: &[f64], size: impl Fn(f64x8, f64x8) -> f64x8) {
        let ([eights, rest], [beside_eights, beside_rest]) = (parts(errors), parts(beside));
        for (error, beside) in eights.as_chunks().0.iter().zip(beside_eights.as_chunks().0) {
            self.note_eight(size(f64x8::new(*error), f64x8::new(*beside)));
        }
        let (mut error, mut number) = ([0.0; 8], [0.0; 8]);
        error[..rest.len()].copy_from_slice(rest);
        number[..beside_rest.len()].copy_from_slice(beside_rest);
        self.note_eight(size(f64x8::new(error), f64x8::new(number)));
    }

    #[inline]
    fn note_eight(&mut self, sizes: f64x8) {
        self.sizes = self.sizes.fast_max(sizes);
        self.spoilt += sizes * f64x8::splat(0.0);
    }

    /// Compares with the sizes of some things, one by one.
    #[inline]
    fn note_each<T>(&mut self, mut all: impl ExactSizeIterator<Item = T>, size: impl Fn(T) -> f64) {
        while all.len() > 0 {
            let mut eight = [0.0; 8];
            eight.iter_mut().zip(all.by_ref()).for_each(|(place, next)| *place = size(next));
            self.note_eight(f64x8::new(eight));
        }
    }

    fn value(&self) -> f64 {
        if self.spoilt.to_array().into_iter().any(f64::is_nan) {
            return f64::INFINITY;
        }
        self.sizes.to_array().into_iter().fold(0.0, f64::max)
    }
}

/// Whole eights, and the rest.
fn parts(numbers: &[f64]) -> [&[f64]; 2] {
    numbers.split_at(numbers.len() - numbers.len() % 8).into()
}
