//! What is derived together.

/// Functions that are derived together, because they share most of their expressions. An analysis of a spec requests one or several of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// Poses, forces, loops, energies: what every crane has.
    Common,
    /// Equations of motion.
    Dynamics,
    /// Systems of implicit steps, and their residual.
    Systems,
    /// Stiffness and damping of implicit steps.
    StepMatrices,
    /// Equilibria.
    Statics,
    /// Small motions.
    Modes,
    /// What joints and sections transmit.
    InternalForces,
    /// Derivatives of transforms.
    Derivatives,
    /// Derivatives of the dynamics.
    MotionDerivatives,
}

impl Part {
    /// All of them, in the order of the table.
    pub const ALL: [Part; 9] = [
        Part::Common,
        Part::Dynamics,
        Part::Systems,
        Part::StepMatrices,
        Part::Statics,
        Part::Modes,
        Part::InternalForces,
        Part::Derivatives,
        Part::MotionDerivatives,
    ];

    /// Whether it is one of these.
    #[must_use]
    pub const fn is_in(self, parts: &[Part]) -> bool {
        let mut index = 0;
        while index < parts.len() {
            if parts[index] as u8 == self as u8 {
                return true;
            }
            index += 1;
        }
        false
    }

    /// In a constant: stops the build, with what to add to the spec, unless it is one of the parts of a crane.
    ///
    /// # Panics
    /// If it is not one of them.
    pub const fn require(self, parts: &[Part]) {
        if self.is_in(parts) {
            return;
        }
        match self {
            Part::Common => panic!("the crane has no poses: `PARTS` of every crane contains `Part::Common`"),
            Part::Dynamics | Part::Systems | Part::StepMatrices => {
                panic!("the crane has no dynamics: add `dynamics` to `analyses` of its spec")
            }
            Part::Statics => panic!("the crane has no statics: add `statics` to `analyses` of its spec"),
            Part::Modes => panic!("the crane has no modes: add `modes` to `analyses` of its spec"),
            Part::InternalForces => {
                panic!("the crane has no internal forces: add `internal_forces` to `analyses` of its spec")
            }
            Part::Derivatives => panic!("the crane has no derivatives: add `derivatives` to `analyses` of its spec"),
            Part::MotionDerivatives => {
                panic!("the crane has no derivatives of motions: add `motion_derivatives` to `analyses` of its spec")
            }
        }
    }
}
