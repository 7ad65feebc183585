//! Masses and inertias compared with the crane.

use super::{Plausibility, rounded};
use crate::diagnostic::{Span, rule};
use crate::spec::{Number, Scalar, Spanned, entries};

/// A live mass, probably the payload, below this fraction of the mass that carries it is probably in tonnes.
const LIGHTEST_LIVE: f64 = 1.0 / 300.0;
/// The same for a constant mass at the crane's tip, which may be a light tool: the last link of a PUMA 560 is 1/260 of the arm.
const LIGHTEST: f64 = 1.0 / 1000.0;
/// Beyond this ratio of the payload to the mass that carries it, the crane is in tonnes or the payload in g.
const HEAVIEST: f64 = 100.0;

/// A base on feet that lift is usually heavier than this fraction of what it carries.
const LIGHTEST_BASE: f64 = 0.02;
/// Size below which no inertia and no centre of mass is out of proportion, m: the halves of long booms that are given as one body.
const SMALL: f64 = 20.0;
/// How far beyond the crane's size they may be, as a multiple of it.
const BEYOND: f64 = 2.0;

impl Plausibility<'_> {
    /// Inertias and centres of mass that are out of proportion to the crane.
    pub(super) fn spread(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        let size = self.size();
        let most = SMALL.max(BEYOND * size);
        for link in entries(Some(&crane.links)) {
            let name = link.name.value.as_deref().unwrap_or_default();
            let subject = format!("link `{name}`");
            let inertia = chain.bodies.iter().find(|body| body.link == name).and_then(|body| body.inertia.as_ref());
            let (Some(inertia), Some(com)) = (inertia, &link.com) else { continue };
            let mass = inertia.mass.at(&self.values);
            if mass == 0.0 {
                continue;
            }
            let centre = inertia.first.each_ref().map(|first| first.at(&self.values) / mass);
            let distance = centre.iter().map(|x| x * x).sum::<f64>().sqrt();
            if distance > most {
                self.warn(rule::far_mass(com.span, &subject, rounded(distance), rounded(size)));
                continue;
            }
            let [xx, yy, zz] = [0, 1, 2].map(|i| inertia.second[i].at(&self.values) / mass - centre[i] * centre[i]);
            let radius = (xx + yy).max(yy + zz).max(zz + xx).sqrt();
            if let Some(given) = link.inertia.as_ref().filter(|_| radius > most) {
                self.warn(rule::spread_mass(given.span, &subject, rounded(radius), rounded(size)));
            }
        }
    }

    /// Diagonal of the box around all frames and supports at the guess, m.
    pub(super) fn size(&self) -> f64 {
        self.size_at(&self.chain.guess)
    }

    /// The same in another pose.
    pub(super) fn size_at(&self, q: &[f64]) -> f64 {
        let chain = self.chain;
        let frames = chain.frames(q, &self.values);
        let feet = chain.supports.iter().filter_map(|support| {
            Some(frames.first()?.transform_point(support.position.each_ref().map(|x| x.at(&self.values))))
        });
        let points: Vec<[f64; 3]> = frames.iter().map(|frame| frame.origin).chain(feet).collect();
        let side = |axis: usize| {
            let along = || points.iter().map(|point| point[axis]);
            along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
        };
        (0..3).map(|axis| side(axis).powi(2)).sum::<f64>().sqrt()
    }

    /// A base that is far lighter than what it carries on feet that lift.
    pub(super) fn base(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        let Some(link) = entries(Some(&crane.links)).next() else { return };
        let (Some(given), true) = (&link.mass, chain.supports.iter().any(|support| support.friction.is_some())) else {
            return;
        };
        let (mass, at) = self.number(given);
        let carried = chain.bodies.iter().skip(1).filter_map(|body| body.inertia.as_ref());
        let carried: f64 = carried.map(|inertia| inertia.mass.at(&self.values)).sum();
        if mass < LIGHTEST_BASE * carried {
            let name = link.name.value.as_deref().unwrap_or_default();
            self.warn(rule::light_base(at, name, mass, rounded(carried)));
        }
    }

    pub(super) fn masses(&mut self) {
        let crane = self.crane;
        let mut masses: Vec<(String, &Spanned<Number>)> = Vec::new();
        for link in entries(Some(&crane.links)) {
            let name = link.name.value.as_deref().unwrap_or_default();
            masses.extend(link.mass.as_ref().map(|mass| (format!("link `{name}`"), mass)));
            masses.extend(entries(link.bodies.as_ref()).map(|body| {
                let name = body.name.value.as_deref().unwrap_or_default();
                (format!("body `{name}`"), &body.mass)
            }));
        }
        let at_the_end =
            entries(Some(&crane.links)).last().is_some_and(|link| link.beam.is_none() && link.rope.is_none());
        let count = masses.len();
        for (index, (subject, given)) in masses.into_iter().enumerate() {
            let live = matches!(given.value.as_ref().map(|mass| &mass.0), Some(Scalar::Name(_)));
            if live || (at_the_end && index + 1 == count) {
                let (mass, at) = self.number(given);
                self.payload(&subject, mass, at, if live { LIGHTEST_LIVE } else { LIGHTEST });
            }
        }
    }

    /// Compares a payload with the rest of the crane, except for a moving base: the mass of a truck says nothing about its crane.
    fn payload(&mut self, subject: &str, mass: f64, at: Span, lightest: f64) {
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
            self.warn(rule::payload(at, subject, mass, rounded(crane), help));
        } else if mass > HEAVIEST * crane {
            let help = "write all masses in kg, also those of the links";
            self.warn(rule::payload(at, subject, mass, rounded(crane), help));
        }
    }
}
