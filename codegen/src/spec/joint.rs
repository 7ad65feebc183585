//! End stops and friction of joints.

use super::{Angle, Constant, Number, Spanned};
use crate::node::FromNode;

/// End stops of a joint, which push when it is beyond its range and never pull.
#[derive(Clone, Debug, FromNode)]
pub struct Stops {
    /// Minimum position, rad or m. Default: no stop.
    pub min: Option<Spanned<Angle>>,
    /// Maximum position, rad or m. Default: no stop.
    pub max: Option<Spanned<Angle>>,
    /// Stiffness of both stops, N m/rad or N/m.
    pub stiffness: Spanned<Number>,
    /// Damping of both stops per rate: the force is `stiffness δ (1 + damping δ̇)` with the penetration δ; s/rad or s/m.
    /// Default 0.
    pub damping: Option<Spanned<Number>>,
}

/// Friction of a joint: Coulomb friction, with a Stribeck decline from a larger breakaway friction.
#[derive(Clone, Debug, FromNode)]
pub struct Friction {
    /// Coulomb friction, N m or N.
    pub coulomb: Spanned<Number>,
    /// Breakaway friction, N m or N, at least `coulomb`. Default: equal to `coulomb`.
    pub breakaway: Option<Spanned<Number>>,
    /// Rate at which `breakaway` has declined towards `coulomb` by a factor of e, rad/s or m/s. Default 0.01.
    pub stribeck: Option<Spanned<Number>>,
    /// Rate at which friction reaches three quarters of its full value, rad/s or m/s; below it, the joint creeps. Default 0.001.
    pub width: Option<Spanned<Number>>,
    /// Viscous friction, N m s/rad or N s/m. Default 0.
    pub viscous: Option<Spanned<Number>>,
    /// Bristles that bend before the joint slides, so that it sticks without creeping (the model of Canudas de Wit and others), instead of `width`. Default: none.
    pub bristle: Option<Spanned<Bristle>>,
}

/// The bristles of a joint that sticks; their deflection is a state of the motion.
#[derive(Clone, Debug, FromNode)]
pub struct Bristle {
    /// Stiffness σ₀, N m/rad or N/m.
    pub stiffness: Spanned<Constant>,
    /// Damping σ₁, N m s/rad or N s/m.
    pub damping: Spanned<Constant>,
}
