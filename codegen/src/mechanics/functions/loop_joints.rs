//! Joints that close loops, and exact couplings.

use super::Derivation;
use crate::mechanics::loop_joints::LoopEquations;
use crate::mechanics::{loop_joints, newton_euler};
use crate::program::{Function, FunctionId};
use crate::symbolic::{Expr, SweepTrace};

impl<'g> Derivation<'g> {
    /// Accelerations of the open chain, and what closes its loops; the sweeps share the articulated inertias.
    pub(super) fn loop_dynamics(&self, accelerations: &[Expr<'g>], trace: &SweepTrace) -> Option<Function> {
        let model = &self.model;
        let (n, zero) = (model.size(), model.zero());
        let LoopEquations { states, rows } = self.loop_equations();
        let mut curvatures: Vec<_> = states.iter().copied().skip(2).step_by(3).collect();
        if curvatures.is_empty() {
            return None;
        }
        curvatures.resize(curvatures.len().next_multiple_of(n), zero);
        let responses = rows.chunks(n).flat_map(|row| self.response(row));
        let outputs = accelerations.iter().copied().chain(curvatures).chain(rows.iter().copied()).chain(responses);
        Some(self.function(FunctionId::LoopDynamics, outputs.collect()).by(trace.clone()))
    }

    /// The equations of loop joints and exact couplings, and their derivatives.
    pub(super) fn loop_joints(&self) -> Vec<Function> {
        if !self.model.chain.has_loops() {
            return Vec::new();
        }
        let LoopEquations { states, rows } = self.loop_equations();
        vec![
            self.function(FunctionId::LoopStates, states.clone()),
            self.function(FunctionId::LoopJacobians, rows.clone()),
        ]
    }

    /// Derived once for all functions.
    fn loop_equations(&self) -> &LoopEquations<'g> {
        self.loops.get_or_init(|| LoopEquations::new(&self.model))
    }

    /// What loop joints contribute to the internal forces, for a unit force or moment of each equation. Couplings act along joints, whose
    /// internal forces include them as they do those of drives.
    pub(super) fn loop_wrenches(&self) -> Function {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let joints = &model.chain.loop_joints;
        let of_joints = joints.iter().flat_map(|joint| loop_joints::actions(model, kinematics, joint));
        let of_equations = of_joints.chain(model.chain.rigid_couplings.iter().map(|_| Vec::new()));
        let wrenches =
            of_equations.flat_map(|actions| newton_euler::transmitted(model, kinematics, &self.factors, actions));
        let wrenches: Vec<_> = wrenches.collect();
        self.function(FunctionId::LoopWrenches, wrenches)
    }
}
