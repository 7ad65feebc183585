//! What to compute, and the settings of a run.

use crane_quantities::Part;

/// Settings of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Simulated time, s.
    pub duration: f64,
    /// Step of the integrator, s.
    pub step: f64,
    /// Interval of the recorded results, s.
    pub output: f64,
}

/// What to compute: a set of independent choices.
#[allow(clippy::struct_excessive_bools)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Analyses {
    /// Static residual and tangent stiffness.
    pub statics: bool,
    /// Mass matrix, bias, kinetic energy and power.
    pub dynamics: bool,
    /// Linearisation: A, K and D at a pose.
    pub modes: bool,
    /// Forces and moments that joints, beam sections and the ground transmit.
    pub internal_forces: bool,
    /// ∂T/∂q and ∂²T/∂q∂q of every body.
    pub derivatives: bool,
    /// Residual of the equations of motion with its derivatives, derivatives of accelerations and of points.
    pub motion_derivatives: bool,
    /// Eight cranes per call, for simulations of many cranes; needs dynamics.
    pub ensemble: bool,
}

impl Analyses {
    /// The analyses that the command needs.
    pub const COMMAND: Analyses = Analyses { derivatives: false, motion_derivatives: false, ..Analyses::ALL };
    /// All analyses of one crane, for checks.
    pub const ALL: Analyses = Analyses {
        statics: true,
        dynamics: true,
        modes: true,
        internal_forces: true,
        derivatives: true,
        motion_derivatives: true,
        ensemble: false,
    };

    /// Whether they request a part.
    #[must_use]
    pub const fn request(self, part: Part) -> bool {
        match part {
            Part::Common => true,
            Part::Dynamics | Part::Systems | Part::StepMatrices => self.dynamics,
            Part::Statics => self.statics,
            Part::Modes => self.modes,
            Part::InternalForces => self.internal_forces,
            Part::Derivatives => self.derivatives,
            Part::MotionDerivatives => self.motion_derivatives,
        }
    }
}
