//! What changes of coordinates and of their rates do to accelerations.
//!
//! While coordinates hold, a change of `q_j` accelerates everything beyond by `Ω̈_j` and requires a wrench there; one of `q̇_j` by `2 Ω̇_j`. What is beyond
//! gives way: by its articulated instead of its composite inertia, and to the rates `2 ω̇_j` or `2 ω_j`, to which each coordinate k beyond has one answer for
//! all j, the solution of an inward sweep for `z_k`. So a column of `−A⁻¹ ∂r` needs no column of ∂r: a wrench enters the inward sweep at j,
//! and the acceleration enters the outward sweep there.

#![expect(clippy::inline_always, reason = "inlined where wider vectors are known, loops use them")]

use super::columns::Columns;
use super::residual::own;
use super::sweeps::{Lanes, Row, States, Sweeps, Visit, mass, unit};
use super::vectors::zero;
use super::{Link, Own};
use crate::rt::fused::fma;

/// Moment and force, angular and linear acceleration, and twice the angular rates, of a change of one coordinate and of its rate.
#[derive(Clone, Copy)]
pub struct Changes<C: Columns> {
    pub(super) of_q: [C::Number; 15],
    pub(super) of_v: [C::Number; 15],
    /// The coordinate's point.
    point: [C::Number; 3],
}

impl<C: Columns> Changes<C> {
    /// All zero.
    pub fn zero() -> Self {
        Changes { of_q: [zero::<C>(); 15], of_v: [zero::<C>(); 15], point: [zero::<C>(); 3] }
    }

    /// From the world's origin to the point; `wrench`: what arrives there for unit accelerations and rates.
    #[inline(always)]
    fn give_way(&mut self, wrench: &Lanes<C>) {
        let [x, y, z] = self.point;
        let [minus_x, minus_y, minus_z] = [-x, -y, -z];
        for of in [&mut self.of_q, &mut self.of_v] {
            let [m0, m1, m2, f0, f1, f2, a0, a1, a2, l0, l1, l2, s0, s1, s2] = *of;
            let mut at_point = [
                fma(minus_y, f2, fma(z, f1, m0)),
                fma(minus_z, f0, fma(x, f2, m1)),
                fma(minus_x, f1, fma(y, f0, m2)),
                f0,
                f1,
                f2,
            ];
            let units = [-l0, -l1, -l2, -a0, -a1, -a2, -s0, -s1, -s2];
            for component in 0..6 {
                for unit in 0..9 {
                    at_point[component] = fma(units[unit], wrench[component][unit], at_point[component]);
                }
            }
            let [m0, m1, m2, f0, f1, f2] = at_point;
            // ω × p = −p × ω
            let [l0, l1, l2] =
                [fma(minus_y, a2, fma(z, a1, l0)), fma(minus_z, a0, fma(x, a2, l1)), fma(minus_x, a1, fma(y, a0, l2))];
            *of = [m0, m1, m2, f0, f1, f2, a0, a1, a2, l0, l1, l2, -s0, -s1, -s2];
        }
    }
}

/// Changes that enter the sweeps, each in its lane: those of coordinates before those of rates.
pub(super) struct Entering<'a, C: Columns> {
    pub(super) changes: &'a [Changes<C>],
    /// The first coordinate, and how many there are.
    pub(super) first: usize,
    pub(super) width: usize,
}

impl<C: Columns> Entering<'_, C> {
    /// Adds numbers of a coordinate, from one of them on, to components.
    #[inline(always)]
    fn add<const COUNT: usize>(&self, j: usize, from: usize, components: &mut Lanes<C>) {
        let lane = j.wrapping_sub(self.first);
        if lane >= self.width {
            return;
        }
        let Some(change) = self.changes.get(j) else { return };
        for k in 0..COUNT {
            for (lane, of) in [(lane, &change.of_q), (lane + self.width, &change.of_v)] {
                if let (Some(sum), Some(number)) = (components[k].get_mut(lane), of.get(from + k)) {
                    *sum = *sum + *number;
                }
            }
        }
    }
}

impl<C: Columns> Visit<C> for Entering<'_, C> {
    #[inline(always)]
    fn enter(&mut self, j: usize, wrench: &mut Lanes<C>) {
        self.add::<6>(j, 0, wrench);
    }

    #[inline(always)]
    fn leave(&mut self, j: usize, accelerations: &mut Lanes<C>) {
        self.add::<9>(j, 6, accelerations);
    }
}

/// Changes to which what arrives at the coordinates gives way.
struct GiveWay<'a, C: Columns>(&'a mut [Changes<C>]);

impl<C: Columns> Visit<C> for GiveWay<'_, C> {
    #[inline(always)]
    fn enter(&mut self, j: usize, wrench: &mut Lanes<C>) {
        if let Some(change) = self.0.get_mut(j) {
            change.give_way(wrench);
        }
    }

    #[inline(always)]
    fn leave(&mut self, _: usize, _: &mut Lanes<C>) {}
}

/// Gives the changes and the coordinates what follows from the way in which everything beyond gives way. `rows`: those of the derivatives of the residual.
#[inline(always)]
pub(super) fn give_way<C: Columns>(
    sweeps: &mut Sweeps<'_, C>,
    rows: &[Own<C>],
    changes: &mut [Changes<C>],
    swept: &mut [Row<C>],
    states: &mut States<'_, C>,
) {
    let n = sweeps.links.len();
    for (j, Link { before, .. }) in sweeps.links.iter().enumerate() {
        let from = before.and_then(|before| changes.get(before)).map_or([zero::<C>(); 3], |change| change.point);
        if let (Some(change), Some(joint)) = (changes.get_mut(j), sweeps.joints.get(j)) {
            let offset = joint.three(mass::OFFSET);
            change.point = [from[0] + offset[0], from[1] + offset[1], from[2] + offset[2]];
        }
    }
    for (row, own) in swept.iter_mut().zip(rows) {
        row.iter_mut().zip(own.iter().skip(own::LINEAR_MOMENTUM).take(9)).for_each(|(lane, number)| *lane = *number);
    }
    sweeps.inward(0..n, swept, 9usize.div_ceil(unit::<C>()), states, &mut GiveWay(changes));
    for (joint, row) in sweeps.joints.iter_mut().zip(swept) {
        joint.own.iter_mut().skip(mass::ANSWER).zip(row.iter().skip(6)).for_each(|(place, answer)| *place = *answer);
    }
}
