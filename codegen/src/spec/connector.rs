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
    /// The number of parallel parts of a rope between its last sheave, or `from`, and `to`, as in a block and tackle: 1 to 100. Default 1.
    pub falls: Option<Spanned<Constant>>,
    /// The law of its force; exactly one.
    pub law: Spanned<ConnectorLaw>,
}

/// A point of a link, or of the world.
#[derive(Clone, Debug, FromNode)]
pub struct Attachment {
    /// The link. Default: the world.
    pub link: Option<Spanned<String>>,
    /// Position in the frame of the link (for a beam: undeformed) or of the world, m.
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
    /// Motion of `coordinate` per unit of `follows`: m/m, rad/rad, m/rad or rad/m.
    pub ratio: Spanned<Number>,
    /// Position of `coordinate` when `follows` is at 0, m or rad. Default 0.
    pub offset: Option<Spanned<Angle>>,
    /// Stiffness, N/m or N m/rad, of the coordinate that follows; required unless the coupling is rigid.
    pub stiffness: Option<Spanned<Number>>,
    /// Damping, N s/m or N m s/rad. Default 0.
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
    /// The point, in the frame of the link (for a beam: undeformed), m. Default `[0, 0, 0]`.
    pub at: Option<Spanned<Vector>>,
    /// Height of the ground there, along z of the world, m. Default 0.
    pub height: Option<Spanned<Number>>,
    /// Stiffness of ground and point, N/m.
    pub stiffness: Spanned<Number>,
    /// Relative increase of the force with the rate at which the point sinks in, as a fraction, s/m. Default 0.
    pub damping: Option<Spanned<Number>>,
}

macro_rules! laws {
    ($($(#[$doc:meta])* $law:ident as $written:ident: $expecting:literal {
        $($(#[$key_doc:meta])* $key:ident: $number:ty, $limit:ident $unit:literal;)*
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
            $($(#[$key_doc])* pub $key: $number,)*
        })*
    };
}

point_laws!(laws);

/// A rope between two points, perhaps over sheaves.
#[derive(Clone, Debug, FromNode)]
pub struct Rope {
    /// Stiffness EA/ℓ₀, N/m.
    pub stiffness: Option<Spanned<Number>>,
    /// Stiffness EA of its section, N, instead of `stiffness`, which is then EA/ℓ₀ and changes with a winch.
    pub axial_stiffness: Option<Spanned<Number>>,
    /// Relative increase of the force with the rate of stretch, as a fraction, s/m. Default 0.
    pub damping: Option<Spanned<Number>>,
    /// Unstretched length, m.
    pub length: Option<Spanned<Number>>,
    /// Unstretched length over time, m, instead of `length`: a winch.
    pub motion: Option<Spanned<Motion>>,
    /// An emergency stop of the winch. Default: none.
    pub halt: Option<Spanned<Halt>>,
    /// The largest tension that it may carry at work, N; more causes a caution, and limits loads of charts. Default: none.
    pub max_tension: Option<Spanned<Constant>>,
}
