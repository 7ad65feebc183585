//! End stops and friction of joints.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Angle, Constant, Given, Number};

/// End stops of a joint, which push when it is beyond its range and never pull.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `min`, `max`, `stiffness` and `damping`")]
pub struct Stops {
    /// Minimum position, rad or m. Default: no stop.
    pub min: Option<Given<Angle>>,
    /// Maximum position, rad or m. Default: no stop.
    pub max: Option<Given<Angle>>,
    /// Stiffness of both stops, N m/rad or N/m.
    pub stiffness: Given<Number>,
    /// Damping of both stops per rate: the force is `stiffness δ (1 + damping δ̇)` with the penetration δ; s/rad or s/m.
    /// Default 0.
    pub damping: Option<Given<Number>>,
}

/// Friction of a joint: Coulomb friction, with a Stribeck decline from a larger breakaway friction.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(
    deny_unknown_fields,
    expecting = "a mapping of `coulomb`, `breakaway`, `stribeck`, `width`, `viscous` and `bristle`"
)]
pub struct Friction {
    /// Coulomb friction, N m or N.
    pub coulomb: Given<Number>,
    /// Breakaway friction, N m or N, at least `coulomb`. Default: as `coulomb`.
    pub breakaway: Option<Given<Number>>,
    /// Rate at which `breakaway` has declined towards `coulomb` by a factor of e, rad/s or m/s. Default 0.01.
    pub stribeck: Option<Given<Number>>,
    /// Rate at which friction reaches three quarters of its full value, rad/s or m/s; below it, the joint creeps. Default 0.001.
    pub width: Option<Given<Number>>,
    /// Viscous friction, N m s/rad or N s/m. Default 0.
    pub viscous: Option<Given<Number>>,
    /// Bristles that bend before the joint slides, so that it sticks without creeping (the model of Canudas de Wit and others), instead of `width`. Default: none.
    pub bristle: Option<Given<Bristle>>,
}

/// The bristles of a joint that sticks; their deflection is a state of the motion.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `stiffness` and `damping`")]
pub struct Bristle {
    /// Stiffness σ₀, N m/rad or N/m.
    pub stiffness: Given<Constant>,
    /// Damping σ₁, N m s/rad or N s/m.
    pub damping: Given<Constant>,
}
