//! External loads.

use super::{Direction, Motion, Number, Spanned, Vector};
use crate::node::FromNode;

/// A force and a moment at a point of a link.
#[derive(Clone, Debug, FromNode)]
pub struct Load {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// The link it acts on.
    pub link: Spanned<String>,
    /// Its point of application in the frame of the link (for a beam: undeformed). Default `[0, 0, 0]`.
    #[key(unit = "m")]
    pub at: Option<Spanned<Vector>>,
    /// Force along x, y, z. Default `[0, 0, 0]`.
    #[key(unit = "N")]
    pub force: Option<Spanned<Vector>>,
    /// Wind, whose force is in place of `force`.
    pub wind: Option<Spanned<Wind>>,
    /// Moment about x, y, z. Default `[0, 0, 0]`.
    #[key(unit = "N m")]
    pub moment: Option<Spanned<Vector>>,
    /// Whether x, y, z are the axes of the world or those of the link, with which the load turns. Default `world`.
    pub axes: Option<Spanned<Axes>>,
    /// Factor of force and moment over time, given like a motion of a drive. Default 1.
    #[key(unit = "1")]
    pub scale: Option<Spanned<Motion>>,
}

/// The force of wind on an area: `pressure · shape_factor · area`, or `ρ/2 · speed² · shape_factor · area` with ρ = 1.25 kg/m³.
#[derive(Clone, Debug, FromNode)]
pub struct Wind {
    /// Pressure where the wind is stopped. Either this or `speed`.
    #[key(unit = "Pa", limit = NotNegative, usual = 1.0..1e4)]
    pub pressure: Option<Spanned<Number>>,
    /// Speed. Either this or `pressure`.
    #[key(unit = "m/s", limit = NotNegative, usual = 0.1..100.0)]
    pub speed: Option<Spanned<Number>>,
    /// Area that faces the wind.
    #[key(unit = "m²", limit = NotNegative, usual = 1e-4..1e4)]
    pub area: Spanned<Number>,
    /// Shape factor, the drag coefficient of the area.
    #[key(unit = "1", limit = NotNegative, usual = 0.01..10.0)]
    pub shape_factor: Spanned<Number>,
    /// Direction in which it blows, along x, y, z, of any length.
    #[key(unit = "1")]
    pub direction: Spanned<Direction>,
}

/// Axes along which a load is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum Axes {
    /// Those of the world.
    World,
    /// Those of the link.
    Link,
}
