//! A crane without coordinates: nothing moves.

use crane_model::{
    CraneModel, Description, Dynamics, InternalForces, Linearisation, Linearise, ParameterError, Statics, Wrench,
};
use nalgebra::{Matrix4, SMatrix, SVector};

use super::description;

static DESCRIPTION: Description = description("fixed", &[], &[]);

/// No coordinates.
#[derive(Clone, Copy, Default)]
pub struct Fixed;

impl CraneModel<0> for Fixed {
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
}

impl Dynamics<0> for Fixed {
    fn mass_matrix(&self, _: &SVector<f64, 0>, _: &mut SMatrix<f64, 0, 0>) {}

    fn bias(&self, _: &SVector<f64, 0>, _: &SVector<f64, 0>) -> SVector<f64, 0> {
        SVector::zeros()
    }

    fn kinetic_energy(&self, _: &SVector<f64, 0>, _: &SVector<f64, 0>) -> f64 {
        0.0
    }
}

impl Statics<0> for Fixed {
    fn static_residual(&self, _: f64, _: &SVector<f64, 0>, _: &SVector<f64, 0>) -> SVector<f64, 0> {
        SVector::zeros()
    }

    fn tangent_stiffness(&self, _: f64, _: &SVector<f64, 0>, _: &SVector<f64, 0>, _: &mut SMatrix<f64, 0, 0>) {}
}

impl Linearise<0> for Fixed {
    fn linearise(&self, _: &SVector<f64, 0>) -> Linearisation<0> {
        Linearisation { mass: SMatrix::zeros(), stiffness: SMatrix::zeros(), damping: SMatrix::zeros() }
    }
}

impl InternalForces<0> for Fixed {
    fn internal_forces(&self, _: f64, _: &SVector<f64, 0>, _: &SVector<f64, 0>, _: &SVector<f64, 0>, _: &mut [Wrench]) {
    }
}
