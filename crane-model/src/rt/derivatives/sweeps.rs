//! Solutions of `A x = r` for columns r that lie side by side in lanes, by an inward and an outward sweep.
//!
//! Plain loops over the lanes: the compiler makes vectors of them, as wide as the target has.

#![expect(clippy::inline_always, reason = "inlined where wider vectors are known, loops use them")]

use core::ops::Range;

use super::columns::{Columns, Constant};
use super::vectors::zero;
use super::{Link, Own};
use crate::rt::fused::fma;

/// Lanes of a row, at most.
pub(super) const LANES: usize = 48;
/// How many lanes make a vector; the compiler knows that there is no part of one.
pub(super) const fn unit<C: Columns>() -> usize {
    if C::WIDTH == 1 { 1 } else { 8 }
}

/// The numbers of a coordinate in all lanes.
pub type Row<C> = [<C as Columns>::Number; LANES];
/// Moment and force; or angular and linear acceleration, and rates of which coordinates beyond know the effect: x, y and z of each, in all lanes.
pub type Lanes<C> = [Row<C>; 9];

/// Storage for the sweeps.
pub struct States<'a, C: Columns> {
    /// Where a sweep is.
    pub now: &'a mut Lanes<C>,
    /// Where branches begin: an entry for each coordinate; empty if there are none.
    pub reached: &'a mut [Lanes<C>],
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
    /// Whether a branch begins at it.
    carries: bool,
}

impl<C: Columns> Joint<C> {
    /// All zero.
    pub fn zero() -> Self {
        Joint { own: [zero::<C>(); 16], is_apart: false, carries: false }
    }

    #[inline(always)]
    pub(super) fn three(&self, first: usize) -> [C::Number; 3] {
        let at = |place: usize| self.own.get(place).copied().unwrap_or(zero::<C>());
        [at(first), at(first + 1), at(first + 2)]
    }

    #[inline(always)]
    fn minus(&self, first: usize) -> [C::Number; 3] {
        let [x, y, z] = self.three(first);
        [-x, -y, -z]
    }

    /// The wrench before a coordinate from that beyond it, and `g/D` in place of r.
    #[inline(always)]
    fn inward<const ROTATES: bool, const APART: bool>(&self, wrench: &mut Lanes<C>, row: &mut Row<C>, units: usize) {
        let axis = self.minus(mass::AXIS);
        let (of_force, of_moment) = (self.three(mass::FORCE), self.three(mass::MOMENT));
        let (d, back) = (self.three(mass::OFFSET), self.minus(mass::OFFSET));
        let [reciprocal, ..] = self.three(mass::RECIPROCAL);
        let [m0, m1, m2, f0, f1, f2, ..] = wrench;
        for k in 0..unit::<C>() * units.min(LANES / unit::<C>()) {
            let (m, f) = ([m0[k], m1[k], m2[k]], [f0[k], f1[k], f2[k]]);
            let along = if ROTATES { m } else { f };
            let g = fma(axis[0], along[0], fma(axis[1], along[1], fma(axis[2], along[2], row[k])));
            let f = [fma(of_force[0], g, f[0]), fma(of_force[1], g, f[1]), fma(of_force[2], g, f[2])];
            let mut m = [fma(of_moment[0], g, m[0]), fma(of_moment[1], g, m[1]), fma(of_moment[2], g, m[2])];
            if APART {
                m = [
                    fma(d[1], f[2], fma(back[2], f[1], m[0])),
                    fma(d[2], f[0], fma(back[0], f[2], m[1])),
                    fma(d[0], f[1], fma(back[1], f[0], m[2])),
                ];
            }
            row[k] = reciprocal * g;
            [m0[k], m1[k], m2[k]] = m;
            [f0[k], f1[k], f2[k]] = f;
        }
    }

    /// The acceleration beyond a coordinate from that before it, and x in place of `g/D`.
    #[inline(always)]
    fn outward<const ROTATES: bool, const APART: bool>(
        &self,
        has_rates: bool,
        accelerations: &mut Lanes<C>,
        row: &mut Row<C>,
        units: usize,
    ) {
        let axis = self.three(mass::AXIS);
        let (of_force, of_moment) = (self.minus(mass::FORCE), self.minus(mass::MOMENT));
        let (d, back) = (self.three(mass::OFFSET), self.minus(mass::OFFSET));
        let answer = self.three(mass::ANSWER);
        let [a0, a1, a2, l0, l1, l2, s0, s1, s2] = accelerations;
        for k in 0..unit::<C>() * units.min(LANES / unit::<C>()) {
            let (angular, mut linear) = ([a0[k], a1[k], a2[k]], [l0[k], l1[k], l2[k]]);
            if APART {
                linear = [
                    fma(back[1], angular[2], fma(d[2], angular[1], linear[0])),
                    fma(back[2], angular[0], fma(d[0], angular[2], linear[1])),
                    fma(back[0], angular[1], fma(d[1], angular[0], linear[2])),
                ];
            }
            let mut x = row[k];
            if has_rates {
                x = fma(answer[0], s0[k], fma(answer[1], s1[k], fma(answer[2], s2[k], x)));
            }
            x = fma(of_moment[0], angular[0], fma(of_moment[1], angular[1], fma(of_moment[2], angular[2], x)));
            x = x + fma(of_force[0], linear[0], fma(of_force[1], linear[1], of_force[2] * linear[2]));
            row[k] = x;
            if ROTATES {
                [a0[k], a1[k], a2[k]] =
                    [fma(axis[0], x, angular[0]), fma(axis[1], x, angular[1]), fma(axis[2], x, angular[2])];
            } else {
                linear = [fma(axis[0], x, linear[0]), fma(axis[1], x, linear[1]), fma(axis[2], x, linear[2])];
            }
            if APART || !ROTATES {
                [l0[k], l1[k], l2[k]] = linear;
            }
        }
    }
}

/// Calls one of the forms of a loop.
macro_rules! formed {
    ($joint:ident.$pass:ident($rotates:expr) $arguments:tt) => {
        match ($rotates, $joint.is_apart) {
            (true, true) => formed!(@ $joint.$pass::<true, true> $arguments),
            (true, false) => formed!(@ $joint.$pass::<true, false> $arguments),
            (false, true) => formed!(@ $joint.$pass::<false, true> $arguments),
            (false, false) => formed!(@ $joint.$pass::<false, false> $arguments),
        }
    };
    (@ $joint:ident.$pass:ident::<$rotates:literal, $apart:literal> ($($argument:expr),*)) => {
        $joint.$pass::<$rotates, $apart>($($argument),*)
    };
}

/// What happens on the way.
pub(super) trait Visit<C: Columns> {
    /// The wrench arrives at a coordinate.
    fn enter(&mut self, j: usize, wrench: &mut Lanes<C>);
    /// The acceleration beyond a coordinate is known.
    fn leave(&mut self, j: usize, accelerations: &mut Lanes<C>);
}

/// Nothing happens.
pub(super) struct Nothing;

impl<C: Columns> Visit<C> for Nothing {
    #[inline(always)]
    fn enter(&mut self, _: usize, _: &mut Lanes<C>) {}
    #[inline(always)]
    fn leave(&mut self, _: usize, _: &mut Lanes<C>) {}
}

/// The sweeps.
pub(super) struct Sweeps<'a, C: Columns> {
    pub(super) links: &'a [Link],
    pub(super) joints: &'a mut [Joint<C>],
}

impl<'a, C: Columns> Sweeps<'a, C> {
    /// `factors`: those of [`mass_factors`](crate::MotionDerivatives::mass_factors), row by row.
    #[inline(always)]
    pub(super) fn new(links: &'a [Link], factors: &[C::Number], joints: &'a mut [Joint<C>]) -> Self {
        for (place, row) in factors.chunks_exact(links.len().max(1)).enumerate() {
            for (joint, factor) in joints.iter_mut().zip(row) {
                if let Some(number) = joint.own.get_mut(place) {
                    *number = *factor;
                }
            }
        }
        for joint in &mut *joints {
            joint.is_apart = !joint.three(mass::OFFSET).iter().all(Constant::is_zero);
            joint.carries = false;
        }
        for (_, link) in links.iter().enumerate().filter(|(place, link)| !link.continues(*place)) {
            if let Some(joint) = link.before.and_then(|before| joints.get_mut(before)) {
                joint.carries = true;
            }
        }
        Sweeps { links, joints }
    }

    /// From the last of some coordinates to the first: `g/D` in place of r. `enter` may add to the wrench that arrives at a coordinate.
    #[inline(always)]
    pub(super) fn inward(
        &self,
        coordinates: Range<usize>,
        rows: &mut [Row<C>],
        units: usize,
        States { now, reached }: &mut States<'_, C>,
        visit: &mut impl Visit<C>,
    ) {
        let wrench = &mut **now;
        for j in coordinates.start..coordinates.end {
            if let (Some(Joint { carries: true, .. }), Some(state)) = (self.joints.get(j), reached.get_mut(j)) {
                clear::<C>(state, units);
            }
        }
        clear::<C>(wrench, units);
        for j in (coordinates.start..coordinates.end).rev() {
            let (Some(link), Some(joint), Some(row)) = (self.links.get(j), self.joints.get(j), rows.get_mut(j)) else {
                continue;
            };
            if joint.carries
                && let Some(brought) = reached.get(j)
            {
                add::<C>(wrench, brought, units);
            }
            visit.enter(j, wrench);
            formed!(joint.inward(link.rotates)(wrench, row, units));
            if !link.continues(j) {
                if let Some(brought) = link.before.and_then(|before| reached.get_mut(before)) {
                    add::<C>(brought, wrench, units);
                }
                clear::<C>(wrench, units);
            }
        }
    }

    /// From the first of some coordinates to the last: x in place of `g/D`. `leave` may add to the accelerations and
    /// rates beyond a coordinate.
    #[inline(always)]
    pub(super) fn outward(
        &self,
        coordinates: Range<usize>,
        has_rates: bool,
        rows: &mut [Row<C>],
        units: usize,
        States { now, reached }: &mut States<'_, C>,
        visit: &mut impl Visit<C>,
    ) {
        let accelerations = &mut **now;
        clear::<C>(accelerations, units);
        for j in coordinates.start..coordinates.end {
            let (Some(link), Some(joint), Some(row)) = (self.links.get(j), self.joints.get(j), rows.get_mut(j)) else {
                continue;
            };
            if !link.continues(j) {
                match link.before.and_then(|before| reached.get(before)) {
                    Some(state) => copy::<C>(state, accelerations, units),
                    None => clear::<C>(accelerations, units),
                }
            }
            formed!(joint.outward(link.rotates)(has_rates, accelerations, row, units));
            visit.leave(j, accelerations);
            if joint.carries
                && let Some(state) = reached.get_mut(j)
            {
                copy::<C>(accelerations, state, units);
            }
        }
    }
}

#[inline(always)]
fn clear<C: Columns>(state: &mut Lanes<C>, units: usize) {
    for row in state {
        for k in 0..unit::<C>() * units.min(LANES / unit::<C>()) {
            row[k] = zero::<C>();
        }
    }
}

#[inline(always)]
#[expect(clippy::manual_memcpy, reason = "short: a call would take longer than the loop")]
fn copy<C: Columns>(from: &Lanes<C>, to: &mut Lanes<C>, units: usize) {
    for (from, to) in from.iter().zip(to) {
        for k in 0..unit::<C>() * units.min(LANES / unit::<C>()) {
            to[k] = from[k];
        }
    }
}

#[inline(always)]
fn add<C: Columns>(sum: &mut Lanes<C>, other: &Lanes<C>, units: usize) {
    for (sum, other) in sum.iter_mut().zip(other).take(6) {
        for k in 0..unit::<C>() * units.min(LANES / unit::<C>()) {
            sum[k] = sum[k] + other[k];
        }
    }
}
