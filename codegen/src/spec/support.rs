//! Supports of the base, names of frames and joints, and points of interest.

use super::{Constant, FixedAngle, Number, Spanned, Transform, Vector};
use crate::node::FromNode;

/// A support of a free base: three springs and dampers along the axes of the world.
#[derive(Clone, Debug, FromNode)]
pub struct Support {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// Its attachment point in the base's frame.
    #[key(unit = "m")]
    pub at: Spanned<Vector>,
    /// Stiffness along x, y, z.
    #[key(unit = "N/m", limit = NotNegative, usual = 1e3..1e13)]
    pub stiffness: Spanned<Vector>,
    /// Damping along x, y, z. Default `[0, 0, 0]`.
    #[key(unit = "N s/m", limit = NotNegative)]
    pub damping: Option<Spanned<Vector>>,
    /// Elongation at which the springs are unstressed, along x, y, z. Default `[0, 0, 0]`.
    #[key(unit = "m", usual = 0.0..0.2)]
    pub free_play: Option<Spanned<Vector>>,
    /// How the elongation depends on the base's coordinates. Default `linear`.
    pub kinematics: Option<Spanned<Kinematics>>,
    /// Whether it only presses along z, and lifts off instead of pulling. Free play along z is then a gap. Default `false`.
    pub one_sided: Option<Spanned<bool>>,
    /// Coefficient of friction between a one-sided support and the ground: sideways it holds at most this times the force with which it
    /// presses, and slides beyond. Default 0.6.
    #[key(unit = "1", limit = Positive, usual = 0.1..1.2)]
    pub friction_coefficient: Option<Spanned<Number>>,
    /// Whether a one-sided support never slides while it presses: it then has a coefficient of friction of 1000. Default `false`.
    pub sticks: Option<Spanned<bool>>,
    /// The plate under it, which spreads its force over the ground. Default: none.
    pub plate: Option<Spanned<Plate>>,
}

/// The plate under a support.
#[derive(Clone, Debug, FromNode)]
pub struct Plate {
    /// Its area.
    #[key(unit = "m²", limit = Positive, usual = 1e-4..100.0)]
    pub area: Spanned<Constant>,
    /// The largest pressure that the ground bears; more causes a caution, and limits loads of charts. Default: none.
    #[key(unit = "Pa", limit = Positive, usual = 1e3..1e7)]
    pub max_pressure: Option<Spanned<Constant>>,
}

/// How the elongation of a support depends on the base's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum Kinematics {
    /// For small rotations, as in the paper.
    Linear,
    /// For any rotation.
    Exact,
}

/// A point of interest.
#[derive(Clone, Debug, FromNode)]
pub struct Point {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// The link that carries it; not with `frame`.
    pub link: Option<Spanned<String>>,
    /// The one of `frames` in which `at` is given.
    pub frame: Option<Spanned<String>>,
    /// Its position in the frame of the link (for a beam: undeformed), or in `frame`. Default `[0, 0, 0]`.
    #[key(unit = "m")]
    pub at: Option<Spanned<Vector>>,
}

/// A frame with a name of its own, which need not be an identifier.
#[derive(Clone, Debug, FromNode)]
pub struct NamedFrame {
    /// Name.
    pub name: Spanned<String>,
    /// The link that carries it. Default: the world.
    pub link: Option<Spanned<String>>,
    /// Its pose in the frame of the link (for a beam: undeformed), or in the world. Default: that of the link.
    pub transform: Option<Spanned<Transform>>,
}

/// A joint with a name of its own, which need not be an identifier.
#[derive(Clone, Debug, FromNode)]
pub struct NamedJoint {
    /// Name.
    pub name: Spanned<String>,
    /// Its coordinate. Default: none, since it does not move.
    pub coordinate: Option<Spanned<String>>,
    /// Its position where the coordinate is zero or, without one, always. Default 0.
    #[key(unit = "rad or m")]
    pub at: Option<Spanned<FixedAngle>>,
}
