//! What acts within a joint besides its drive: end stops and friction.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Angle, Given, Number};

/// End stops of a joint, which push where it is beyond its range and never pull.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `min`, `max`, `stiffness` and `damping`")]
pub struct Stops {
    /// Least position, rad or m; no stop there unless it is given.
    pub min: Option<Given<Angle>>,
    /// Greatest position, rad or m; no stop there unless it is given.
    pub max: Option<Given<Angle>>,
    /// Stiffness of either stop, N m/rad or N/m.
    pub stiffness: Given<Number>,
    /// What a stop resists more on the way in than on the way out, by the rate: the force is `stiffness δ (1 + damping δ̇)`
    /// with δ the way beyond the stop; s/rad or s/m. Default 0.
    pub damping: Option<Given<Number>>,
}

/// Friction of a joint: Coulomb's, with Stribeck's decline where breaking away takes more.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `coulomb`, `breakaway`, `stribeck`, `width` and `viscous`")]
pub struct Friction {
    /// Friction while the joint moves, N m or N.
    pub coulomb: Given<Number>,
    /// Friction that breaking away takes, N m or N, at least `coulomb`. Default: as `coulomb`.
    pub breakaway: Option<Given<Number>>,
    /// Rate at which `breakaway` has declined towards `coulomb` by a factor of e, rad/s or m/s. Default 0.01.
    pub stribeck: Option<Given<Number>>,
    /// Rate at which friction has come to three quarters of its size, rad/s or m/s: below, the joint creeps. Default 0.001.
    pub width: Option<Given<Number>>,
    /// Viscous friction, N m s/rad or N s/m. Default 0.
    pub viscous: Option<Given<Number>>,
}
