//! Accelerations, statics, small motions, internal forces and derivatives of a live crane.

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{
    DynDerivatives, DynDynamics, DynImplicit, DynInternalForces, DynLinearise, DynMotionDerivatives, DynStatics,
};
use crane_model::nalgebra::{Matrix4, Matrix6};
use crane_model::{entry_type, slice_argument};
use crane_quantities::quantities;

use super::methods::{method, methods};
use super::{LiveCrane, at, copy};
use crate::derivatives::derivatives_of_accelerations;
use crate::machine::Arguments;

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
    fn forward_dynamics_derivatives(&self, t: f64, q: &[f64], v: &[f64], out: &mut [f64]) {
        let n = q.len();
        let mut a = vec![0.0; n];
        self.forward_dynamics(t, q, v, &mut a);
        self.dynamic_residual_derivatives(t, q, v, &a, &mut out[..2 * n * n]);
        let mut system = self.system();
        system.factorise(q, &vec![0.0; n], &Matrix6::zeros());
        let solve = |right: &[f64], solution: &mut [f64]| system.solve(right, solution);
        derivatives_of_accelerations(n, &self.description.prescribed(), out, solve);
    }

    quantities! { methods of MotionDerivatives }
}
