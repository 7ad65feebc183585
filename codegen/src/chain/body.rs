//! Coordinates and bodies, and the steps from one to the next.

use crane_quantities::CoordinateKind;

use super::{BodyId, CoordinateId, Value};

/// A generalized coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Unique name, a valid Rust identifier, such as `boom_psi` or `boom_2_theta`.
    pub name: String,
    /// Translation (m) or rotation (rad).
    pub kind: CoordinateKind,
    /// The axis of its frame along which it translates or about which it rotates.
    pub axis: Axis,
    /// The first body that it moves.
    pub body: BodyId,
}

/// Axis of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axis {
    /// First axis.
    X,
    /// Second axis.
    Y,
    /// Third axis.
    Z,
}

impl Axis {
    /// 0, 1, 2.
    #[must_use]
    pub fn index(self) -> usize {
        self as usize
    }

    /// Its direction.
    #[must_use]
    pub fn unit_vector(self) -> super::Vector {
        [0, 1, 2].map(|i| f64::from(u8::from(i == self.index())))
    }
}

/// A body: a rigid link, a rigid finite element, or a massless frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Unique name, a valid Rust identifier: the link's, or `boom_0`, `boom_1` … for elements.
    pub name: String,
    /// Name of the link it belongs to.
    pub link: String,
    /// The body to which it is attached, an earlier one; `None` for the first, which is attached to the world.
    pub parent: Option<BodyId>,
    /// Where it is attached along the parent's x, m.
    pub along: Value,
    /// The transformation from the parent's frame to this one's, T̃, as elementary steps in order.
    pub path: Vec<Step>,
    /// Mass properties about the origin of the body's frame; `None` for a massless frame.
    pub inertia: Option<Inertia>,
    /// The named parts combined into it, for tables.
    pub parts: Vec<LinkPart>,
    /// Length along x for a rigid element, 0 otherwise, m; for pictures and moments along the beam.
    pub length: Value,
}

/// One factor of a homogeneous transformation T̃, Eq. (3).
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Constant translation, m.
    Translate([Value; 3]),
    /// Constant rotation about an axis, by its sine and cosine.
    Rotate {
        /// Axis of rotation.
        axis: Axis,
        /// Sine of the angle.
        sin: Value,
        /// Cosine of the angle.
        cos: Value,
    },
    /// Translation by a coordinate along its axis, or rotation by it about its axis.
    Move(CoordinateId),
    /// Rotation by the vector ρ whose components are three coordinates, one along each axis: `exp([ρ]×)`. They are
    /// consecutive in q.
    RotationVector([CoordinateId; 3]),
}

impl Step {
    /// The coordinates on which it depends.
    #[must_use]
    pub fn coordinates(&self) -> &[CoordinateId] {
        match self {
            Step::Translate(_) | Step::Rotate { .. } => &[],
            Step::Move(id) => std::slice::from_ref(id),
            Step::RotationVector(ids) => ids,
        }
    }
}

/// Pseudo-inertia `H = ∫ r rᵀ dm`, `r = [x y z 1]ᵀ`, about the origin of the body's frame, Eq. (4).
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    /// Mass, kg.
    pub mass: Value,
    /// Static moments `∫ r dm`, kg m.
    pub first: [Value; 3],
    /// `∫ x² dm, ∫ y² dm, ∫ z² dm, ∫ xy dm, ∫ xz dm, ∫ yz dm`, kg m².
    pub second: [Value; 6],
}

/// A named part of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkPart {
    /// Name as written by the user.
    pub name: String,
    /// Mass, kg.
    pub mass: Value,
    /// Centre of mass in the body's frame, m.
    pub com: [Value; 3],
}
