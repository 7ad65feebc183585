//! Accelerations, statics, small motions, internal forces and derivatives of a live crane.

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{
    DynDerivatives, DynDynamics, DynInternalForces, DynLinearise, DynMotionDerivatives, DynStatics,
};
use crane_model::nalgebra::Matrix4;
use crane_model::rt::derivatives::EightColumns;
use crane_model::{entry_type, slice_argument};
use crane_quantities::{Count, quantities};

use super::methods::{method, methods};
use super::{LiveCrane, at, copy};
use crate::derivatives::Storage;
use crate::machine::Arguments;
use crate::routine::Routine;

impl DynStatics for LiveCrane {
    quantities! { methods of Statics }
}

impl DynDynamics for LiveCrane {
    quantities! { methods of Dynamics }
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

impl DynInternalForces for LiveCrane {
    quantities! { methods of InternalForces }
}

impl DynDerivatives for LiveCrane {
    quantities! { methods of TransformDerivatives }
}

impl DynMotionDerivatives for LiveCrane {
    fn dynamic_residual_derivatives(&self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut [f64]) {
        let mut factors = vec![0.0; Count::RESIDUAL_FACTORS * q.len()];
        self.residual_factors(q, v, a, &mut factors);
        self.force_derivatives(t, q, v, out);
        Storage::<EightColumns>::new(self.links()).residual_derivatives(&factors, out);
    }

    fn inverse_mass_matrix(&self, q: &[f64], out: &mut [f64]) {
        let mut factors = vec![0.0; Count::MASS_FACTORS * q.len()];
        self.mass_factors(q, &mut factors);
        Storage::<EightColumns>::new(self.links()).inverse_mass_matrix(&factors, out);
    }

    fn forward_dynamics_derivatives(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        let n = q.len();
        let mut a = vec![0.0; n];
        self.forward_dynamics(t, q, v, &mut a);
        let [mut of_residual, mut of_mass] =
            [Count::RESIDUAL_FACTORS, Count::MASS_FACTORS].map(|count| vec![0.0; count * n]);
        self.residual_factors(q, v, &a, &mut of_residual);
        self.mass_factors(q, &mut of_mass);
        let mut forces = vec![0.0; 2 * n * n];
        self.force_derivatives(t, q, v, &mut forces);
        let library = self.library();
        let places = library.routine(FunctionId::ForceDerivatives).map_or(&[][..], Routine::places);
        let factors = [&*of_residual, &of_mass];
        Storage::<EightColumns>::new(self.links()).forward_dynamics_derivatives(factors, (&forces, places), out);
    }

    quantities! { methods of MotionDerivatives }
}
