//! Columns of A⁻¹ that lie side by side in lanes, by an inward and an outward sweep, and their products with what changes of coordinates do.

#![expect(clippy::inline_always, reason = "inlined where wider vectors are known, loops use them")]

use core::ops::Range;

use super::changes::Changes;
use super::columns::{Carried, Columns, Constant};
use super::vectors::{cross_add, cross_subtract, dot, dot_add, scaled_add, three};
use super::{Link, Own};

/// Columns that are swept together, at most.
pub const COLUMNS: usize = 32;

/// Of a coordinate, in the lanes of a unit: A⁻¹, and entries of ∂q̈/∂q and ∂q̈/∂v.
pub type Entry<C> = [<C as Columns>::Unit; 3];
/// Storage for the sweeps.
pub struct States<'a, C: Columns> {
    /// Where a sweep is: an entry for each unit of a row.
    pub now: &'a mut [Carried<C>],
    /// Where branches begin: as many for each coordinate; empty if there are none.
    pub reached: &'a mut [Carried<C>],
}

/// Places of the factors of A⁻¹.
pub(super) mod mass {
    pub const AXIS: usize = 0;
    pub const FORCE: usize = 3;
    pub const MOMENT: usize = 6;
    pub const OFFSET: usize = 9;
    pub const RECIPROCAL: usize = 12;
    /// What the coordinate answers to angular rates of the frame before it; not a factor of A⁻¹.
    pub const ANSWER: usize = 13;
}

/// The factors of a coordinate.
#[derive(Clone, Copy)]
pub struct Joint<C: Columns> {
    pub(super) own: Own<C>,
    /// Whether its point is not that of the coordinate before it.
    is_apart: bool,
    /// Whether a branch begins beyond it.
    carries: bool,
    /// Behind the last coordinate beyond it.
    pub(super) end: usize,
}

impl<C: Columns> Joint<C> {
    /// All zero.
    pub fn zero() -> Self {
        Joint { own: [C::Number::constant(0.0); 16], is_apart: false, carries: false, end: 0 }
    }

    /// Numbers of the coordinate in a lane.
    #[inline(always)]
    fn three(&self, first: usize, lane: usize) -> [C::Lane; 3] {
        three!(|k| C::lane(&self.own[first + k], lane))
    }

    /// The wrench before a coordinate from that beyond it, and `g/D` in place of r; what accelerations and rates beyond it cause.
    #[inline(always)]
    fn inward<const ROTATES: bool, const APART: bool, const CAUSES: bool>(
        &self,
        Changes { of: [by_q, by_v], .. }: &Changes<C>,
        places: &mut [Carried<C>],
        row: &mut [Entry<C>],
    ) {
        for k in 0..places.len().min(row.len()) {
            let (mut carried, [mut x, mut of_q, mut of_v]) = (places[k], row[k]);
            for lane in 0..C::WIDTH * C::STATES {
                let at = |first: usize| three!(|k| carried[first + k].as_ref()[lane]);
                let own = |first: usize| self.three(first, lane);
                let ([m, f], axis) = ([at(0), at(3)], own(mass::AXIS));
                let minus = [-axis[0], -axis[1], -axis[2]];
                let g = dot_add(minus, if ROTATES { m } else { f }, x.as_ref()[lane]);
                if CAUSES {
                    let s = at(6);
                    for (of, by) in [(&mut of_q, by_q), (&mut of_v, by_v)] {
                        let by = |first: usize| three!(|k| C::lane(&by[first + k], lane));
                        of.as_mut()[lane] = dot_add(m, by(6), dot(f, by(9))) + dot(s, by(12));
                    }
                    set::<C>(&mut carried, 6, lane, scaled_add(own(mass::ANSWER), g, s));
                }
                let (f, mut m) = (scaled_add(own(mass::FORCE), g, f), scaled_add(own(mass::MOMENT), g, m));
                if APART {
                    m = cross_add(own(mass::OFFSET), f, m);
                }
                x.as_mut()[lane] = C::lane(&self.own[mass::RECIPROCAL], lane) * g;
                set::<C>(&mut carried, 0, lane, m);
                set::<C>(&mut carried, 3, lane, f);
            }
            (places[k], row[k]) = (carried, [x, of_q, of_v]);
        }
    }

    /// The acceleration beyond a coordinate from that before it, and x in place of `g/D`; what wrenches beyond it cause.
    #[inline(always)]
    fn outward<const ROTATES: bool, const APART: bool, const CAUSES: bool>(
        &self,
        Changes { of: [by_q, by_v], .. }: &Changes<C>,
        places: &mut [Carried<C>],
        row: &mut [Entry<C>],
    ) {
        for k in 0..places.len().min(row.len()) {
            let (mut carried, [mut x, mut of_q, mut of_v]) = (places[k], row[k]);
            for lane in 0..C::WIDTH * C::STATES {
                let at = |first: usize| three!(|k| carried[first + k].as_ref()[lane]);
                let own = |first: usize| self.three(first, lane);
                let (mut angular, mut linear) = (at(0), at(3));
                if APART {
                    linear = cross_subtract(own(mass::OFFSET), angular, linear);
                }
                let minus = |[x, y, z]: [C::Lane; 3]| [-x, -y, -z];
                let by_moment = dot_add(minus(own(mass::MOMENT)), angular, x.as_ref()[lane]);
                let found = by_moment + dot(minus(own(mass::FORCE)), linear);
                x.as_mut()[lane] = found;
                let moved = if ROTATES { &mut angular } else { &mut linear };
                *moved = scaled_add(own(mass::AXIS), found, *moved);
                if CAUSES {
                    for (of, by) in [(&mut of_q, by_q), (&mut of_v, by_v)] {
                        let by = |first: usize| three!(|k| C::lane(&by[first + k], lane));
                        let entry = &mut of.as_mut()[lane];
                        *entry = dot_add(angular, by(0), *entry) + dot(linear, by(3));
                    }
                }
                if ROTATES {
                    set::<C>(&mut carried, 0, lane, angular);
                }
                if APART || !ROTATES {
                    set::<C>(&mut carried, 3, lane, linear);
                }
            }
            (places[k], row[k]) = (carried, [x, of_q, of_v]);
        }
    }
}

/// Writes three numbers of a lane.
#[inline(always)]
fn set<C: Columns>(carried: &mut Carried<C>, first: usize, lane: usize, numbers: [C::Lane; 3]) {
    for k in 0..3 {
        carried[first + k].as_mut()[lane] = numbers[k];
    }
}

/// Calls one of the forms of a loop.
macro_rules! formed {
    ($joint:ident.$pass:ident::<$causes:ident>($rotates:expr) $arguments:tt) => {
        match ($rotates, $joint.is_apart) {
            (true, true) => formed!(@ $joint.$pass::<true, true, $causes> $arguments),
            (true, false) => formed!(@ $joint.$pass::<true, false, $causes> $arguments),
            (false, true) => formed!(@ $joint.$pass::<false, true, $causes> $arguments),
            (false, false) => formed!(@ $joint.$pass::<false, false, $causes> $arguments),
        }
    };
    (@ $joint:ident.$pass:ident::<$rotates:literal, $apart:literal, $causes:ident> ($($argument:expr),*)) => {
        $joint.$pass::<$rotates, $apart, $causes>($($argument),*)
    };
}

/// The sweeps.
pub(super) struct Sweeps<'a, C: Columns> {
    pub(super) links: &'a [Link],
    pub(super) joints: &'a mut [Joint<C>],
}

impl<'a, C: Columns> Sweeps<'a, C> {
    /// `factors`: those of [`mass_factors`](crate::CraneModel::mass_factors), row by row.
    #[inline(always)]
    pub(super) fn new(links: &'a [Link], factors: &[C::Number], joints: &'a mut [Joint<C>]) -> Self {
        for j in 0..links.len() {
            let Some(joint) = joints.get_mut(j) else { break };
            for index in 0..mass::ANSWER {
                if let Some(factor) = factors.get(index * links.len() + j) {
                    joint.own[index] = *factor;
                }
            }
        }
        for (j, joint) in joints.iter_mut().enumerate() {
            joint.is_apart = !joint.own[mass::OFFSET..mass::OFFSET + 3].iter().all(Constant::is_zero);
            (joint.carries, joint.end) = (false, j + 1);
        }
        for (j, link) in links.iter().enumerate().rev() {
            let end = joints.get(j).map_or(0, |joint| joint.end);
            if let Some(joint) = link.before.and_then(|before| joints.get_mut(before)) {
                joint.end = joint.end.max(end);
                joint.carries |= !link.continues(j);
            }
        }
        Sweeps { links, joints }
    }

    /// From the last of some coordinates to the first: `g/D` in place of r, and what accelerations and rates beyond each coordinate cause, if
    /// there are `changes`. `units`: those in which r of what is beyond a coordinate is not zero; changes that are `giving` way see the
    /// wrench that arrives there.
    #[inline(always)]
    pub(super) fn inward<const CAUSES: bool>(
        &self,
        coordinates: Range<usize>,
        units: impl Fn(usize) -> Range<usize>,
        swept: &mut [Entry<C>],
        States { now, reached }: &mut States<'_, C>,
        changes: &[Changes<C>],
        giving: &mut [Changes<C>],
    ) {
        let (stride, none) = (now.len(), Changes::zero());
        for j in coordinates.clone().filter(|j| self.joints.get(*j).is_some_and(|joint| joint.carries)) {
            clear::<C>(part(reached, stride, j, &(0..stride)));
        }
        clear::<C>(now);
        for j in coordinates.rev() {
            let (Some(link), Some(joint), units) = (self.links.get(j), self.joints.get(j), units(j)) else { continue };
            let wrench = now.get_mut(units.clone()).unwrap_or_default();
            if joint.carries {
                add::<C>(wrench, part(reached, stride, j, &units));
            }
            if let (false, Some(change)) = (CAUSES, giving.get_mut(j)) {
                change.give_way(wrench);
            }
            let (change, row) = (changes.get(j).unwrap_or(&none), part(swept, stride, j, &units));
            formed!(joint.inward::<CAUSES>(link.rotates)(change, wrench, row));
            if !link.continues(j) {
                if let Some(before) = link.before {
                    add::<C>(part(reached, stride, before, &units), wrench);
                }
                clear::<C>(wrench);
            }
        }
    }

    /// From the first of some coordinates to the last: x in place of `g/D`, and what wrenches beyond each coordinate cause, if there are `changes`.
    #[inline(always)]
    pub(super) fn outward<const CAUSES: bool>(
        &self,
        coordinates: Range<usize>,
        units: &Range<usize>,
        swept: &mut [Entry<C>],
        States { now, reached }: &mut States<'_, C>,
        changes: &[Changes<C>],
    ) {
        let (stride, none) = (now.len(), Changes::zero());
        let accelerations = now.get_mut(units.clone()).unwrap_or_default();
        clear::<C>(accelerations);
        for j in coordinates {
            let (Some(link), Some(joint)) = (self.links.get(j), self.joints.get(j)) else { continue };
            if !link.continues(j) {
                match link.before {
                    Some(before) => copy::<C>(part(reached, stride, before, units), accelerations),
                    None => clear::<C>(accelerations),
                }
            }
            let (change, row) = (changes.get(j).unwrap_or(&none), part(swept, stride, j, units));
            formed!(joint.outward::<CAUSES>(link.rotates)(change, accelerations, row));
            if joint.carries {
                copy::<C>(accelerations, part(reached, stride, j, units));
            }
        }
    }
}

/// Some units of a row.
#[inline(always)]
pub(super) fn part<'a, T>(rows: &'a mut [T], stride: usize, row: usize, units: &Range<usize>) -> &'a mut [T] {
    rows.get_mut(row * stride + units.start..row * stride + units.end).unwrap_or_default()
}

#[inline(always)]
fn clear<C: Columns>(carried: &mut [Carried<C>]) {
    for k in 0..carried.len() {
        carried[k] = [C::zero(); 9];
    }
}

#[inline(always)]
#[expect(clippy::manual_memcpy, reason = "short: a call would take longer than the loop")]
fn copy<C: Columns>(from: &[Carried<C>], to: &mut [Carried<C>]) {
    for k in 0..from.len().min(to.len()) {
        to[k] = from[k];
    }
}

#[inline(always)]
fn add<C: Columns>(places: &mut [Carried<C>], other: &[Carried<C>]) {
    for k in 0..places.len().min(other.len()) {
        let (mut sums, others) = (places[k], other[k]);
        for index in 0..9 {
            for lane in 0..C::WIDTH * C::STATES {
                sums[index].as_mut()[lane] = sums[index].as_ref()[lane] + others[index].as_ref()[lane];
            }
        }
        places[k] = sums;
    }
}
