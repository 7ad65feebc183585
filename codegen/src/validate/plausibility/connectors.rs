//! Lengths of connectors compared with the distance between their points, and ratios of couplings.

use super::{Plausibility, rounded};
use crate::diagnostic::rule;
use crate::spec::{Spanned, entries};

/// Usual lengths without force, as fractions of the distance between the points at the guess.
const USUAL: [f64; 2] = [0.1, 10.0];
/// Maximum ratio of the length of a rope at the guess to its length without force: steel breaks long before.
const STRETCHED: f64 = 1.2;

/// Maximum ratio of a coupling between joints of one kind.
const RATIO: f64 = 20.0;

impl Plausibility<'_> {
    /// Couplings whose joint moves far more than the one that it follows.
    pub(super) fn couplings(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        for given in entries(crane.couplings.as_ref()) {
            let named =
                |name: &Spanned<String>| chain.coordinates.iter().find(|one| Some(&one.name) == name.value.as_ref());
            let (Some(follower), Some(other)) = (named(&given.coordinate), named(&given.follows)) else { continue };
            let (ratio, _) = self.number(&given.ratio);
            if follower.kind == other.kind && ratio.abs() > RATIO {
                let name = given.name.value.as_deref().unwrap_or_default();
                self.warn(rule::high_ratio(given.ratio.span, name, rounded(ratio), &follower.name, &other.name));
            }
        }
    }

    /// A spring or rope whose length does not fit its points.
    pub(super) fn connectors(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        for (given, connector) in entries(crane.connectors.as_ref()).zip(chain.connectors()) {
            let Some(line) = connector.strain.line() else { continue };
            let distance = chain.length(line, &chain.guess, &self.values);
            let Some(length) = connector.law.length(&self.values) else { continue };
            let least = if connector.is_rope() { 1.0 / STRETCHED } else { USUAL[0] };
            if length < least * distance || length > USUAL[1] * distance {
                self.warn(rule::connector_length(given.law.span, &connector.name, rounded(length), rounded(distance)));
            }
        }
    }
}
