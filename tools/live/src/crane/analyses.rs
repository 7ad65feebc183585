//! Accelerations, statics, small motions, internal forces and derivatives of a live crane.

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{
    DynDerivatives, DynDynamics, DynInternalForces, DynLinearise, DynMotionDerivatives, DynStatics,
};
use crane_model::nalgebra::Matrix4;
use crane_model::{entry_type, slice_argument};
use crane_quantities::quantities;

use super::methods::{method, methods};
use super::{LiveCrane, at, copy};
use crate::machine::Arguments;
use crate::rows::{Evaluation, Quantity, Rows};

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
        let mut evaluation = Evaluation::<f64>::new(self, Quantity::ForwardDynamicsDerivatives);
        evaluation.run(&Rows { t: &[t], q, v, ..Rows::default() }, 0..1, out);
    }

    quantities! { methods of MotionDerivatives }
}
