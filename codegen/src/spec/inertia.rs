//! Inertia of a body.

use super::{Number, Spanned, Vector};
use crate::node::FromNode;

/// Inertia of a body: the elements of its tensor as in URDF and `MuJoCo`, or radii of gyration.
#[derive(Clone, Debug, FromNode)]
pub struct Inertia {
    /// Reference point. Default `com`.
    pub about: Option<Spanned<About>>,
    /// Moment about x, ∫ (y² + z²) dm.
    #[key("Ixx", unit = "kg m²")]
    pub xx: Option<Spanned<Number>>,
    /// Moment about y, ∫ (x² + z²) dm.
    #[key("Iyy", unit = "kg m²")]
    pub yy: Option<Spanned<Number>>,
    /// Moment about z, ∫ (x² + y²) dm.
    #[key("Izz", unit = "kg m²")]
    pub zz: Option<Spanned<Number>>,
    /// Element of the tensor, −∫ x y dm. Default 0.
    #[key("Ixy", unit = "kg m²")]
    pub xy: Option<Spanned<Number>>,
    /// Element of the tensor, −∫ x z dm. Default 0.
    #[key("Ixz", unit = "kg m²")]
    pub xz: Option<Spanned<Number>>,
    /// Element of the tensor, −∫ y z dm. Default 0.
    #[key("Iyz", unit = "kg m²")]
    pub yz: Option<Spanned<Number>>,
    /// Radii of gyration about the centre of mass: I = m k², so that the inertia is proportional to a live mass.
    #[key(unit = "m", limit = NotNegative)]
    pub gyration: Option<Spanned<Vector>>,
}

/// The reference point of an inertia; the axes are those of the link's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum About {
    /// The centre of mass.
    Com,
    /// The origin of the link's frame.
    Origin,
}
