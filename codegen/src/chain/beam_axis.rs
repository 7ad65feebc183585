//! The axis of a beam of equal sections, as a smooth curve.

use super::{BodyId, Value};

/// The axis of a beam of n equal sections: a quadratic B-spline whose control points are the beginning of the beam, its springs and its end.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamAxis {
    /// The first of its elements, which follow one another in the chain.
    pub first: BodyId,
    /// n; 0 for a rigid beam, whose axis is straight.
    pub sections: usize,
    /// Length of the beam, m.
    pub length: Value,
}

impl BeamAxis {
    /// Its elements, from the beginning to the end.
    pub fn elements(&self) -> impl Iterator<Item = BodyId> + use<> {
        let BodyId(first) = self.first;
        (first..=first + self.sections).map(BodyId)
    }

    /// The last of its elements.
    #[must_use]
    pub fn last(&self) -> BodyId {
        BodyId(self.first.0 + self.sections)
    }
}
