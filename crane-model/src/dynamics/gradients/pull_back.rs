//! The transpose of the derivatives of rates: from weights of the rates to the derivatives of their weighted sum.
//!
//! With weights w of the accelerations, μ and ν of
//!
//! ```text
//! [A  Jᵀ] [μ]   [w]
//! [J  0 ] [ν] = [0]      wᵀ δa = μᵀ (δQ − δr) − νᵀ δ(J a + J̇ v)
//! ```
//!
//! take one solution, however many numbers there are.

use nalgebra::DMatrix;

use super::{
    Covector, CylinderSlopes, FeetSlopes, MotionAt, PullBacks,
    rates::{Rates, halves, has_slid},
};
use crate::{
    dynamics::{NotFinite, motion::add, state::finite},
    force_states::ForceStates,
};

impl Rates<'_> {
    /// Adds `wᵀ ∂F` of a motion with weights w of its rates, and to `of_drives` the weights of the accelerations of drives.
    pub fn pull_back(
        &mut self,
        functions: &mut dyn PullBacks,
        (t, motion): (f64, &[f64]),
        weights: &[f64],
        of_drives: &mut [f64],
        sum: &mut Covector,
    ) -> Result<(), NotFinite> {
        let n = self.n;
        self.at(t, motion)?;
        let [q, v] = halves(&motion[..2 * n]);
        let (of_q, rest) = weights.split_at(n);
        let (of_v, of_x) = rest.split_at(n);
        add(&mut sum.motion[n..2 * n], 1.0, of_q);
        let mut right = of_v.to_vec();
        let mut gammas = vec![0.0; self.loops.multipliers().len()];
        if !self.loops.is_empty() {
            self.loops.pull_back(&mut right, &mut gammas);
        }
        for (j, drive) in self.prescribed.iter().zip(&self.drives) {
            of_drives[*drive] += std::mem::take(&mut right[*j]);
        }
        self.system.factorise(q, &self.zeros, &[0.0; 36]);
        let mut forces = vec![0.0; n];
        self.system.solve(&right, &mut forces);
        if !self.prescribed.is_empty() {
            self.prescribed.iter().for_each(|j| forces[*j] = 0.0);
            let mut mass = DMatrix::zeros(n, n);
            self.crane.mass_matrix(q, mass.as_mut_slice());
            for (j, drive) in self.prescribed.iter().zip(&self.drives) {
                of_drives[*drive] -= mass.column(*j).iter().zip(&forces).map(|(mass, force)| mass * force).sum::<f64>();
            }
        }
        let at = MotionAt { t, q, v, a: &self.accelerations, multipliers: self.loops.multipliers() };
        if !self.force_states.is_empty() {
            let description = self.crane.description();
            let cylinders = if description.has_valves() { description.cylinders.len() } else { 0 };
            let mut of_cylinders =
                vec![CylinderSlopes { jacobian: vec![0.0; n], ..CylinderSlopes::default() }; cylinders];
            let states = (&self.force_states, &self.by_states);
            of_forces(states, (&forces, of_x), &mut of_cylinders, &mut sum.motion);
            if cylinders > 0 {
                functions.cylinders(&at, &of_cylinders, sum);
            }
            let x = &motion[2 * n..];
            if let Some((feet, [force, state])) = self.force_states.feet().filter(|_| has_slid(&self.force_states)) {
                let mut of_feet = FeetSlopes::zero(description);
                let (of_pose, of_states) = sum.motion.split_at_mut(2 * n);
                feet.pull_back(
                    &self.force_states.forces()[force..],
                    (&forces, &of_x[state..]),
                    (v, &x[state..]),
                    &mut of_feet,
                    (&mut of_pose[n..], &mut of_states[state..]),
                );
                functions.feet(&at, &of_feet, sum);
            }
        }
        let forces: Vec<f64> = forces.iter().map(|force| -force).collect();
        functions.residuals(&at, &forces, sum);
        if !self.loops.is_empty() {
            let weights: Vec<[f64; 3]> = gammas.iter().map(|gamma| [0.0, 0.0, *gamma]).collect();
            functions.loops(&at, &weights, sum);
        }
        finite(&sum.motion)
    }

    /// The transpose of [`project`](Self::project).
    pub fn pull_back_projection(
        &mut self,
        functions: &mut dyn PullBacks,
        (t, motion): (f64, &[f64]),
        sum: &mut Covector,
    ) {
        let n = self.n;
        let [q, v] = halves(&motion[..2 * n]);
        self.choose_loops(q, v);
        let at = MotionAt { t, q, v, a: &self.zeros, multipliers: &[] };
        let mut gammas = vec![0.0; self.loops.multipliers().len()];
        for part in [1, 0] {
            // What is projected starts from zero: only the weights of the slopes remain.
            self.loops.pull_back(&mut sum.motion[part * n..][..n].to_vec(), &mut gammas);
            let weights: Vec<[f64; 3]> = gammas
                .iter()
                .map(|gamma| {
                    let mut weights = [0.0; 3];
                    weights[part] = *gamma;
                    weights
                })
                .collect();
            functions.loops(&at, &weights, sum);
        }
    }
}

/// The transpose of what forces with states add to the derivatives of rates: from the weights of the generalized forces, and of the rates of
/// their states, to those of cylinders, and to `[q, v, x]`.
fn of_forces(
    (forces, by_states): (&ForceStates, &DMatrix<f64>),
    (generalized, of_rates): (&[f64], &[f64]),
    cylinders: &mut [CylinderSlopes],
    sum: &mut [f64],
) {
    let (of_q, rest) = sum.split_at_mut(generalized.len());
    let (of_v, of_x) = rest.split_at_mut(generalized.len());
    for (column, sum) in of_x.iter_mut().enumerate() {
        *sum += of_rates.iter().enumerate().map(|(row, weight)| by_states[(row, column)] * weight).sum::<f64>();
    }
    for (force, row) in forces.forces().iter().zip(forces.rows()).filter(|(force, _)| !force.is_of_foot) {
        let range = force.first..force.first + force.count;
        let weight = row.along(generalized);
        add(&mut of_x[range.clone()], weight, &force.by_states);
        let along = |slopes: &[f64]| -> f64 {
            slopes.iter().zip(&of_rates[range.clone()]).map(|(slope, weight)| slope * weight).sum()
        };
        let length = force.by_length * weight + along(&force.rates_by_length);
        let speed = force.by_speed * weight + along(&force.rates_by_speed);
        let Some(cylinder) = force.cylinder else {
            row.add_to(of_q, length);
            row.add_to(of_v, speed);
            continue;
        };
        let of_cylinder = &mut cylinders[cylinder];
        of_cylinder.length_and_rate = [length, speed];
        add(&mut of_cylinder.jacobian, force.force, generalized);
        let [wanted, rate, opening] = force.by_command.map(|slope| slope * of_rates[range.end - 1]);
        (of_cylinder.wanted, of_cylinder.opening) = ([wanted, rate], opening);
    }
}
