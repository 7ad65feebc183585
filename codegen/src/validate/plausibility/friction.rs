//! Bristles of joints that stick.

use super::{Plausibility, rounded};
use crate::chain::{Coordinate, CoordinateId, CoordinateKind};
use crate::diagnostic::rule;

/// Usual deflections at which bristles slide, rad or m: from stiff bearings to soft seals.
const USUAL: [f64; 2] = [1e-8, 0.1];

impl Plausibility<'_> {
    /// Bristles that slide at a deflection that no real surface has: steps become tiny, or the joint acts as a spring instead of sticking.
    pub(super) fn bristles(&mut self) {
        let entries = self.crane.friction.as_ref().and_then(|friction| friction.value.as_ref());
        for (name, given) in entries.into_iter().flat_map(|entries| &entries.0) {
            let Some(given) = given.value.as_ref().and_then(|written| written.bristle.as_ref()) else { continue };
            let named = |known: &&Coordinate| Some(known.name.as_str()) == name.value.as_deref();
            let Some(coordinate) = self.chain.coordinates.iter().find(named) else { continue };
            let of_joint = |(id, _): &(CoordinateId, _)| self.chain.coordinates[id.0].name == coordinate.name;
            let Some((_, bristle)) = self.chain.bristles().find(of_joint) else { continue };
            let deflection = bristle.breakaway / bristle.stiffness;
            let unit = match coordinate.kind {
                CoordinateKind::Translation => "m",
                CoordinateKind::Rotation => "rad",
            };
            if !(USUAL[0]..=USUAL[1]).contains(&deflection) {
                let deflection = format!("{:e}", rounded(deflection));
                self.warn(rule::odd_bristles(given.span, &coordinate.name, deflection, unit));
            }
        }
    }
}
