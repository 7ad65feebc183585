//! What a motion requires, and derivatives.

use super::Derivation;
use crate::chain::{Chain, Loops};
use crate::mechanics::columns::columns;
use crate::mechanics::mass_factors::mass_factors;
use crate::mechanics::{drives, motion_derivatives, points};
use crate::program::{Function, FunctionId};

impl Derivation<'_> {
    /// Derivatives of the points, the generalized forces that a motion requires, and their derivatives, unless there are too many of them.
    pub(super) fn motion_derivatives(&self) -> Vec<Function> {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let mut functions = Vec::new();
        if !model.chain.points.is_empty() {
            functions.push(self.function(FunctionId::PointJacobians, points::jacobians(model, kinematics)));
        }
        let (required, trace) = self.inverse_dynamics();
        functions.push(self.function(FunctionId::InverseDynamics, required).by(trace));
        if model.size() > Chain::MOST_COORDINATES_OF_DERIVATIVES {
            return functions;
        }
        let slopes = motion_derivatives::of_forces(model, &self.forces().all());
        if model.chain.loops == Loops::Never {
            // The runtime makes them of the factors, in loops.
            let derivatives = motion_derivatives::of_residual(model, kinematics, &self.inertias, &slopes);
            functions.push(self.function(FunctionId::DynamicResidualDerivatives, derivatives));
        }
        let is_prescribed: Vec<_> = drives::accelerations(model).iter().map(Option::is_some).collect();
        let (mass, trace) =
            model.graph.recorded(|| mass_factors(model, &self.factors, &columns(model, &self.factors), &is_prescribed));
        let of_residual = motion_derivatives::factors_of_residual(model, kinematics, &self.inertias);
        functions.extend([
            self.function(FunctionId::MassFactors, mass).by(trace),
            self.function(FunctionId::ResidualFactors, of_residual),
            self.function(FunctionId::ForceDerivatives, slopes),
        ]);
        functions
    }
}
