//! Poses of links relative to what they are attached to.

use super::{Angle, Many, Number, Spanned, Vector};
use crate::node::FromNode;

/// Pose of a link relative to the link and the place that it is attached to (after a beam: to its tip), exactly one of these.
#[derive(Clone, Debug, FromNode)]
pub enum Placement {
    /// A row of modified (Craig's) D-H parameters, `Rx(alpha) Tx(a) Rz(theta) Tz(d)`; the joint adds to theta or d.
    ModifiedDh(ModifiedDh),
    /// A row of classic D-H parameters, `Rz(theta) Tz(d) Tx(a) Rx(alpha)`; the joint adds to theta or d, so the link's
    /// frame is at the far end.
    ClassicDh(ClassicDh),
    /// A constant translation, then rotations; the joint's motion follows.
    Transform(Transform),
}

/// Modified D-H parameters.
#[derive(Clone, Debug, FromNode)]
pub struct ModifiedDh {
    /// Link length, along x of the previous frame. Default 0.
    #[key(unit = "m")]
    pub a: Option<Spanned<Number>>,
    /// Link twist, about x of the previous frame. Default 0.
    #[key(unit = "rad")]
    pub alpha: Option<Spanned<Angle>>,
    /// Offset along z; the zero position of a prismatic joint. Default 0.
    #[key(unit = "m")]
    pub d: Option<Spanned<Number>>,
    /// Angle about z; the zero position of a revolute joint. Default 0.
    #[key(unit = "rad")]
    pub theta: Option<Spanned<Angle>>,
}

/// Classic D-H parameters.
#[derive(Clone, Debug, FromNode)]
pub struct ClassicDh {
    /// Link length, along x of this frame. Default 0.
    #[key(unit = "m")]
    pub a: Option<Spanned<Number>>,
    /// Link twist, about x of this frame. Default 0.
    #[key(unit = "rad")]
    pub alpha: Option<Spanned<Angle>>,
    /// Offset along z of the previous frame; the zero position of a prismatic joint. Default 0.
    #[key(unit = "m")]
    pub d: Option<Spanned<Number>>,
    /// Angle about z of the previous frame; the zero position of a revolute joint. Default 0.
    #[key(unit = "rad")]
    pub theta: Option<Spanned<Angle>>,
}

/// A constant transformation.
#[derive(Clone, Debug, FromNode)]
pub struct Transform {
    /// Translation in the previous frame. Default `[0, 0, 0]`.
    #[key(unit = "m")]
    pub translation: Option<Spanned<Vector>>,
    /// Rotation `{x: angle}`, `{y: angle}` or `{z: angle}`, or a list of these, each about the axes as rotated by the
    /// previous ones. Default none.
    pub rotation: Option<Spanned<Many<Turn>>>,
}

/// A rotation about one axis.
#[derive(Clone, Debug, FromNode)]
#[key(unit = "rad")]
pub enum Turn {
    /// About x.
    X(Spanned<Angle>),
    /// About y.
    Y(Spanned<Angle>),
    /// About z.
    Z(Spanned<Angle>),
}

/// Name of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum AxisName {
    /// First axis.
    X,
    /// Second axis.
    Y,
    /// Third axis.
    Z,
}
