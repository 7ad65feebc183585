//! Quantities of a crane that closed loops change, as owned lists.

use nalgebra::{DVector, Vector3};

use super::{Loops, add_to_wrenches, at_rest, generalized, on_rigid_drives, required};
use crate::{ConnectorInfo, CylinderInfo, Description, StateAt, Tension, Wrench, dyn_crane::DynCrane, wrench};

/// # Panics
/// If `q`, `v` or `a` does not have as many numbers as the crane has coordinates.
impl dyn DynCrane + '_ {
    /// Accelerations q̈, with closed loops, m/s² and rad/s².
    pub fn accelerations_at(&self, t: f64, q: &[f64], v: &[f64]) -> DVector<f64> {
        let mut accelerations = vec![0.0; self.size()];
        let mut loops = Loops::new(self);
        loops.open(self, &StateAt { t, q, v, x: &[] }, &mut accelerations);
        loops.close(&mut accelerations);
        accelerations.into()
    }

    /// Torques and forces of the drives, in their order: N m and N.
    pub fn drive_efforts_at(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        let mut efforts = self.open_drive_efforts_at(t, q, v);
        let mut loops = Loops::new(self);
        if !loops.is_empty() && !self.description().prescribed().is_empty() {
            let open = self.numbers(|out| loops.open(self, &StateAt { t, q, v, x: &[] }, out));
            let mut change = open.clone();
            loops.close(&mut change);
            change.iter_mut().zip(&open).for_each(|(change, open)| *change -= open);
            for (coordinate, added) in on_rigid_drives(self, q, &loops, &change) {
                let drives = self.description().drives.iter().zip(&mut efforts);
                drives.filter(|(drive, _)| drive.coordinate == coordinate).for_each(|(_, effort)| *effort += added);
            }
        }
        efforts
    }

    /// Torques and forces of the drives that hold the crane at rest at t = 0, including rigid drives: N m and N.
    pub fn drive_efforts_at_rest(&self, q: &[f64]) -> Vec<f64> {
        self.efforts_at_rest(0.0, &self.drive_positions_at(0.0), q)
    }

    /// Torques and forces of the drives that hold the crane at rest with the drives at given positions, one per drive, and loads and winches
    /// as at time `t`: N m and N.
    pub fn drive_efforts_holding(&self, t: f64, positions: &[f64], q: &[f64]) -> Vec<f64> {
        self.efforts_at_rest(t, &self.description().by_coordinate(positions), q)
    }

    /// With positions by coordinate. A rigid drive also balances the loops, `Jᵀ λ`.
    fn efforts_at_rest(&self, t: f64, positions: &[f64], q: &[f64]) -> Vec<f64> {
        let mut forces = self.numbers(|out| self.drive_forces_at_rest(t, q, positions, out));
        if !self.loop_joints().is_empty() {
            let resisted = generalized(self, q, &at_rest(self, t, positions, q));
            for j in self.description().prescribed() {
                forces[j] += resisted[j];
            }
        }
        self.description().drives.iter().map(|drive| forces[drive.coordinate]).collect()
    }

    /// What the equations of the loop joints transmit at rest at t = 0, N and N m.
    pub fn loop_forces_at_rest(&self, q: &[f64]) -> Vec<f64> {
        self.loop_forces_holding(0.0, &self.drive_targets_at(0.0), q)
    }

    /// The same with the drives at given positions, one per drive, and loads and winches as at time `t`.
    pub fn loop_forces_holding(&self, t: f64, positions: &[f64], q: &[f64]) -> Vec<f64> {
        if self.loop_joints().is_empty() {
            return Vec::new();
        }
        at_rest(self, t, &self.description().by_coordinate(positions), q)
    }

    /// Tensions of connectors at rest, N and N m, with winches as at time `t` but standing: a damper of a rope resists the rate of its winch only while
    /// that turns.
    pub fn tensions_at_rest(&self, t: f64, q: &[f64]) -> Vec<f64> {
        // Over this time, s, accelerations of 1 m/s² give rates to 1e-6 m/s, and lengths of 10 m, rounded at 2e-15 m, to 2e-9. Rates that jump have at
        // their time the value behind it.
        const STEP: f64 = 1e-6;
        let rest = vec![0.0; self.size()];
        let of_rope = |(rope, tension): (&ConnectorInfo, &Tension)| rope.pieces > 0 && tension.damping > 0.0;
        let tensions = self.connector_tensions_at(t, q, &rest);
        let mut forces: Vec<f64> = tensions.iter().map(|tension| tension.force).collect();
        let winches: Vec<bool> = self.description().connectors.iter().zip(&tensions).map(of_rope).collect();
        if winches.contains(&true) {
            let after = self.connector_tensions_at(t + STEP, q, &rest);
            for index in (0..forces.len()).filter(|index| winches[*index]) {
                // `F = k σ (1 + a σ̇)`: its slope by σ is F/σ, that by σ̇ is k σ a.
                let [now, after] = [&tensions, &after].map(|at| at[index].force / at[index].stiffness);
                let rate = (after - now) / STEP;
                if rate.is_finite() {
                    forces[index] -= tensions[index].damping * rate;
                }
            }
        }
        forces
    }

    /// The wrench that the part beyond each cut exerts on the part before it, cut by cut: N and N m. Cylinders with a valve push with
    /// the force that the accelerations require, without friction of bristles, whose states are not known here; loop joints transmit what
    /// the accelerations require.
    pub fn internal_forces_at(&self, t: f64, q: &[f64], v: &[f64], a: &[f64]) -> Vec<Wrench> {
        let multipliers = self.loop_forces_required(t, [q, v, a]);
        let pushes =
            if self.description().has_valves() { self.pushes_required(t, [q, v, a], &multipliers) } else { Vec::new() };
        self.internal_forces_with(t, [q, v, a], &pushes, &multipliers)
    }

    /// What the equations of the loop joints transmit so that the crane has given accelerations; empty without loops.
    fn loop_forces_required(&self, t: f64, motion: [&[f64]; 3]) -> Vec<f64> {
        if self.loop_joints().is_empty() { Vec::new() } else { required(self, t, motion) }
    }

    /// With cylinders that push with given forces, N, and loop joints that transmit given forces and moments; both are empty if there are
    /// none.
    pub(crate) fn internal_forces_with(
        &self,
        t: f64,
        [q, v, a]: [&[f64]; 3],
        pushes: &[f64],
        multipliers: &[f64],
    ) -> Vec<Wrench> {
        let mut out = vec![Wrench::ZERO; self.description().cuts().len()];
        self.internal_forces(t, q, v, a, &mut out);
        let mut of_cylinders = vec![Wrench::ZERO; pushes.len() * out.len()];
        self.cylinder_wrenches(q, &mut of_cylinders);
        for (push, own) in pushes.iter().zip(of_cylinders.chunks_exact(out.len())) {
            wrench::add(&mut out, *push, own);
        }
        add_to_wrenches(self, q, multipliers, false, &mut out);
        out
    }

    /// Forces with which cylinders with a valve push so that the crane has given accelerations, N; 0 for others.
    fn pushes_required(&self, t: f64, [q, v, a]: [&[f64]; 3], multipliers: &[f64]) -> Vec<f64> {
        let Description { drives, cylinders, .. } = self.description();
        let inertia = self.mass_matrix_at(q) * DVector::from_column_slice(a);
        let (bias, forces) = (self.bias_at(q, v), self.numbers(|out| self.forces(t, q, v, out)));
        let resisted = generalized(self, q, multipliers);
        let mut states = vec![Vector3::zeros(); cylinders.len()];
        self.cylinder_states(q, v, &mut states);
        let push = |(cylinder, state): (&CylinderInfo, &Vector3<f64>)| {
            let j = drives[cylinder.drive].coordinate;
            if cylinder.valve.is_some() { (inertia[j] - bias[j] - forces[j] + resisted[j]) / state.z } else { 0.0 }
        };
        cylinders.iter().zip(&states).map(push).collect()
    }

    /// The wrench at each cut without forces that are internal to the crane, those of connectors and loop joints between two bodies and of
    /// cylinders: only inertia, weight and what acts from outside, N and N m.
    pub(crate) fn external_forces_at(&self, t: f64, q: &[f64], v: &[f64], a: &[f64]) -> Vec<Wrench> {
        let mut out = self.internal_forces_with(t, [q, v, a], &[], &[]);
        add_to_wrenches(self, q, &self.loop_forces_required(t, [q, v, a]), true, &mut out);
        let tensions = self.connector_tensions_at(t, q, v);
        let mut of_connectors = vec![Wrench::ZERO; tensions.len() * out.len()];
        self.connector_wrenches(q, &mut of_connectors);
        for (tension, own) in tensions.iter().zip(of_connectors.chunks_exact(out.len())) {
            wrench::add(&mut out, -tension.force, own);
        }
        out
    }

    /// Numbers per coordinate, written by `write`.
    fn numbers(&self, write: impl FnOnce(&mut [f64])) -> Vec<f64> {
        let mut out = vec![0.0; self.size()];
        write(&mut out);
        out
    }
}
