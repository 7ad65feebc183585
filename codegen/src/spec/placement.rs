//! Where a link sits on the one before.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Angle, Given, Many, Number, Vector};

/// Where a link sits on the one before (after a beam: on its tip), exactly one of these.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Placement {
    /// A row of modified (Craig's) D-H parameters, `Rx(alpha) Tx(a) Rz(theta) Tz(d)`; the joint adds to theta or d.
    ModifiedDh(ModifiedDh),
    /// A row of classic D-H parameters, `Rz(theta) Tz(d) Tx(a) Rx(alpha)`; the joint adds to theta or d, so the link's
    /// frame is at the far end.
    ClassicDh(ClassicDh),
    /// A constant translation, then rotations; the joint comes after.
    Transform(Transform),
}

/// Modified D-H parameters.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `a`, `alpha`, `d`, `theta`")]
pub struct ModifiedDh {
    /// Link length, along x of the frame before, m. Default 0.
    pub a: Option<Given<Number>>,
    /// Link twist, about x of the frame before, rad. Default 0.
    pub alpha: Option<Given<Angle>>,
    /// Offset along z, m; where the travel of a prismatic joint starts. Default 0.
    pub d: Option<Given<Number>>,
    /// Angle about z, rad; where the turn of a revolute joint starts. Default 0.
    pub theta: Option<Given<Angle>>,
}

/// Classic D-H parameters.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `a`, `alpha`, `d`, `theta`")]
pub struct ClassicDh {
    /// Link length, along x of this frame, m. Default 0.
    pub a: Option<Given<Number>>,
    /// Link twist, about x of this frame, rad. Default 0.
    pub alpha: Option<Given<Angle>>,
    /// Offset along z of the frame before, m; where the travel of a prismatic joint starts. Default 0.
    pub d: Option<Given<Number>>,
    /// Angle about z of the frame before, rad; where the turn of a revolute joint starts. Default 0.
    pub theta: Option<Given<Angle>>,
}

/// A constant transformation.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `translation` and `rotation`")]
pub struct Transform {
    /// Translation in the frame before, m. Default `[0, 0, 0]`.
    pub translation: Option<Given<Vector>>,
    /// Rotation `{x: angle}`, `{y: angle}` or `{z: angle}`, or a list of such, each about the axes that the one before
    /// has turned. Default none.
    pub rotation: Option<Given<Many<Turn>>>,
}

/// A rotation about one axis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Turn {
    /// About x, rad.
    X(Given<Angle>),
    /// About y, rad.
    Y(Given<Angle>),
    /// About z, rad.
    Z(Given<Angle>),
}

/// Name of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AxisName {
    /// First axis.
    X,
    /// Second axis.
    Y,
    /// Third axis.
    Z,
}
