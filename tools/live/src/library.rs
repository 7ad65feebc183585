//! The functions of a crane, derived and assembled when one of their kind is first asked for.

use std::sync::OnceLock;

use crane_codegen::chain::{Analyses, Chain};
use crane_codegen::mechanics;

use crate::routine::Routine;

/// A function of the compiler that a crane calls, named as the method of [`crane_model::dyn_crane`] that calls it.
#[expect(missing_docs, reason = "the methods are documented")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Name {
    Transforms,
    Points,
    PointVelocities,
    Forces,
    ElementForces,
    DriveForces,
    StopForces,
    FrictionForces,
    SupportReactions,
    DriveMotions,
    DrivePieces,
    PrescribedMotions,
    GravityEnergy,
    SupportEnergy,
    ElementEnergy,
    DriveEnergy,
    StopEnergy,
    DrivePower,
    Dissipation,
    StaticResidual,
    TangentStiffness,
    DriveForcesAtRest,
    MassMatrix,
    Bias,
    ForwardDynamics,
    KineticEnergy,
    Factorise,
    Solve,
    JointImpedances,
    NonlinearImpedances,
    BaseStiffness,
    BaseDamping,
    Linearise,
    InternalForces,
    SupportPositions,
    SectionModuli,
    TransformDerivatives,
    TransformSecondDerivatives,
}

/// Functions that are derived together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Poses, forces, energies: what every crane has.
    Common,
    /// Equations of motion.
    Dynamics,
    /// Equilibria.
    Statics,
    /// Small motions.
    Modes,
    /// What joints and sections transmit.
    InternalForces,
    /// Derivatives of transforms.
    Derivatives,
}

impl Name {
    /// All of them, in the order of their declaration.
    pub const ALL: [Name; 38] = [
        Name::Transforms,
        Name::Points,
        Name::PointVelocities,
        Name::Forces,
        Name::ElementForces,
        Name::DriveForces,
        Name::StopForces,
        Name::FrictionForces,
        Name::SupportReactions,
        Name::DriveMotions,
        Name::DrivePieces,
        Name::PrescribedMotions,
        Name::GravityEnergy,
        Name::SupportEnergy,
        Name::ElementEnergy,
        Name::DriveEnergy,
        Name::StopEnergy,
        Name::DrivePower,
        Name::Dissipation,
        Name::StaticResidual,
        Name::TangentStiffness,
        Name::DriveForcesAtRest,
        Name::MassMatrix,
        Name::Bias,
        Name::ForwardDynamics,
        Name::KineticEnergy,
        Name::Factorise,
        Name::Solve,
        Name::JointImpedances,
        Name::NonlinearImpedances,
        Name::BaseStiffness,
        Name::BaseDamping,
        Name::Linearise,
        Name::InternalForces,
        Name::SupportPositions,
        Name::SectionModuli,
        Name::TransformDerivatives,
        Name::TransformSecondDerivatives,
    ];

    /// The name that the compiler gives it, and with what it is derived.
    pub(crate) fn describe(self) -> (&'static str, Group) {
        use Group::{Common, Derivatives, Dynamics, InternalForces, Modes, Statics};
        match self {
            Name::Transforms => ("transforms", Common),
            Name::Points => ("points", Common),
            Name::PointVelocities => ("point_velocities", Common),
            Name::Forces => ("forces", Common),
            Name::ElementForces => ("element_forces", Common),
            Name::DriveForces => ("drive_forces", Common),
            Name::StopForces => ("stop_forces", Common),
            Name::FrictionForces => ("friction_forces", Common),
            Name::SupportReactions => ("support_reactions", Common),
            Name::DriveMotions => ("drive_motions", Common),
            Name::DrivePieces => ("drive_pieces", Common),
            Name::PrescribedMotions => ("prescribed_motions", Common),
            Name::GravityEnergy => ("gravity_energy", Common),
            Name::SupportEnergy => ("support_energy", Common),
            Name::ElementEnergy => ("element_energy", Common),
            Name::DriveEnergy => ("drive_energy", Common),
            Name::StopEnergy => ("stop_energy", Common),
            Name::DrivePower => ("drive_power", Common),
            Name::Dissipation => ("dissipation", Common),
            Name::StaticResidual => ("static_residual", Statics),
            Name::TangentStiffness => ("tangent_stiffness", Statics),
            Name::DriveForcesAtRest => ("drive_forces_at_rest", Statics),
            Name::MassMatrix => ("mass_matrix", Dynamics),
            Name::Bias => ("bias", Dynamics),
            Name::ForwardDynamics => ("forward_dynamics", Dynamics),
            Name::KineticEnergy => ("kinetic_energy", Dynamics),
            Name::Factorise => ("factorise", Dynamics),
            Name::Solve => ("solve", Dynamics),
            Name::JointImpedances => ("joint_impedances", Dynamics),
            Name::NonlinearImpedances => ("nonlinear_impedances", Dynamics),
            Name::BaseStiffness => ("base_stiffness", Dynamics),
            Name::BaseDamping => ("base_damping", Dynamics),
            Name::Linearise => ("linearise", Modes),
            Name::InternalForces => ("internal_forces", InternalForces),
            Name::SupportPositions => ("support_positions", InternalForces),
            Name::SectionModuli => ("section_moduli", InternalForces),
            Name::TransformDerivatives => ("transform_derivatives", Derivatives),
            Name::TransformSecondDerivatives => ("transform_second_derivatives", Derivatives),
        }
    }
}

impl Group {
    const COUNT: usize = 6;

    /// What the compiler is asked for.
    fn analyses(self) -> Analyses {
        let nothing = Analyses {
            statics: false,
            dynamics: false,
            modes: false,
            internal_forces: false,
            derivatives: false,
            ensemble: false,
        };
        match self {
            Group::Common => nothing,
            Group::Dynamics => Analyses { dynamics: true, ..nothing },
            Group::Statics => Analyses { statics: true, ..nothing },
            Group::Modes => Analyses { modes: true, ..nothing },
            Group::InternalForces => Analyses { internal_forces: true, ..nothing },
            Group::Derivatives => Analyses { derivatives: true, ..nothing },
        }
    }
}

/// The functions of a chain.
#[derive(Debug)]
pub struct Library {
    chain: Chain,
    groups: [OnceLock<Vec<Option<Routine>>>; Group::COUNT],
}

impl Library {
    /// The functions of a chain, none of them derived.
    pub fn new(chain: Chain) -> Self {
        Self { chain, groups: Default::default() }
    }

    /// The chain.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// A function; `None` where the scene does not need it.
    pub fn routine(&self, name: Name) -> Option<&Routine> {
        let (_, group) = name.describe();
        let routines = self.groups[group as usize].get_or_init(|| self.assemble(group));
        routines.get(name as usize)?.as_ref()
    }

    /// The functions of a group, by their places among all.
    fn assemble(&self, group: Group) -> Vec<Option<Routine>> {
        let program = mechanics::derive(&self.chain, group.analyses());
        let routine = |name: Name| {
            let (word, own) = name.describe();
            let function = program.function(word).filter(|_| own == group)?;
            Routine::new(&program, function).ok()
        };
        Name::ALL.into_iter().map(routine).collect()
    }
}
