//! The rates of a motion, and their derivatives along directions.

use nalgebra::DMatrix;

use super::{CylinderSlopes, FeetSlopes, MotionAt, Slopes};
use crate::{
    StateAt,
    dyn_crane::{DynCrane, DynSystem},
    dynamics::{NotFinite, state::finite},
    force_states::ForceStates,
    loop_joints::Loops,
};

/// F of a crane: of a motion `[q, v, x]` in full, not relative to the motions of drives.
pub(super) struct Rates<'a> {
    pub(super) crane: &'a dyn DynCrane,
    pub(super) n: usize,
    pub(super) system: Box<dyn DynSystem + 'a>,
    pub(super) force_states: ForceStates,
    /// Derivatives of the rates of x by x.
    pub(super) by_states: DMatrix<f64>,
    pub(super) loops: Loops,
    pub(super) prescribed: Vec<usize>,
    /// Index of the drive of each prescribed coordinate.
    pub(super) drives: Vec<usize>,
    pub(super) zeros: Vec<f64>,
    /// a, and the rates of x.
    pub(super) accelerations: Vec<f64>,
    of_states: Vec<f64>,
    residuals: Vec<Vec<f64>>,
    of_loops: Vec<Vec<[f64; 3]>>,
    of_cylinders: Vec<Vec<CylinderSlopes>>,
    of_feet: Vec<FeetSlopes>,
}

impl<'a> Rates<'a> {
    /// Of a crane, with as many directions.
    pub fn new(crane: &'a dyn DynCrane, directions: usize) -> Self {
        let (n, description) = (crane.size(), crane.description());
        let force_states = ForceStates::new(description);
        let cylinders = if description.has_valves() { description.cylinders.len() } else { 0 };
        let of_cylinder = CylinderSlopes { jacobian: vec![0.0; n], ..CylinderSlopes::default() };
        let prescribed = description.prescribed();
        let drive = |coordinate: &usize| description.drives.iter().position(|drive| drive.coordinate == *coordinate);
        let loops = Loops::new(crane);
        let equations = crane.loop_joints().iter().map(|joint| joint.equations.len()).sum();
        Self {
            crane,
            n,
            system: (crane as &dyn DynCrane).system(),
            of_states: vec![0.0; force_states.len()],
            by_states: DMatrix::zeros(force_states.len(), force_states.len()),
            force_states,
            loops,
            drives: prescribed.iter().filter_map(drive).collect(),
            prescribed,
            zeros: vec![0.0; n],
            accelerations: vec![0.0; n],
            residuals: vec![vec![0.0; n]; directions],
            of_loops: vec![vec![[0.0; 3]; equations]; directions],
            of_cylinders: vec![vec![of_cylinder; cylinders]; directions],
            of_feet: vec![FeetSlopes::zero(description); directions],
        }
    }

    /// F at a time.
    pub fn at(&mut self, t: f64, motion: &[f64]) -> Result<Vec<f64>, NotFinite> {
        let n = self.n;
        let moment = StateAt::from_motion(t, n, motion);
        let v = moment.v;
        self.loops.open(self.crane, &moment, &mut self.accelerations);
        if !self.force_states.is_empty() {
            let Self { force_states, crane, of_states, by_states, accelerations, .. } = self;
            force_states.accelerate_with_slopes(*crane, &moment, of_states, Some(by_states), accelerations);
        }
        self.loops.close(&mut self.accelerations);
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
        let at = MotionAt { t, q, v, a: &self.accelerations, multipliers: self.loops.multipliers() };
        slopes.residuals(&at, along, &mut self.residuals);
        if !self.loops.is_empty() {
            slopes.loops(&at, along, &mut self.of_loops);
        }
        self.system.factorise(q, &self.zeros, &[0.0; 36]);
        let mass = (!self.prescribed.is_empty()).then(|| {
            let mut mass = DMatrix::zeros(n, n);
            self.crane.mass_matrix(q, mass.as_mut_slice());
            mass
        });
        if self.of_cylinders.first().is_some_and(|cylinders| !cylinders.is_empty()) {
            slopes.cylinders(&at, along, &mut self.of_cylinders);
        }
        if has_slid(&self.force_states) {
            slopes.feet(&at, along, &mut self.of_feet);
        }
        for (direction, out) in out.iter_mut().enumerate() {
            let along = &along[direction];
            out[..n].copy_from_slice(&along[n..2 * n]);
            let right = &mut self.residuals[direction];
            for entry in right.iter_mut() {
                *entry = -*entry;
            }
            if !self.force_states.is_empty() {
                let Self { force_states, by_states, of_cylinders, .. } = self;
                of_forces((force_states, by_states), &of_cylinders[direction], along, (right, &mut out[2 * n..]));
                if let Some((feet, [force, state])) = force_states.feet().filter(|_| has_slid(force_states)) {
                    feet.add_slopes(
                        &force_states.forces()[force..],
                        &self.of_feet[direction],
                        (v, &along[n..2 * n]),
                        [&motion[2 * n + state..], &along[2 * n + state..]],
                        (right, &mut out[2 * n + state..]),
                    );
                }
            }
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
        Ok(())
    }

    /// Prepares the loop joints to move derivatives onto the loops.
    pub(super) fn choose_loops(&mut self, q: &[f64], v: &[f64]) {
        let crane = self.crane;
        self.loops.evaluate(crane, q, v);
        self.loops.choose();
        self.loops.factorise(&mut |r, x| (crane as &dyn DynCrane).solve_mass(q, r, x));
    }

    /// Moves derivatives, given in full, onto the loops of the crane, as a motion is: `J δq = −δφ`, then `J δv = −δφ̇`.
    pub fn project(&mut self, slopes: &mut dyn Slopes, (t, motion): (f64, &[f64]), along: &mut [Vec<f64>]) {
        if self.loops.is_empty() {
            return;
        }
        let n = self.n;
        let [q, v] = halves(&motion[..2 * n]);
        self.choose_loops(q, v);
        let at = MotionAt { t, q, v, a: &self.zeros, multipliers: &[] };
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

/// Adds the derivatives of the generalized forces with states of their own along a direction, and writes those of the rates of these states. The
/// forces are those last evaluated, with the derivatives of the rates by the states.
fn of_forces(
    (forces, by_states): (&ForceStates, &DMatrix<f64>),
    cylinders: &[CylinderSlopes],
    along: &[f64],
    (sum, rates): (&mut [f64], &mut [f64]),
) {
    let n = sum.len();
    let states = &along[2 * n..];
    for (row, rate) in rates.iter_mut().enumerate() {
        *rate = states.iter().enumerate().map(|(column, state)| by_states[(row, column)] * state).sum();
    }
    for (force, row) in forces.forces().iter().zip(forces.rows()).filter(|(force, _)| !force.is_of_foot) {
        let range = force.first..force.first + force.count;
        let of_cylinder = force.cylinder.map(|cylinder| &cylinders[cylinder]);
        let [length, speed] = match of_cylinder {
            Some(slopes) => slopes.length_and_rate,
            None => [row.along(&along[..n]), row.along(&along[n..2 * n])],
        };
        let by_states: f64 = force.by_states.iter().zip(&states[range.clone()]).map(|(slope, x)| slope * x).sum();
        row.add_to(sum, force.by_length * length + force.by_speed * speed + by_states);
        for (index, rate) in rates[range.clone()].iter_mut().enumerate() {
            *rate += force.rates_by_length[index] * length + force.rates_by_speed[index] * speed;
        }
        if let Some(CylinderSlopes { wanted, opening, jacobian, .. }) = of_cylinder {
            sum.iter_mut().zip(jacobian).for_each(|(sum, slope)| *sum += slope * force.force);
            let command = [wanted[0], wanted[1], *opening];
            let by_command: f64 = force.by_command.iter().zip(command).map(|(slope, change)| slope * change).sum();
            rates[range.end - 1] += by_command;
        }
    }
}

/// Whether feet have slid, or slide, at the last evaluation: what they add is zero otherwise, and so are its derivatives.
pub(super) fn has_slid(forces: &ForceStates) -> bool {
    forces.feet().is_some_and(|(feet, _)| feet.has_slid())
}

/// Pose and rates.
pub(super) fn halves(state: &[f64]) -> [&[f64]; 2] {
    let (q, v) = state.split_at(state.len() / 2);
    [q, v]
}
