//! Telescopes: beams that slide in beams.

use super::{Number, Spanned, Vector};
use crate::node::FromNode;

/// A beam in which another one slides on two pads: at the front, at the end of the outer beam, and at the rear, at the beginning of the inner one.
#[derive(Clone, Debug, FromNode)]
pub struct SlidesIn {
    /// The link of the outer beam, an earlier one.
    pub beam: Spanned<String>,
    /// How far the inner beam is in the outer one where the coordinate of its joint is 0. It becomes shorter as the coordinate grows.
    #[key(unit = "m", limit = Positive)]
    pub overlap: Spanned<Number>,
    /// The pads.
    pub pads: Spanned<Pads>,
}

/// The two pairs of pads of a telescope.
#[derive(Clone, Debug, FromNode)]
pub struct Pads {
    /// At the end of the outer beam, where they hold the inner one.
    pub front: Spanned<Pad>,
    /// At the beginning of the inner beam, where they rest in the outer one.
    pub rear: Spanned<Pad>,
}

/// Pads on all sides of a beam: springs and dampers along y and z of the beam that carries them, and against twist about its x; or exact.
#[derive(Clone, Debug, FromNode)]
pub struct Pad {
    /// Stiffness along y and z, and against twist. Default `[0, 0, 0]`.
    #[key(unit = "N/m, N/m, N m/rad", limit = NotNegative)]
    pub stiffness: Option<Spanned<Vector>>,
    /// Damping along y and z, and against twist. Default `[0, 0, 0]`.
    #[key(unit = "N s/m, N s/m, N m s/rad", limit = NotNegative)]
    pub damping: Option<Spanned<Vector>>,
    /// Clearance on each side along y and z, and of the twist. Default none: `[0, 0, 0]`.
    #[key(unit = "m, m, rad", limit = NotNegative)]
    pub clearance: Option<Spanned<Vector>>,
    /// Directions in which the pad does not give way: equations of a loop in place of springs, or, against twist of a beam with sections, the spring that is beside it. Default none.
    pub exact: Option<Spanned<Vec<Spanned<ExactDirection>>>>,
}

/// A direction in which a pad holds exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum ExactDirection {
    /// Along y of the beam that carries the pad.
    Y,
    /// Along z of the beam that carries the pad.
    Z,
    /// Against twist.
    Twist,
}
