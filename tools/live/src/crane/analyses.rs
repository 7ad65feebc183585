//! Accelerations, statics, small motions, internal forces and derivatives of a live crane.

use crane_codegen::program::{FunctionId, Shape};
use crane_model::dyn_crane::{DynDerivatives, DynDynamics, DynInternalForces, DynLinearise, DynStatics};
use crane_model::nalgebra::{Matrix4, Vector3};
use crane_model::{SectionModuli, Wrench};

use super::{LiveCrane, at, copy, copy_as, state};
use crate::expansion::{mass_matrix, second_derivatives};
use crate::machine::Arguments;

impl DynStatics for LiveCrane {
    fn static_residual(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::StaticResidual, &at_rest(t, q, positions), out);
    }

    fn tangent_stiffness(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::TangentStiffness, &at_rest(t, q, positions), out);
    }

    fn drive_forces_at_rest(&self, t: f64, q: &[f64], positions: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::DriveForcesAtRest, &at_rest(t, q, positions), out);
    }
}

/// The arguments of functions at rest.
fn at_rest<'a>(t: f64, q: &'a [f64], positions: &'a [f64]) -> Arguments<'a, f64> {
    Arguments { positions, ..state(t, q, &[]) }
}

impl DynDynamics for LiveCrane {
    fn mass_matrix(&self, q: &[f64], out: &mut [f64]) {
        self.call(FunctionId::MassMatrix, &at(q), |routine, results| match routine.shape() {
            Shape::Columns { points, .. } => mass_matrix(points, results, out),
            _ => copy(results, out),
        });
    }

    fn bias(&self, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::Bias, &state(0.0, q, v), out);
    }

    fn forward_dynamics(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::ForwardDynamics, &state(t, q, v), out);
    }

    fn solve_mass(&self, q: &[f64], r: &[f64], out: &mut [f64]) {
        self.numbers(FunctionId::SolveMass, &Arguments { right: r, ..at(q) }, out);
    }

    fn kinetic_energy(&self, q: &[f64], v: &[f64]) -> f64 {
        self.scalar(FunctionId::KineticEnergy, &state(0.0, q, v))
    }
}

impl DynLinearise for LiveCrane {
    fn linearise(&self, q: &[f64], mass: &mut [f64], stiffness: &mut [f64], damping: &mut [f64]) {
        self.call(FunctionId::Linearise, &at(q), |_, results| {
            let mut rest: &[f64] = results;
            for matrix in [mass, stiffness, damping] {
                let (own, others) = rest.split_at(matrix.len().min(rest.len()));
                copy(own, matrix);
                rest = others;
            }
        });
    }
}

fn wrench([fx, fy, fz, mx, my, mz]: &[f64; 6]) -> Wrench {
    Wrench { force: Vector3::new(*fx, *fy, *fz), moment: Vector3::new(*mx, *my, *mz) }
}

impl DynInternalForces for LiveCrane {
    fn internal_forces(&self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut [Wrench]) {
        self.call(FunctionId::InternalForces, &Arguments { a, ..state(t, q, v) }, |_, results| {
            copy_as(results.as_chunks().0, wrench, out);
        });
    }

    fn cylinder_wrenches(&self, q: &[f64], out: &mut [Wrench]) {
        self.call(FunctionId::CylinderWrenches, &at(q), |_, results| copy_as(results.as_chunks().0, wrench, out));
    }

    fn connector_wrenches(&self, q: &[f64], out: &mut [Wrench]) {
        self.call(FunctionId::ConnectorWrenches, &at(q), |_, results| copy_as(results.as_chunks().0, wrench, out));
    }

    fn loop_wrenches(&self, q: &[f64], out: &mut [Wrench]) {
        self.call(FunctionId::LoopWrenches, &at(q), |_, results| copy_as(results.as_chunks().0, wrench, out));
    }

    fn section_moduli(&self, out: &mut [SectionModuli]) {
        self.call(FunctionId::SectionModuli, &Arguments::none(), |_, results| {
            let moduli = |numbers: &[f64; 8]| {
                let [area, bending_y, bending_z, torsion, shear_y, shear_z, corners, allowable_stress] = *numbers;
                SectionModuli { area, bending_y, bending_z, torsion, shear_y, shear_z, corners, allowable_stress }
            };
            copy_as(results.as_chunks().0, moduli, out);
        });
    }

    fn support_positions(&self, q: &[f64], out: &mut [Vector3<f64>]) {
        self.vectors(FunctionId::SupportPositions, &at(q), out);
    }
}

impl DynDerivatives for LiveCrane {
    fn transform_derivatives(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.matrices(FunctionId::TransformDerivatives, &at(q), out);
    }

    fn transform_second_derivatives(&self, q: &[f64], out: &mut [Matrix4<f64>]) {
        self.call(FunctionId::TransformSecondDerivatives, &at(q), |routine, results| match routine.shape() {
            Shape::TransformFactors { degrees, rotations, vectors } => {
                second_derivatives(degrees, rotations.len(), vectors, results, out);
            }
            _ => copy_as(results.as_chunks::<16>().0, |matrix| Matrix4::from_column_slice(matrix), out),
        });
    }
}
