//! Inverse mass matrices times columns, by an inward and an outward sweep.

use super::columns::{Columns, Constant};
use super::vectors::{Six, cross_add, dot, dot_add, nothing, scaled_add, sum, zero};
use super::{Link, Own, has_branches, minus, store, three};

/// Places of the factors of A⁻¹.
mod mass {
    pub const AXIS: usize = 0;
    pub const FORCE: usize = 3;
    pub const MOMENT: usize = 6;
    pub const OFFSET: usize = 9;
    pub const RECIPROCAL: usize = 12;
}

/// The sweeps.
pub(super) struct Sweeps<'a, C: Columns> {
    links: &'a [Link],
    joints: &'a [(Own<C>, bool)],
    /// Whether some coordinate is not attached to the one in front of it.
    branches: bool,
}

impl<'a, C: Columns> Sweeps<'a, C> {
    /// `factors`: those of [`mass_factors`](crate::MotionDerivatives::mass_factors), row by row.
    pub(super) fn new(links: &'a [Link], factors: &[C::Number], joints: &'a mut [(Own<C>, bool)]) -> Self {
        for (place, row) in factors.chunks_exact(links.len().max(1)).enumerate() {
            for ((joint, _), factor) in joints.iter_mut().zip(row) {
                if let Some(number) = joint.get_mut(place) {
                    *number = *factor;
                }
            }
        }
        for (joint, apart) in &mut *joints {
            *apart = !joint[mass::OFFSET..mass::RECIPROCAL].iter().all(Constant::is_zero);
        }
        Sweeps { links, joints, branches: has_branches(links) }
    }

    /// `A⁻¹ r` of columns r whose entries from `end` on are zero. `states`: an entry for each coordinate if there are branches.
    #[inline]
    pub(super) fn solve(&self, columns: &mut [C::Block], end: usize, states: &mut [Six<C>]) {
        if self.branches {
            self.sweep::<true>(columns, end, states);
        } else {
            self.sweep::<false>(columns, end, states);
        }
    }

    fn sweep<const BRANCHES: bool>(&self, columns: &mut [C::Block], end: usize, states: &mut [Six<C>]) {
        states.fill(nothing::<C>());
        let mut wrench = nothing::<C>();
        for (j, ((link, (own, apart)), entry)) in
            self.links.iter().zip(self.joints).zip(&mut *columns).enumerate().take(end).rev()
        {
            if BRANCHES && let Some(brought) = states.get(j) {
                wrench = sum::<C>(wrench, *brought);
            }
            let [moment, force] = wrench;
            let along = if link.rotates { moment } else { force };
            let g = dot_add::<C>(minus::<C>(own, mass::AXIS), along, *entry);
            let force = scaled_add::<C>(three::<C>(own, mass::FORCE), g, force);
            let mut moment = scaled_add::<C>(three::<C>(own, mass::MOMENT), g, moment);
            if *apart {
                let offset = [three::<C>(own, mass::OFFSET), minus::<C>(own, mass::OFFSET)];
                moment = cross_add::<C>(offset, force, moment);
            }
            *entry = C::splat(own[mass::RECIPROCAL]) * g;
            wrench = [moment, force];
            if BRANCHES && !link.continues(j) {
                if let Some(brought) = link.before.and_then(|before| states.get_mut(before)) {
                    *brought = sum::<C>(*brought, wrench);
                }
                wrench = nothing::<C>();
            }
        }
        let mut accelerations = nothing::<C>();
        for (j, ((link, (own, apart)), entry)) in self.links.iter().zip(self.joints).zip(columns).enumerate() {
            if BRANCHES && !link.continues(j) {
                let reached = link.before.and_then(|before| states.get(before));
                accelerations = reached.copied().unwrap_or(nothing::<C>());
            }
            let [angular, mut linear] = accelerations;
            let of_angular = dot_add::<C>(minus::<C>(own, mass::MOMENT), angular, *entry);
            if *apart {
                let back = [minus::<C>(own, mass::OFFSET), three::<C>(own, mass::OFFSET)];
                linear = cross_add::<C>(back, angular, linear);
            }
            *entry = of_angular + dot::<C>(minus::<C>(own, mass::FORCE), linear);
            let axis = three::<C>(own, mass::AXIS);
            accelerations = if link.rotates {
                [scaled_add::<C>(axis, *entry, angular), linear]
            } else {
                [angular, scaled_add::<C>(axis, *entry, linear)]
            };
            if BRANCHES && let Some(state) = states.get_mut(j) {
                *state = accelerations;
            }
        }
    }

    /// A⁻¹, row by row.
    pub(super) fn invert(&self, columns: &mut [C::Block], states: &mut [Six<C>], inverse: &mut [C::Number]) {
        let n = self.links.len();
        for first in (0..n).step_by(C::WIDTH) {
            columns.fill(C::splat(zero::<C>()));
            columns.iter_mut().skip(first).take(C::WIDTH).enumerate().for_each(|(k, column)| *column = C::unit(k));
            self.solve(columns, n.min(first + C::WIDTH), states);
            store::<C>(columns, first, inverse);
        }
    }
}
