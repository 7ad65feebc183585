//! Joints that close loops.

use super::{Derivation, function};
use crate::mechanics::{loop_joints, newton_euler};
use crate::program::Argument::{Position, Velocity};
use crate::program::{Function, FunctionId, Shape, Struct};

impl Derivation<'_> {
    /// The equations of loop joints and their derivatives.
    pub(super) fn loop_joints(&self) -> Vec<Function> {
        let model = &self.model;
        let count = model.chain.loop_equations().count();
        if count == 0 {
            return Vec::new();
        }
        vec![
            function(
                FunctionId::LoopStates,
                "Every equation of the loop joints: its gap φ (m, and 1 for the direction of a pin), the rate of φ, and the part of its second \
                 rate that does not depend on accelerations.",
                "φ, J q̇, J̇ q̇",
                &[Position, Velocity],
                Shape::Vectors(count),
                loop_joints::states(model),
            ),
            function(
                FunctionId::LoopJacobians,
                "How the gaps of the loop joints change with the coordinates, one row per equation.",
                "J = ∂φ/∂q",
                &[Position],
                Shape::Rows { count, n: model.size() },
                loop_joints::jacobians(model),
            ),
        ]
    }

    /// What loop joints contribute to the internal forces, for a unit force or moment of each equation.
    pub(super) fn loop_wrenches(&self) -> Function {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let joints = &model.chain.loop_joints;
        let of_equations = joints.iter().flat_map(|joint| loop_joints::actions(model, kinematics, joint));
        let wrenches =
            of_equations.flat_map(|actions| newton_euler::transmitted(model, kinematics, &self.factors, actions));
        let wrenches: Vec<_> = wrenches.collect();
        function(
            FunctionId::LoopWrenches,
            "Force (1) and moment (m) at every cut, cut by cut, due to each equation of the loop joints while it transmits 1 N or 1 N m.",
            "Σ g, Σ r × g over everything beyond",
            &[Position],
            Shape::Structs(Struct::Wrench, wrenches.len() / Struct::Wrench.len()),
            wrenches,
        )
    }
}
