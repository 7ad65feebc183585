//! Poses, forces, energies and motions of a live crane.

use crane_codegen::chain::Input;
use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::DynModel;
use crane_model::nalgebra::{Matrix4, Vector3};
use crane_model::{Description, LoopJointInfo, Tension};

use super::{LiveCrane, at, copy_as, state};
use crate::machine::Arguments;

impl DynModel for LiveCrane {
    fn description(&self) -> &Description {
        &self.description
    }

    fn parents(&self) -> &[usize] {
        self.library.parents()
    }

    fn parameter(&self, index: usize) -> f64 {
        self.parameters.get(index).copied().unwrap_or(f64::NAN)
    }

    fn input(&self, index: usize) -> Option<f64> {
        let slots = self.inputs.get(Input::SLOTS * index..)?;
        slots.first_chunk().and_then(|[value, free]| (*free == 0.0).then_some(*value))
    }

    fn transforms(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.matrices(FunctionId::Transforms, &at(q), out);
    }

    fn points(&self, q: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::Points, &at(q), out);
    }

    fn point_velocities(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::PointVelocities, &state(0.0, q, v), out);
    }

    fn forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::Forces, &state(t, q, v), out);
    }

    fn element_forces(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ElementForces, &state(0.0, q, v), out);
    }

    fn drive_forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::DriveForces, &state(t, q, v), out);
    }

    fn stop_forces(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::StopForces, &state(0.0, q, v), out);
    }

    fn friction_forces(&self, v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::FrictionForces, &state(0.0, &[], v), out);
    }

    fn load_forces(&self, t: f64, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::LoadForces, &state(t, q, &[]), out);
    }

    fn connector_forces(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ConnectorForces, &state(t, q, v), out);
    }

    fn connector_lengths(&self, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::ConnectorLengths, &state(0.0, q, v), out);
    }

    fn connector_tensions(&self, t: f64, q: &[f64], v: &[f64], out: &mut [Tension]) {
        self.call(FunctionId::ConnectorTensions, &state(t, q, v), |_, results| {
            let tension = |&[force, stiffness, damping]: &[f64; 3]| Tension { force, stiffness, damping };
            copy_as(results.as_chunks().0, tension, out);
        });
    }

    fn connector_jacobians(&self, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ConnectorJacobians, &at(q), out);
    }

    fn loop_joints(&self) -> &[LoopJointInfo] {
        &self.loop_joints
    }

    fn loop_states(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::LoopStates, &state(0.0, q, v), out);
    }

    fn loop_jacobians(&self, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::LoopJacobians, &at(q), out);
    }

    fn winch_pieces(&self, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::WinchPieces, &Arguments::none(), out);
    }

    fn load_pieces(&self, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::LoadPieces, &Arguments::none(), out);
    }

    fn support_reactions(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::SupportReactions, &state(0.0, q, v), out);
    }

    fn support_gaps(&self, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::SupportGaps, &state(0.0, q, v), out);
    }

    fn cylinder_states(&self, q: &[f64], v: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::CylinderStates, &state(0.0, q, v), out);
    }

    fn cylinder_jacobians(&self, q: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::CylinderJacobians, &at(q), out);
    }

    fn drive_motions(&self, t: f64, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::DriveMotions, &Arguments { t, ..Arguments::none() }, out);
    }

    fn drive_limits(&self, t: f64, q: &[f64], v: &[f64], out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::DriveLimits, &state(t, q, v), out);
    }

    fn prescribe(&self, t: f64, q: &mut [f64], v: &mut [f64]) {
        self.call(FunctionId::PrescribedMotions, &Arguments { t, ..Arguments::none() }, |_, results| {
            for (drive, [position, rate]) in self.chain().rigid_drives().zip(results.as_chunks().0) {
                (q[drive.coordinate.0], v[drive.coordinate.0]) = (*position, *rate);
            }
        });
    }

    fn valve_openings(&self, t: f64, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::ValveOpenings, &Arguments { t, ..Arguments::none() }, out);
    }

    fn drive_pieces(&self, out: &mut [[f64; 2]]) {
        self.pairs(FunctionId::DrivePieces, &Arguments::none(), out);
    }

    fn gravity_energy(&self, q: &[f64]) -> f64 {
        self.scalar(FunctionId::GravityEnergy, &at(q))
    }

    fn support_energy(&self, q: &[f64]) -> f64 {
        self.scalar(FunctionId::SupportEnergy, &at(q))
    }

    fn element_energy(&self, q: &[f64]) -> f64 {
        self.scalar(FunctionId::ElementEnergy, &at(q))
    }

    fn drive_energy(&self, t: f64, q: &[f64]) -> f64 {
        self.scalar(FunctionId::DriveEnergy, &Arguments { t, ..at(q) })
    }

    fn stop_energy(&self, q: &[f64]) -> f64 {
        self.scalar(FunctionId::StopEnergy, &at(q))
    }

    fn drive_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::DrivePower, &state(t, q, v))
    }

    fn connector_energy(&self, t: f64, q: &[f64]) -> f64 {
        self.scalar(FunctionId::ConnectorEnergy, &state(t, q, &[]))
    }

    fn winch_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::WinchPower, &state(t, q, v))
    }

    fn load_power(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::LoadPower, &state(t, q, v))
    }

    fn dissipation(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::Dissipation, &state(t, q, v))
    }
}
