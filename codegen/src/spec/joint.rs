//! End stops and friction of joints.

use super::{Angle, Constant, Number, Spanned};
use crate::node::FromNode;

/// End stops of a joint, which push when it is beyond its range and never pull.
#[derive(Clone, Debug, FromNode)]
pub struct Stops {
    /// Minimum position. Default: no stop.
    #[key(unit = "rad or m")]
    pub min: Option<Spanned<Angle>>,
    /// Maximum position. Default: no stop.
    #[key(unit = "rad or m")]
    pub max: Option<Spanned<Angle>>,
    /// Stiffness of both stops.
    #[key(unit = "N m/rad or N/m", limit = Positive)]
    pub stiffness: Spanned<Number>,
    /// Damping of both stops per rate: the force is `stiffness δ (1 + damping δ̇)` with the penetration δ.
    /// Default 0.
    #[key(unit = "s/rad or s/m", limit = NotNegative)]
    pub damping: Option<Spanned<Number>>,
}

/// Friction of a joint: Coulomb friction, with a Stribeck decline from a larger breakaway friction.
#[derive(Clone, Debug, FromNode)]
pub struct Friction {
    /// Coulomb friction.
    #[key(unit = "N m or N", limit = NotNegative)]
    pub coulomb: Spanned<Number>,
    /// Breakaway friction, at least `coulomb`. Default: equal to `coulomb`.
    #[key(unit = "N m or N", limit = NotNegative)]
    pub breakaway: Option<Spanned<Number>>,
    /// Rate at which `breakaway` has declined towards `coulomb` by a factor of e. Default 0.01.
    #[key(unit = "rad/s or m/s", limit = Positive, usual = 0.0..5.0)]
    pub stribeck: Option<Spanned<Number>>,
    /// Rate at which friction reaches three quarters of its full value; below it, the joint creeps. Default 0.001.
    #[key(unit = "rad/s or m/s", limit = Positive, usual = 0.0..1.0)]
    pub width: Option<Spanned<Number>>,
    /// Viscous friction. Default 0.
    #[key(unit = "N m s/rad or N s/m", limit = NotNegative)]
    pub viscous: Option<Spanned<Number>>,
    /// Bristles that bend before the joint slides, so that it sticks without creeping (the model of Canudas de Wit and others), instead of `width`. Default: none.
    pub bristle: Option<Spanned<Bristle>>,
}

/// The bristles of a joint that sticks; their deflection is a state of the motion.
#[derive(Clone, Debug, FromNode)]
pub struct Bristle {
    /// Stiffness σ₀.
    #[key(unit = "N m/rad or N/m", limit = Positive)]
    pub stiffness: Spanned<Constant>,
    /// Damping σ₁.
    #[key(unit = "N m s/rad or N s/m", limit = NotNegative)]
    pub damping: Spanned<Constant>,
}
