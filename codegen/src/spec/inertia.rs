//! Inertia of a body.

use super::{Number, Spanned, Vector};
use crate::node::FromNode;

/// Inertia of a body: the elements of its tensor as in URDF and `MuJoCo`, or radii of gyration.
#[derive(Clone, Debug, FromNode)]
pub struct Inertia {
    /// Reference point. Default `com`.
    pub about: Option<Spanned<About>>,
    /// Moment about x, ∫ (y² + z²) dm, kg m².
    #[key("Ixx")]
    pub xx: Option<Spanned<Number>>,
    /// Moment about y, ∫ (x² + z²) dm, kg m².
    #[key("Iyy")]
    pub yy: Option<Spanned<Number>>,
    /// Moment about z, ∫ (x² + y²) dm, kg m².
    #[key("Izz")]
    pub zz: Option<Spanned<Number>>,
    /// Element of the tensor, −∫ x y dm, kg m². Default 0.
    #[key("Ixy")]
    pub xy: Option<Spanned<Number>>,
    /// Element of the tensor, −∫ x z dm, kg m². Default 0.
    #[key("Ixz")]
    pub xz: Option<Spanned<Number>>,
    /// Element of the tensor, −∫ y z dm, kg m². Default 0.
    #[key("Iyz")]
    pub yz: Option<Spanned<Number>>,
    /// Radii of gyration about the centre of mass, m: I = m k², so that the inertia is proportional to a live mass.
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
