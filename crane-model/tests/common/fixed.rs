//! A crane without coordinates: nothing moves.

use crane_model::{CraneModel, Description, Linearisation, ParameterError, Wrench};
use nalgebra::{Matrix4, SMatrix, SVector};

use super::description;

static DESCRIPTION: Description = description("fixed", &[], &[]);

/// No coordinates.
#[derive(Clone, Copy, Default)]
pub struct Fixed;

impl CraneModel<0> for Fixed {
    crate::common::implicit::by_hand! { 0 }

    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        out.fill([0.0; 2]);
    }

    fn description(&self) -> &Description {
        &DESCRIPTION
    }

    fn parameter(&self, _: usize) -> f64 {
        f64::NAN
    }

    fn set_parameter(&mut self, _: usize, _: f64) -> Result<(), ParameterError> {
        Ok(())
    }

    fn transforms(&self, _: &SVector<f64, 0>, _: &mut [Matrix4<f64>]) {}

    fn body_sizes(&self, _: &mut [[f64; 2]]) {}

    fn gravity_energy(&self, _: &SVector<f64, 0>) -> f64 {
        0.0
    }

    fn mass_matrix(&self, _: &SVector<f64, 0>, _: &mut SMatrix<f64, 0, 0>) {}

    fn bias(&self, _: &SVector<f64, 0>, _: &SVector<f64, 0>) -> SVector<f64, 0> {
        SVector::zeros()
    }

    fn kinetic_energy(&self, _: &SVector<f64, 0>, _: &SVector<f64, 0>) -> f64 {
        0.0
    }

    fn static_residual(&self, _: f64, _: &SVector<f64, 0>, _: &SVector<f64, 0>) -> SVector<f64, 0> {
        SVector::zeros()
    }

    fn tangent_stiffness(&self, _: f64, _: &SVector<f64, 0>, _: &SVector<f64, 0>, _: &mut SMatrix<f64, 0, 0>) {}

    fn linearise(&self, _: &SVector<f64, 0>) -> Linearisation<0> {
        Linearisation { mass: SMatrix::zeros(), stiffness: SMatrix::zeros(), damping: SMatrix::zeros() }
    }

    fn internal_forces(&self, _: f64, _: &SVector<f64, 0>, _: &SVector<f64, 0>, _: &SVector<f64, 0>, _: &mut [Wrench]) {
    }
}
