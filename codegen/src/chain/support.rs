//! Supports of the base.

use super::Value;

/// A support of the base: three springs and dampers along the world's axes, Eqs. (16)–(18).
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// Name.
    pub name: String,
    /// Attachment point in the frame of the first body, m.
    pub position: [Value; 3],
    /// Stiffness along x, y, z, N/m.
    pub stiffness: [Value; 3],
    /// Damping along x, y, z, N s/m.
    pub damping: [Value; 3],
    /// Free play δ along x, y, z, m.
    pub free_play: [Value; 3],
    /// For a one-sided support, which presses and never pulls: its coefficient of friction on the ground, μ. `None` if it pulls
    /// as well.
    pub friction: Option<Value>,
    /// How its elongation depends on the base's coordinates.
    pub kinematics: SupportKinematics,
    /// The area of the plate under it, m², and the largest pressure that the ground bears, Pa; they have no mechanical effect.
    pub plate: Option<(f64, Option<f64>)>,
}

/// How the elongation of a support depends on the base's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupportKinematics {
    /// `e = U q̃(1) − δ`, Eq. (16): small rotations.
    Linear,
    /// `e = T(1) r_E − r_E0 − δ`, `r_E0` its position at q̃(1) = 0: any rotation.
    Exact,
}
