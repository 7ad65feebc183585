//! Places of supports.

use super::{Plausibility, rounded};
use crate::diagnostic::rule;
use crate::spec::entries;

/// Height by which a foot may differ from the others, m: more than any slope or outrigger box.
const HEIGHT: f64 = 1.0;
/// Distance below which two supports are in one place, m.
const ONE_PLACE: f64 = 1e-6;

impl Plausibility<'_> {
    /// Supports that are far above or below the others or in the place of another one.
    pub(super) fn places_of_feet(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        let places: Vec<[f64; 3]> =
            chain.supports.iter().map(|support| support.position.each_ref().map(|x| x.at(&self.values))).collect();
        let mut heights: Vec<f64> = places.iter().map(|position| position[2]).collect();
        heights.sort_by(f64::total_cmp);
        for (index, (given, support)) in entries(crane.supports.as_ref()).zip(&chain.supports).enumerate() {
            let (name, position) = (&support.name, places[index]);
            let usual = heights[(heights.len() - 1) / 2];
            if places.len() > 2 && (position[2] - usual).abs() > HEIGHT {
                self.warn(rule::raised_foot(given.at.span, name, rounded(position[2]), rounded(usual)));
            }
            let near = |other: &[f64; 3]| (0..3).all(|i| (other[i] - position[i]).abs() < ONE_PLACE);
            if let Some(other) = places[..index].iter().position(near) {
                self.warn(rule::same_foot(given.at.span, name, &chain.supports[other].name));
            }
        }
    }
}
