//! Links, their joints and what they carry.

use super::{AxisName, Beam, Constant, Either, Inertia, Many, Number, On, Placement, Shape, SlidesIn, Spanned, Vector};
use crate::node::FromNode;

/// A link: its placement, its joint, and its mass: `mass`, `com` and `inertia`, or several `bodies`, or a `beam`, or
/// a `rope`, or nothing (a massless frame).
#[derive(Clone, Debug, FromNode)]
pub struct Link {
    /// Name, a `snake_case` identifier; coordinates are named after it, such as `boom_psi`.
    pub name: Spanned<String>,
    /// What it is attached to: an earlier link, such as `on: column`, or with the place `on: {link: boom, at: start}`. Default: the
    /// previous link; the first link stands on the world.
    pub on: Option<Spanned<Either<String, On>>>,
    /// Its pose relative to what it is attached to. Default: the same frame.
    pub placement: Option<Spanned<Placement>>,
    /// Its joint. Default `fixed`.
    pub joint: Option<Spanned<Joint>>,
    /// Mass.
    #[key(unit = "kg", limit = Mass)]
    pub mass: Option<Spanned<Number>>,
    /// Centre of mass in the link's frame. Required with `mass`.
    #[key(unit = "m")]
    pub com: Option<Spanned<Vector>>,
    /// Inertia. Default none: a point mass.
    pub inertia: Option<Spanned<Inertia>>,
    /// Several bodies combined into the link.
    pub bodies: Option<Spanned<Vec<Spanned<Body>>>>,
    /// A beam along x, of rigid finite elements; other links are attached to its tip.
    pub beam: Option<Spanned<Beam>>,
    /// A rope or chain along x, of rigid links that hang from each other; other links, such as a hook, are attached to its end.
    pub rope: Option<Spanned<HangingRope>>,
    /// What it looks like, one form or a list of them: drawn in place of what is guessed from masses and joints. No effect on its motion.
    pub shape: Option<Spanned<Many<Shape>>>,
}

impl Link {
    /// What it slides in, if it does.
    #[must_use]
    pub fn slides_in(&self) -> Option<&Spanned<SlidesIn>> {
        self.beam.as_ref()?.value.as_ref()?.slides_in.as_ref()
    }

    /// The link that `on` names, or in which it slides; `None` where it goes on from the previous one.
    #[must_use]
    pub fn named_on(&self) -> Option<&str> {
        if let Some(outer) = self.slides_in() {
            return outer.value.as_ref()?.beam.value.as_deref();
        }
        match self.on.as_ref()?.value.as_ref()? {
            Either::Short(name) => Some(name),
            Either::Full(on) => on.link.value.as_deref(),
        }
    }
}

/// A rope or chain that does not stretch: slender rigid links end to end, each with a universal joint at its beginning.
#[derive(Clone, Debug, FromNode)]
pub struct HangingRope {
    /// Length.
    #[key(unit = "m", limit = Positive)]
    pub length: Spanned<Number>,
    /// Number of links of equal length.
    #[key(unit = "1", limit = Whole(1000))]
    pub links: Spanned<Constant>,
    /// Mass per length.
    #[key(unit = "kg/m", limit = Positive, usual = 1e-3..500.0)]
    pub mass_per_length: Spanned<Number>,
    /// Damping of both rotations of every joint. Default 0.
    #[key(unit = "N m s/rad", limit = NotNegative)]
    pub damping: Option<Spanned<Number>>,
}

/// One of several bodies combined into a link.
#[derive(Clone, Debug, FromNode)]
pub struct Body {
    /// Name, a `snake_case` identifier, unique in its link.
    pub name: Spanned<String>,
    /// Mass.
    #[key(unit = "kg", limit = Mass)]
    pub mass: Spanned<Number>,
    /// Centre of mass in the link's frame.
    #[key(unit = "m")]
    pub com: Spanned<Vector>,
    /// Inertia. Default none: a point mass.
    pub inertia: Option<Spanned<Inertia>>,
}

/// How a link moves relative to its placement: `fixed`, `revolute`, `prismatic`, or for the first link `free`.
#[derive(Clone, Debug, FromNode)]
pub enum Joint {
    /// No motion.
    Fixed,
    /// Rotates about its axis; the coordinate is `<link>_psi` (z), `_theta` (y) or `_phi` (x), rad.
    Revolute(Option<JointAxis>),
    /// Slides along its axis; the coordinate is `<link>_x`, `_y` or `_z`, m.
    Prismatic(Option<JointAxis>),
    /// Base only: translates along x, y, z, then rotates by psi about z, theta about y, phi about x; or a subset of these six.
    Free(Option<Vec<Spanned<BaseCoordinate>>>),
}

/// Axis of a joint.
#[derive(Clone, Debug, FromNode)]
pub struct JointAxis {
    /// Axis of the placed frame. Default z.
    pub axis: Option<Spanned<AxisName>>,
}

/// A coordinate of a free base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, FromNode)]
pub enum BaseCoordinate {
    /// Along x, m.
    X,
    /// Along y, m.
    Y,
    /// Along z, m.
    Z,
    /// About z, rad.
    Psi,
    /// About y, rad.
    Theta,
    /// About x, rad.
    Phi,
}
