//! The rates of a motion, and their derivatives along directions.

use nalgebra::{DMatrix, Matrix6};

use super::{At, Slopes, difference, size_of};
use crate::{
    dyn_crane::{DynCrane, DynDynamics, DynImplicit, DynSystem},
    dynamics::{NotFinite, state::finite},
    force_states::ForceStates,
    loop_joints::Loops,
    stateful_force::StateAt,
};

/// F of a crane: of a motion `[q, v, x]` in full, not relative to the motions of drives.
pub(super) struct Rates<'a> {
    crane: &'a dyn DynCrane,
    n: usize,
    system: Box<dyn DynSystem + 'a>,
    force_states: ForceStates,
    /// The same, at states beside the motion.
    differenced: ForceStates,
    /// Derivatives of the rates of x by x.
    by_states: DMatrix<f64>,
    scales: Vec<f64>,
    loops: Loops,
    prescribed: Vec<usize>,
    /// Index of the drive of each prescribed coordinate.
    drives: Vec<usize>,
    zeros: Vec<f64>,
    /// a, and the rates of x.
    accelerations: Vec<f64>,
    of_states: Vec<f64>,
    residuals: Vec<Vec<f64>>,
    of_loops: Vec<Vec<[f64; 3]>>,
}

impl<'a> Rates<'a> {
    /// Of a crane, with as many directions.
    pub fn new(crane: &'a dyn DynCrane, directions: usize) -> Self {
        let (n, description) = (crane.size(), crane.description());
        let force_states = ForceStates::new(description);
        let prescribed = description.prescribed();
        let drive = |coordinate: &usize| description.drives.iter().position(|drive| drive.coordinate == *coordinate);
        let loops = Loops::new(crane);
        let equations = crane.loop_joints().iter().map(|joint| joint.equations.len()).sum();
        Self {
            crane,
            n,
            system: (crane as &dyn DynImplicit).system(),
            scales: force_states.scales(),
            of_states: vec![0.0; force_states.len()],
            differenced: ForceStates::new(description),
            by_states: DMatrix::zeros(force_states.len(), force_states.len()),
            force_states,
            loops,
            drives: prescribed.iter().filter_map(drive).collect(),
            prescribed,
            zeros: vec![0.0; n],
            accelerations: vec![0.0; n],
            residuals: vec![vec![0.0; n]; directions],
            of_loops: vec![vec![[0.0; 3]; equations]; directions],
        }
    }

    /// F at a time.
    pub fn at(&mut self, t: f64, motion: &[f64]) -> Result<Vec<f64>, NotFinite> {
        let n = self.n;
        let ([q, v], x) = (halves(&motion[..2 * n]), &motion[2 * n..]);
        self.crane.forward_dynamics(t, q, v, &mut self.accelerations);
        if !self.force_states.is_empty() {
            let moment = StateAt { t, q, v, x };
            self.force_states.accelerate(self.crane, &moment, &mut self.of_states, &mut self.accelerations);
        }
        self.loops.accelerate(self.crane, q, v, &mut self.accelerations);
        finite(&self.accelerations)?;
        Ok([v, &self.accelerations, &self.of_states].concat())
    }

    /// The derivative of F along each direction, in which the motion changes by `along` and the accelerations of drives by `of_drives`.
    pub fn differentiate(
        &mut self,
        slopes: &mut dyn Slopes,
        (t, motion): (f64, &[f64]),
        along: &[Vec<f64>],
        of_drives: &[Vec<f64>],
        out: &mut [Vec<f64>],
    ) -> Result<(), NotFinite> {
        let n = self.n;
        self.at(t, motion)?;
        let [q, v] = halves(&motion[..2 * n]);
        let at = At { t, q, v, a: &self.accelerations, multipliers: self.loops.multipliers() };
        slopes.residuals(&at, along, &mut self.residuals);
        if !self.loops.is_empty() {
            slopes.loops(&at, along, &mut self.of_loops);
        }
        self.system.factorise(q, &self.zeros, &Matrix6::zeros());
        let mass = (!self.prescribed.is_empty()).then(|| {
            let mut mass = DMatrix::zeros(n, n);
            self.crane.mass_matrix(q, mass.as_mut_slice());
            mass
        });
        let mut by_states = std::mem::replace(&mut self.by_states, DMatrix::zeros(0, 0));
        if !self.force_states.is_empty() {
            let moment = StateAt { t, q, v, x: &motion[2 * n..] };
            self.force_states.evaluate(self.crane, &moment, &mut self.of_states, Some(&mut by_states));
        }
        for (direction, out) in out.iter_mut().enumerate() {
            let along = &along[direction];
            out[..n].copy_from_slice(&along[n..2 * n]);
            let right = &mut self.residuals[direction];
            for entry in right.iter_mut() {
                *entry = -*entry;
            }
            if !self.force_states.is_empty() {
                let found = self.of_forces(&*slopes, direction, (t, motion), (along, &by_states));
                self.residuals[direction].iter_mut().zip(&found).for_each(|(right, force)| *right += force);
                out[2 * n..].copy_from_slice(&found[n..]);
            }
            let right = &mut self.residuals[direction];
            let prescribed =
                || self.prescribed.iter().zip(self.drives.iter().map(|drive| of_drives[direction][*drive]));
            if let Some(mass) = &mass {
                for (j, a) in prescribed() {
                    right.iter_mut().enumerate().for_each(|(i, right)| *right -= mass[(i, *j)] * a);
                }
                self.prescribed.iter().for_each(|j| right[*j] = 0.0);
            }
            let accelerations = &mut out[n..2 * n];
            self.system.solve(right, accelerations);
            prescribed().for_each(|(j, a)| accelerations[*j] = a);
            if !self.loops.is_empty() {
                let gammas = &self.of_loops[direction];
                self.loops.correct_by(accelerations, |row| gammas[row][2]);
            }
            finite(out)?;
        }
        self.by_states = by_states;
        Ok(())
    }

    /// Derivatives of the generalized forces Q with states of their own, and of the rates of these states, along a direction. `by_states`: of the
    /// rates by the states, at the motion.
    fn of_forces(
        &mut self,
        slopes: &dyn Slopes,
        direction: usize,
        (t, motion): (f64, &[f64]),
        (along, by_states): (&[f64], &DMatrix<f64>),
    ) -> Vec<f64> {
        let Self { n, force_states, scales, crane, differenced: others, .. } = self;
        let (n, [forces, states]) = (*n, force_states.coupled());
        let mut found = vec![0.0; motion.len() - n];
        // Local forces: each has one state and acts on one coordinate.
        for (force, row) in force_states.forces().iter().zip(force_states.rows()).skip(forces) {
            let (speed, state) = (row.along(&along[n..2 * n]), along[2 * n + force.first]);
            row.add_to(&mut found[..n], force.by_speed * speed + force.by_states[0] * state);
            found[n + force.first] = force.rates_by_speed[0] * speed + by_states[(force.first, force.first)] * state;
        }
        if forces > 0 {
            let size = size_of(along, n, scales);
            let coupled = difference(*crane, slopes.around(direction), (motion, along, size), &mut |crane, motion| {
                let [q, v] = halves(&motion[..2 * n]);
                let mut all = vec![0.0; motion.len() - n];
                let (sum, rates) = all.split_at_mut(n);
                others.evaluate(crane, &StateAt { t, q, v, x: &motion[2 * n..] }, rates, None);
                for (force, row) in others.forces().iter().zip(others.rows()).take(forces) {
                    row.add_to(sum, force.force);
                }
                all
            });
            found[..n].iter_mut().zip(&coupled).for_each(|(found, force)| *found += force);
            found[n..][..states].copy_from_slice(&coupled[n..][..states]);
        }
        found
    }

    /// Moves derivatives, given in full, onto the loops of the crane, as a motion is: `J δq = −δφ`, then `J δv = −δφ̇`.
    pub fn project(&mut self, slopes: &mut dyn Slopes, (t, motion): (f64, &[f64]), along: &mut [Vec<f64>]) {
        if self.loops.is_empty() {
            return;
        }
        let n = self.n;
        let [q, v] = halves(&motion[..2 * n]);
        let crane = self.crane;
        self.loops.evaluate(crane, q, v);
        self.loops.choose();
        self.loops.factorise(&mut |r, x| (crane as &dyn DynDynamics).solve_mass(q, r, x));
        let at = At { t, q, v, a: &self.zeros, multipliers: &[] };
        for part in 0..2 {
            slopes.loops(&at, along, &mut self.of_loops);
            for (along, of_loops) in along.iter_mut().zip(&self.of_loops) {
                // The slopes contain J δq or J δv itself: what is missing is solved for from zero.
                let mut change = vec![0.0; n];
                self.loops.correct_by(&mut change, |row| of_loops[row][part]);
                along[part * n..][..n].iter_mut().zip(&change).for_each(|(entry, change)| *entry += change);
            }
        }
    }
}

/// Pose and rates.
pub(super) fn halves(state: &[f64]) -> [&[f64]; 2] {
    let (q, v) = state.split_at(state.len() / 2);
    [q, v]
}
