//! The payload compared with the crane's own mass.

use super::{Plausibility, items, rounded};
use crate::diagnostic::{Span, rule};
use crate::spec::{Number, Scalar, Spanned};

/// A live mass, probably the payload, below this fraction of the mass that carries it is probably in tonnes.
const LIGHTEST_LIVE: f64 = 1.0 / 300.0;
/// The same for a constant mass at the crane's tip, which may be a light tool: the last link of a PUMA 560 is 1/260 of the arm.
const LIGHTEST: f64 = 1.0 / 1000.0;
/// Beyond this ratio of the payload to the mass that carries it, the crane is in tonnes or the payload in g.
const HEAVIEST: f64 = 100.0;

impl Plausibility<'_> {
    pub(super) fn masses(&mut self) {
        let crane = self.crane;
        let mut masses: Vec<(String, &Spanned<Number>)> = Vec::new();
        for link in items(Some(&crane.links)) {
            let name = link.name.value.as_deref().unwrap_or_default();
            masses.extend(link.mass.as_ref().map(|mass| (format!("link `{name}`"), mass)));
            masses.extend(items(link.bodies.as_ref()).map(|body| {
                let name = body.name.value.as_deref().unwrap_or_default();
                (format!("body `{name}`"), &body.mass)
            }));
        }
        let at_the_end =
            items(Some(&crane.links)).last().is_some_and(|link| link.beam.is_none() && link.rope.is_none());
        let count = masses.len();
        for (index, (place, given)) in masses.into_iter().enumerate() {
            let live = matches!(given.value.as_ref().map(|mass| &mass.0), Some(Scalar::Name(_)));
            if live || (at_the_end && index + 1 == count) {
                let (mass, at) = self.number(given);
                self.payload(&place, mass, at, if live { LIGHTEST_LIVE } else { LIGHTEST });
            }
        }
    }

    /// Compares a payload with the rest of the crane, except for a moving base: the mass of a truck says nothing about its crane.
    fn payload(&mut self, place: &str, mass: f64, at: Span, lightest: f64) {
        let chain = self.chain;
        let base = chain.base.iter().any(Option::is_some);
        let carried = chain.bodies.iter().skip(usize::from(base)).filter_map(|body| body.inertia.as_ref());
        let crane: f64 = carried.map(|inertia| inertia.mass.at(&self.values)).sum::<f64>() - mass;
        // Zero means that there is no payload; a rule refuses less.
        if mass <= 0.0 || crane <= 0.0 {
            return;
        }
        if mass < lightest * crane {
            let help = format!("write masses in kg: {mass} t = {} kg", rounded(1e3 * mass));
            self.warn(rule::payload(at, place, mass, rounded(crane), help));
        } else if mass > HEAVIEST * crane {
            let help = "write all masses in kg, also those of the links";
            self.warn(rule::payload(at, place, mass, rounded(crane), help));
        }
    }
}
