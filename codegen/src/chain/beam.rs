//! Flexible links: springs between their elements, and data for stresses and pictures.

use super::{CoordinateId, Value};

/// Spring and damper of a rigid element on one coordinate, Eqs. (14)–(15).
#[derive(Clone, Debug, PartialEq)]
pub struct BeamSpring {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// Stiffness, N m/rad.
    pub stiffness: Value,
    /// Damping, N m s/rad.
    pub damping: Value,
}

/// Data of a beam for pictures and for its stresses.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Name of the link.
    pub link: String,
    /// Outlines of its cross-section along it: they change linearly between two places; at a step, two places coincide. One
    /// place if the section is the same everywhere, none if the spec does not give a shape.
    pub outlines: Vec<(Value, Outline)>,
    /// Moduli of the section where each of its elements begins; `None` if the spec does not give them.
    pub moduli: Vec<Option<Moduli>>,
    /// Yield stress over the safety factor, Pa; `None` without a yield stress.
    pub allowable_stress: Option<Value>,
}

/// Outline of a cross-section. Pictures need it; mechanics needs only areas and moments.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Height and width, along the link's y and z, m.
    pub size: [Value; 2],
    /// Whether it is an ellipse in that box instead of the box.
    pub round: bool,
}

/// Properties that relate forces and moments of a section to its maximum stresses.
#[derive(Clone, Debug, PartialEq)]
pub struct Moduli {
    /// Area, m²: `σ = N/A`.
    pub area: Value,
    /// Section moduli of bending about y and about z, m³: `σ = M/W`.
    pub bending: [Value; 2],
    /// Section modulus of torsion, m³: the maximum `τ = Mx/W`.
    pub torsion: Value,
    /// Shear areas along y and along z, m²: the maximum `τ = Q/A`.
    pub shear: [Value; 2],
    /// Whether the stresses of bending about both axes add up in a corner; on a round section, both moments add as vectors.
    pub has_corners: bool,
}
