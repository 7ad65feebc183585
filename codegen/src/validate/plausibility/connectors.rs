//! Lengths of connectors compared with the distance between their points.

use super::{Plausibility, items, rounded};
use crate::chain::{ConnectorLaw, Strain};
use crate::diagnostic::rule;

/// Usual lengths without force, as fractions of the distance between the points at the guess.
const USUAL: [f64; 2] = [0.1, 10.0];
/// Maximum ratio of the length of a rope at the guess to its length without force: steel breaks long before.
const STRETCHED: f64 = 1.2;

impl Plausibility<'_> {
    /// A spring or rope whose length does not fit its points.
    pub(super) fn connectors(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        for (given, connector) in items(crane.connectors.as_ref()).zip(&chain.connectors) {
            let Strain::Distance(ends) = &connector.strain else { continue };
            let distance = chain.distance(ends, &chain.guess, &self.values);
            let (length, least) = match &connector.law {
                ConnectorLaw::Linear { length, .. } => (length.at(&self.values), USUAL[0]),
                ConnectorLaw::Rope { length, .. } => (length.start(&self.values), 1.0 / STRETCHED),
            };
            if length < least * distance || length > USUAL[1] * distance {
                self.warn(rule::connector_length(given.law.span, &connector.name, rounded(length), rounded(distance)));
            }
        }
    }
}
