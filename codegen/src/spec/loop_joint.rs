//! Joints that close loops.

use super::{Attachment, Constant, Friction, Number, Spanned};
use crate::node::FromNode;

/// A joint that closes a loop: it connects two links that are already connected through others, or a link and the world, exactly.
#[derive(Clone, Debug, FromNode)]
pub struct LoopJoint {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// Its point on one link, whose axes are those of its forces.
    pub from: Spanned<Attachment>,
    /// Its point on the other.
    pub to: Spanned<Attachment>,
    /// What it holds together; exactly one.
    pub joint: Spanned<LoopJointKind>,
    /// Friction of a `pin` about its axis. Default: none.
    pub friction: Option<Spanned<Friction>>,
    /// Viscous damping of a `pin` about its axis. Default 0.
    #[key(unit = "N m s/rad", limit = NotNegative)]
    pub damping: Option<Spanned<Number>>,
}

/// What a joint that closes a loop holds together: `ball`, `pin`, `rod` or `slide`.
#[derive(Clone, Debug, FromNode)]
pub enum LoopJointKind {
    /// The two points: three equations.
    Ball,
    /// The two points, and a direction of both links: five equations.
    Pin(PinAxis),
    /// The two points at a distance: a massless rod between two balls, one equation.
    Rod(LoopRod),
    /// The point of `to` on a line of `from`: two equations.
    Slide(SlideAxis),
}

/// A direction, of any length.
pub type Direction = [Spanned<Constant>; 3];

/// The axis of a pin.
#[derive(Clone, Debug, FromNode)]
pub struct PinAxis {
    /// Its direction in the frame of the link `from`, or of the world.
    #[key(unit = "1")]
    pub axis: Spanned<Direction>,
    /// Its direction in the frame of the link `to`. Default: the same numbers.
    #[key(unit = "1")]
    pub to_axis: Option<Spanned<Direction>>,
}

/// A massless rod of constant length.
#[derive(Clone, Debug, FromNode)]
pub struct LoopRod {
    /// Length.
    #[key(unit = "m", limit = Positive)]
    pub length: Spanned<Number>,
}

/// A line along which a point slides.
#[derive(Clone, Debug, FromNode)]
pub struct SlideAxis {
    /// Its direction in the frame of the link `from`, or of the world.
    #[key(unit = "1")]
    pub axis: Spanned<Direction>,
}
