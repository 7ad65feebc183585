//! Connectors: elements between two points.

use super::{Angle, Constant, Halt, Motion, Number, Spanned, Vector};
use crate::node::FromNode;

/// A spring, gas spring or rope between two points, which pulls or pushes them along the line between them. A rope may run over sheaves.
#[derive(Clone, Debug, FromNode)]
pub struct Connector {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// One of its points.
    pub from: Spanned<Attachment>,
    /// The other.
    pub to: Spanned<Attachment>,
    /// The sheaves over which a rope runs from one to the other, in order: points of links or of the world.
    pub over: Option<Spanned<Vec<Spanned<Attachment>>>>,
    /// The number of parallel parts of a rope between its last sheave, or `from`, and `to`, as in a block and tackle. Default 1.
    #[key(unit = "1", limit = Whole(100))]
    pub falls: Option<Spanned<Constant>>,
    /// The law of its force; exactly one.
    pub law: Spanned<ConnectorLaw>,
}

/// A point of a link, or of the world.
#[derive(Clone, Debug, FromNode)]
pub struct Attachment {
    /// The link. Default: the world.
    pub link: Option<Spanned<String>>,
    /// Position in the frame of the link (for a beam: undeformed) or of the world.
    #[key(unit = "m")]
    pub at: Spanned<Vector>,
}

/// A coupling: one coordinate follows another, through a spring and a damper or exactly.
#[derive(Clone, Debug, FromNode)]
pub struct Coupling {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// The coordinate that follows.
    pub coordinate: Spanned<String>,
    /// The coordinate that leads.
    pub follows: Spanned<String>,
    /// Motion of `coordinate` per unit of `follows`.
    #[key(unit = "1, m/rad or rad/m")]
    pub ratio: Spanned<Number>,
    /// Position of `coordinate` when `follows` is at 0. Default 0.
    #[key(unit = "rad or m")]
    pub offset: Option<Spanned<Angle>>,
    /// Stiffness of the coordinate that follows; required unless the coupling is rigid.
    #[key(unit = "N m/rad or N/m", limit = NotNegative, usual = 0.0..1e13)]
    pub stiffness: Option<Spanned<Number>>,
    /// Damping. Default 0.
    #[key(unit = "N m s/rad or N s/m", limit = NotNegative)]
    pub damping: Option<Spanned<Number>>,
    /// Whether the coordinate follows exactly. Default false.
    pub rigid: Option<Spanned<bool>>,
}

/// A point of a link that the ground carries while it touches it, without friction.
#[derive(Clone, Debug, FromNode)]
pub struct Contact {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// The link.
    pub link: Spanned<String>,
    /// The point, in the frame of the link (for a beam: undeformed). Default `[0, 0, 0]`.
    #[key(unit = "m", usual = 0.0..200.0)]
    pub at: Option<Spanned<Vector>>,
    /// Height of the ground there, along z of the world. Default 0.
    #[key(unit = "m", usual = 0.0..200.0)]
    pub height: Option<Spanned<Number>>,
    /// Stiffness of ground and point.
    #[key(unit = "N/m", limit = Positive)]
    pub stiffness: Spanned<Number>,
    /// Relative increase of the force with the rate at which the point sinks in, as a fraction. Default 0.
    #[key(unit = "s/m", limit = NotNegative, usual = 0.0..30.0)]
    pub damping: Option<Spanned<Number>>,
}

macro_rules! laws {
    ($($(#[$doc:meta])* $law:ident as $written:ident: $expecting:literal {
        $($(#[doc = $about:literal])* #[key(unit = $unit:literal, limit = $limit:ident)] $key:ident: $number:ty;)*
    })*) => {
        /// How the force of a connector depends on its length.
        #[derive(Clone, Debug, FromNode)]
        pub enum ConnectorLaw {
            $($(#[$doc])* $law($written),)*
            /// A rope, which pulls while it is taut.
            Rope(Box<Rope>),
        }

        $($(#[$doc])*
        #[derive(Clone, Debug, FromNode)]
        pub struct $written {
            $($(#[doc = $about])* #[key(unit = $unit, limit = $limit)] pub $key: $number,)*
        })*
    };
}

point_laws!(laws);

/// A rope between two points, perhaps over sheaves.
#[derive(Clone, Debug, FromNode)]
pub struct Rope {
    /// Stiffness EA/ℓ₀.
    #[key(unit = "N/m", limit = Positive)]
    pub stiffness: Option<Spanned<Number>>,
    /// Stiffness EA of its section, instead of `stiffness`, which is then EA/ℓ₀ and changes with a winch.
    #[key(unit = "N", limit = Positive, usual = 1e5..1e13)]
    pub axial_stiffness: Option<Spanned<Number>>,
    /// Relative increase of the force with the rate of stretch, as a fraction. Default 0.
    #[key(unit = "s/m", limit = NotNegative, usual = 0.0..30.0)]
    pub damping: Option<Spanned<Number>>,
    /// Unstretched length.
    #[key(unit = "m", limit = Positive)]
    pub length: Option<Spanned<Number>>,
    /// Unstretched length over time, instead of `length`: a winch.
    #[key(unit = "m")]
    pub motion: Option<Spanned<Motion>>,
    /// An emergency stop of the winch. Default: none.
    pub halt: Option<Spanned<Halt>>,
    /// The largest tension that it may carry at work; more causes a caution, and limits loads of charts. Default: none.
    #[key(unit = "N", limit = Positive)]
    pub max_tension: Option<Spanned<Constant>>,
}
