//! Flexible links: data for stresses and pictures.

use crane_quantities::Side;

use super::{BodyId, Inertia, Sliding, Value};

/// Data of a beam for pictures and for its stresses.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Name of the link.
    pub link: String,
    /// Outlines of its cross-section along it: they change linearly between two places; at a step, two places coincide. One
    /// place if the section is the same everywhere, none if the spec does not give a shape.
    pub outlines: Vec<(Value, Outline)>,
    /// Sections at which its forces and stresses are known, from its beginning to its end: at least that where each of its elements begins.
    pub sections: Vec<Section>,
    /// Yield stress over the safety factor, Pa; `None` without a yield stress.
    pub allowable_stress: Option<Value>,
}

/// A section of a beam or a rope at which forces and moments are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// The element.
    pub body: BodyId,
    /// Distance from the beginning of the beam, m.
    pub x: Value,
    /// On which side of what is there.
    pub side: Side,
    /// What is there, in the user's words: a pin, a load, a step; empty if nothing is.
    pub at: String,
    /// Where it is within its element; `None` where the element begins.
    pub inside: Option<Inside>,
    /// The pad on which the beam slides there: x is its place with the coordinate along which the beam slides at 0. `None` for other sections.
    pub slides: Option<Box<Sliding>>,
    /// Its moduli; `None` if the spec does not give them. On a beam whose sections differ, they follow from those around the pad.
    pub moduli: Option<Moduli>,
}

impl Section {
    /// Whether it is where its element begins.
    #[must_use]
    pub fn begins_element(&self) -> bool {
        self.inside.is_none() && self.slides.is_none()
    }
}

/// The place of a section within an element.
#[derive(Clone, Debug, PartialEq)]
pub struct Inside {
    /// Distance from the beginning of the element, m.
    pub distance: Value,
    /// Pseudo-inertia of the part of the element beyond it, about the origin of the element's frame.
    pub beyond: Inertia,
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
