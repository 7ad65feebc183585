//! The functions that a crane may have.

/// Writes the list once: as an enumeration, with the name and the trait of each.
macro_rules! functions {
    ($($runtime_trait:ident { $($id:ident = $name:literal,)* })*) => {
        /// A function of a crane, named after the method of the runtime that calls it; documentation and equation are given where it
        /// is derived, see [`Function`](super::Function).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "the methods are documented")]
        pub enum FunctionId {
            $($($id,)*)*
        }

        impl FunctionId {
            /// All of them, trait by trait.
            pub const ALL: &[FunctionId] = &[$($(FunctionId::$id,)*)*];

            /// Its name in generated code, an identifier.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $($(FunctionId::$id => $name,)*)*
                }
            }

            /// The trait of the runtime that has it as a method.
            #[must_use]
            pub const fn runtime_trait(self) -> RuntimeTrait {
                match self {
                    $($(FunctionId::$id => RuntimeTrait::$runtime_trait,)*)*
                }
            }
        }

        /// A trait of the runtime that generated functions implement.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "the traits are documented")]
        pub enum RuntimeTrait {
            $($runtime_trait,)*
        }

        impl RuntimeTrait {
            /// All of them.
            pub const ALL: &[RuntimeTrait] = &[$(RuntimeTrait::$runtime_trait,)*];

            /// The name of the trait.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(RuntimeTrait::$runtime_trait => stringify!($runtime_trait),)*
                }
            }

            /// Its functions, in the order of their methods.
            pub fn functions(self) -> impl Iterator<Item = FunctionId> {
                FunctionId::ALL.iter().copied().filter(move |id| id.runtime_trait() == self)
            }
        }
    };
}

functions! {
    CraneModel {
        Transforms = "transforms",
        Points = "points",
        PointVelocities = "point_velocities",
        Forces = "forces",
        SupportForces = "support_forces",
        ElementForces = "element_forces",
        DriveForces = "drive_forces",
        JointDamperForces = "joint_damper_forces",
        StopForces = "stop_forces",
        FrictionForces = "friction_forces",
        LoadForces = "load_forces",
        LoadPieces = "load_pieces",
        ConnectorForces = "connector_forces",
        ConnectorLengths = "connector_lengths",
        ConnectorTensions = "connector_tensions",
        ConnectorJacobians = "connector_jacobians",
        WinchPieces = "winch_pieces",
        LoopStates = "loop_states",
        LoopJacobians = "loop_jacobians",
        SupportReactions = "support_reactions",
        SupportGaps = "support_gaps",
        CylinderStates = "cylinder_states",
        CylinderJacobians = "cylinder_jacobians",
        DriveMotions = "drive_motions",
        ValveOpenings = "valve_openings",
        DriveLimits = "drive_limits",
        PrescribedMotions = "prescribed_motions",
        DrivePieces = "drive_pieces",
        GravityEnergy = "gravity_energy",
        SupportEnergy = "support_energy",
        ElementEnergy = "element_energy",
        DriveEnergy = "drive_energy",
        StopEnergy = "stop_energy",
        ConnectorEnergy = "connector_energy",
        DrivePower = "drive_power",
        LoadPower = "load_power",
        WinchPower = "winch_power",
        Dissipation = "dissipation",
    }
    Dynamics {
        ForwardDynamics = "forward_dynamics",
        SolveMass = "solve_mass",
        MassMatrix = "mass_matrix",
        MassMatrixAndBias = "mass_matrix_and_bias",
        Bias = "bias",
        KineticEnergy = "kinetic_energy",
    }
    Implicit {
        Factorise = "factorise",
        Solve = "solve",
        JointStiffnessAndDamping = "joint_stiffness_and_damping",
        NonlinearStiffnessAndDamping = "nonlinear_stiffness_and_damping",
        BaseStiffness = "base_stiffness",
        BaseDamping = "base_damping",
    }
    Statics {
        StaticResidual = "static_residual",
        TangentStiffness = "tangent_stiffness",
        DriveForcesAtRest = "drive_forces_at_rest",
    }
    Linearise {
        Linearise = "linearise",
    }
    InternalForces {
        InternalForces = "internal_forces",
        CylinderWrenches = "cylinder_wrenches",
        ConnectorWrenches = "connector_wrenches",
        LoopWrenches = "loop_wrenches",
        SupportPositions = "support_positions",
        SectionModuli = "section_moduli",
    }
    TransformDerivatives {
        TransformDerivatives = "transform_derivatives",
        TransformSecondDerivatives = "transform_second_derivatives",
    }
}

impl FunctionId {
    /// How many there are.
    pub const COUNT: usize = FunctionId::ALL.len();

    /// The function of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|id| id.name() == name)
    }
}
