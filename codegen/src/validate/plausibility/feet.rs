//! Places, free play and friction of supports.

use super::{Plausibility, rounded};
use crate::diagnostic::rule;
use crate::spec::entries;

/// Height by which a foot may differ from the others, m: more than any slope or outrigger box.
const HEIGHT: f64 = 1.0;
/// Distance below which two supports are in one place, m.
const ONE_PLACE: f64 = 1e-6;
/// Maximum free play, m.
const FREE_PLAY: f64 = 0.2;
/// Usual coefficients of friction: from wet ice to rubber on dry concrete.
const FRICTION: [f64; 2] = [0.1, 1.2];

impl Plausibility<'_> {
    /// Supports that are far above or below the others or in the place of another one, or act only after a long way.
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
            let play = support.free_play.iter().map(|play| play.at(&self.values)).fold(0.0, |a: f64, b| a.max(b.abs()));
            if let Some(span) = given.free_play.as_ref().map(|given| given.span).filter(|_| play > FREE_PLAY) {
                self.warn(rule::long_free_play(span, name, rounded(play)));
            }
        }
    }

    /// Supports on which the crane would sink.
    pub(super) fn soft_feet(&mut self) {
        /// Least usual stiffness, N/m.
        const SOFTEST: f64 = 1e3;
        for support in entries(self.crane.supports.as_ref()) {
            let given = support.stiffness.value.as_ref().into_iter().flatten().map(|given| self.number(given));
            let soft = given.into_iter().find(|(stiffness, _)| *stiffness > 0.0 && *stiffness < SOFTEST);
            if let Some((stiffness, at)) = soft {
                let name = support.name.value.as_deref().unwrap_or_default();
                self.warn(rule::soft_support(at, name, rounded(stiffness)));
            }
        }
    }

    /// Gravity in another unit.
    pub(super) fn gravity(&mut self) {
        /// Largest of a planet on which cranes may stand, m/s².
        const GREATEST: f64 = 30.0;
        let Some(given) = self.crane.gravity.as_ref() else { return };
        let numbers = given.value.as_ref().into_iter().flatten().map(|number| self.number(number).0);
        let size = numbers.map(|g| g * g).sum::<f64>().sqrt();
        if size > GREATEST {
            self.warn(rule::odd_gravity(given.span, rounded(size)));
        }
    }

    /// Supports whose coefficient of friction no usual ground has.
    pub(super) fn feet(&mut self) {
        for support in entries(self.crane.supports.as_ref()) {
            let Some(given) = &support.friction_coefficient else { continue };
            let (coefficient, span) = self.number(given);
            if !(FRICTION[0]..=FRICTION[1]).contains(&coefficient) {
                let name = support.name.value.as_deref().unwrap_or_default();
                self.warn(rule::odd_friction(span, name, rounded(coefficient)));
            }
        }
    }
}
