//! The axis of a divided beam, as a smooth curve.

use super::{BodyId, Value};

/// The axis of a beam of n sections: a quadratic B-spline whose control points are the beginning of the beam, its springs and its end.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamAxis {
    /// The first of its elements, which follow one another in the chain.
    pub first: BodyId,
    /// Its sections; none for a rigid beam, whose axis is straight.
    pub division: Division,
    /// Length of the beam, m.
    pub length: Value,
}

/// The sections of a beam: stretches of equal ones, between the places where something acts on the beam.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Division {
    /// From the beginning to the end of the beam.
    pub stretches: Vec<Stretch>,
}

/// Equal sections one after another.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// How many.
    pub sections: usize,
    /// Length of each, m.
    pub section: Value,
    /// Where the first begins, m from the beginning of the beam.
    pub begin: Value,
}

impl Division {
    /// Number of sections.
    #[must_use]
    pub fn sections(&self) -> usize {
        self.stretches.iter().map(|stretch| stretch.sections).sum()
    }

    /// Places of the springs, in the middles of the sections, m from the beginning of the beam.
    pub fn springs(&self) -> impl Iterator<Item = Value> {
        self.stretches.iter().flat_map(|stretch| (0..stretch.sections).map(|index| stretch.at(index as f64 + 0.5)))
    }

    /// Every section: where it begins and its length, m.
    pub fn each(&self) -> impl Iterator<Item = (Value, &Value)> {
        self.stretches
            .iter()
            .flat_map(|stretch| (0..stretch.sections).map(|index| (stretch.at(index as f64), &stretch.section)))
    }
}

impl Stretch {
    /// The place after this many of its sections, m from the beginning of the beam.
    #[must_use]
    pub fn at(&self, sections: f64) -> Value {
        self.begin.clone() + sections * self.section.clone()
    }
}

impl BeamAxis {
    /// Number of sections.
    #[must_use]
    pub fn sections(&self) -> usize {
        self.division.sections()
    }

    /// Its elements, from the beginning to the end.
    pub fn elements(&self) -> impl Iterator<Item = BodyId> + use<> {
        let BodyId(first) = self.first;
        (first..=first + self.sections()).map(BodyId)
    }

    /// The last of its elements.
    #[must_use]
    pub fn last(&self) -> BodyId {
        BodyId(self.first.0 + self.sections())
    }
}
