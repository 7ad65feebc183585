//! One-sided supports compared with the weight that they carry.

use super::{Plausibility, items, rounded};
use crate::diagnostic::rule;

impl Plausibility<'_> {
    /// Supports whose full hold exceeds their share of the crane's weight: they hold the crane only in part.
    pub(super) fn feet(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        let mass: f64 = chain.bodies.iter().filter_map(|body| Some(body.inertia.as_ref()?.mass.at(&self.values))).sum();
        let gravity = chain.gravity[2].at(&self.values).abs();
        let share = mass * gravity / chain.supports.len().max(1) as f64;
        for support in items(crane.supports.as_ref()) {
            let Some(full_hold) = &support.full_hold else { continue };
            let (force, at) = self.number(full_hold);
            if force > share {
                let name = support.name.value.as_deref().unwrap_or_default();
                self.warn(rule::hold_beyond_weight(at, name, rounded(force), rounded(share)));
            }
        }
    }
}
