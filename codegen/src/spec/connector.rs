//! Connectors: elements between two points.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Angle, Given, Motion, Number, Vector};

/// A spring, gas spring or rope between two points, which pulls or pushes them along the line between them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `name`, `from`, `to` and `law`")]
pub struct Connector {
    /// Name, a `snake_case` identifier.
    pub name: Given<String>,
    /// One of its points.
    pub from: Given<Attachment>,
    /// The other.
    pub to: Given<Attachment>,
    /// The law of its force; exactly one.
    pub law: Given<ConnectorLaw>,
}

/// A point of a link, or of the world.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `link` and `at`")]
pub struct Attachment {
    /// The link. Default: the world.
    pub link: Option<Given<String>>,
    /// Position in the frame of the link (of a beam: undeformed) or of the world, m.
    pub at: Given<Vector>,
}

/// A coupling: one coordinate follows another through a spring and a damper.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `name`, `coordinate`, `follows`, `ratio` and `stiffness`")]
pub struct Coupling {
    /// Name, a `snake_case` identifier.
    pub name: Given<String>,
    /// The coordinate that follows.
    pub coordinate: Given<String>,
    /// The coordinate that leads.
    pub follows: Given<String>,
    /// How far the one moves per unit of the other: m, rad, m/rad or rad/m.
    pub ratio: Given<Number>,
    /// Where the one is while the other is at 0, m or rad. Default 0.
    pub offset: Option<Given<Angle>>,
    /// Stiffness, N/m or N m/rad, of the coordinate that follows.
    pub stiffness: Given<Number>,
    /// Damping, N s/m or N m s/rad. Default 0.
    pub damping: Option<Given<Number>>,
}

/// How the force of a connector depends on its length.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ConnectorLaw {
    /// A spring and a damper, which pull and push.
    Spring(PointSpring),
    /// A gas spring, which pushes.
    GasSpring(GasSpring),
    /// A rope, which pulls while it is taut.
    Rope(Rope),
}

/// A spring and a damper between two points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `stiffness`, `damping` and `length`")]
pub struct PointSpring {
    /// Stiffness, N/m.
    pub stiffness: Given<Number>,
    /// Damping, N s/m. Default 0.
    pub damping: Option<Given<Number>>,
    /// Length without force, m.
    pub length: Given<Number>,
}

/// A gas spring between two points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `force`, `length`, `stiffness` and `damping`")]
pub struct GasSpring {
    /// The force with which it pushes at `length`, N.
    pub force: Given<Number>,
    /// Length of the extended spring, m.
    pub length: Given<Number>,
    /// How much more it pushes per metre of compression, N/m. Default 0.
    pub stiffness: Option<Given<Number>>,
    /// Damping, N s/m. Default 0.
    pub damping: Option<Given<Number>>,
}

/// A rope between two points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `stiffness`, `damping` and `length` or `motion`")]
pub struct Rope {
    /// Stiffness EA/ℓ₀, N/m.
    pub stiffness: Given<Number>,
    /// Growth of the force with the rate of stretch, as a fraction per m/s. Default 0.
    pub damping: Option<Given<Number>>,
    /// Length without force, m.
    pub length: Option<Given<Number>>,
    /// Length without force over time, m, instead of `length`: a winch.
    pub motion: Option<Given<Motion>>,
}
