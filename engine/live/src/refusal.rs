//! Functions whose results do not follow from time, pose and rates alone, or which closed loops change.

use crane_codegen::program::FunctionId;
use crane_model::{LoopJointInfo, dyn_crane::Functions};

use crate::LiveCrane;

/// Why a function of a state is not what a user asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal<'a> {
    /// Some forces have states of their own, which belong to a run.
    ForceStates,
    /// The crane has more than [`LiveCrane::MOST_COORDINATES_OF_DERIVATIVES`].
    TooLarge,
    /// The function is that of the open chain, and this joint closes a loop, or this coupling is rigid.
    Loop(&'a LoopJointInfo),
}

impl LiveCrane {
    /// Why a function of a state is not what a user asks for, if it is not.
    #[must_use]
    pub fn refusal(&self, function: FunctionId) -> Option<Refusal<'_>> {
        let description = self.description();
        if self.is_too_large_for(function) {
            return Some(Refusal::TooLarge);
        }
        let depends = match function {
            FunctionId::Linearise
            | FunctionId::ForwardDynamics
            | FunctionId::ForwardDynamicsDerivatives
            | FunctionId::DynamicResidual
            | FunctionId::DynamicResidualDerivatives
            | FunctionId::ForceDerivatives
            | FunctionId::Forces
            | FunctionId::DriveForces
            | FunctionId::DrivePower
            | FunctionId::Dissipation => description.has_hidden_forces(),
            FunctionId::InternalForces => description.has_valves(),
            FunctionId::FrictionForces => !description.bristles.is_empty(),
            _ => false,
        };
        if depends {
            return Some(Refusal::ForceStates);
        }
        let loops_matter = match function {
            FunctionId::Linearise | FunctionId::ForwardDynamicsDerivatives | FunctionId::InternalForces => true,
            FunctionId::Forces | FunctionId::DriveForces | FunctionId::DrivePower | FunctionId::DriveForcesAtRest => {
                !description.prescribed().is_empty()
            }
            _ => false,
        };
        self.loop_joints().first().filter(|_| loops_matter).map(Refusal::Loop)
    }
}
