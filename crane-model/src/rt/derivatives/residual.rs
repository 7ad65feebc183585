//! Derivatives of the residual, from vectors of each coordinate.

#![expect(clippy::inline_always, reason = "results of more numbers than registers would go through memory")]

use super::changes::Changes;
use super::columns::{Columns, Constant};
use super::vectors::{Six, Three, both, commutator_add, cross_add, dot, dot_add, nothing, one, plus, scaled_add, zero};
use super::{Link, Own, three};

/// First rows of the vectors of [`residual_factors`](crate::MotionDerivatives::residual_factors).
mod rows {
    pub const OMEGA: usize = 0;
    pub const UPSILON: usize = 3;
    /// Ω̇
    pub const FIRST_OMEGA: usize = 6;
    pub const FIRST_UPSILON: usize = 9;
    /// V before the coordinate's own motion, V̇ − γ, and what a rotation vector adds to Ω̈.
    pub const VELOCITY: [usize; 2] = [12, 15];
    pub const RATE: [usize; 2] = [18, 21];
    pub const ADDED: [usize; 2] = [24, 27];
    /// First moments, and rows of the inertia.
    pub const MOMENTS: usize = 30;
    pub const INERTIA: [usize; 3] = [33, 36, 39];
    /// tr(G) 1 − G, row by row, and the momentum.
    pub const TURNING: [usize; 3] = [42, 45, 48];
    pub const MOMENTUM: usize = 51;
    /// F
    pub const FORCE: usize = 54;
    pub const MOMENT: usize = 57;
    pub const MASS: usize = 60;
    /// Entries to be added, from the second diagonal below the main one to the second above it.
    pub const DIAGONALS: usize = 61;
}

/// Places of the numbers of a row.
pub(super) mod own {
    pub const OMEGA: usize = 0;
    pub const UPSILON: usize = 3;
    pub const LINEAR_MOMENTUM: usize = 6;
    pub const ANGULAR_MOMENTUM: usize = 9;
    pub const HALF_GYRATION: usize = 12;
}

/// The inertia of everything beyond some coordinates, and the motion of this inertia.
struct Beyond<C: Columns> {
    mass: C::Block,
    moments: [Three<C>; 2],
    inertia: [Three<C>; 3],
    turning: [Three<C>; 3],
    momentum: Three<C>,
}

impl<C: Columns> Beyond<C> {
    /// Force and moment `Ω W + c`.
    #[inline(always)]
    fn momenta_add(&self, [omega, upsilon]: Six<C>, [force, moment]: Six<C>) -> Six<C> {
        let [moments, minus] = self.moments;
        let force = cross_add::<C>([minus, moments], omega, scaled_add::<C>(upsilon, self.mass, force));
        let moment = cross_add::<C>(self.moments, upsilon, moment);
        let [x, y, z] = self.inertia;
        let moment =
            [dot_add::<C>(x, omega, moment[0]), dot_add::<C>(y, omega, moment[1]), dot_add::<C>(z, omega, moment[2])];
        [force, moment]
    }

    /// `∫ s × ẋ dm` and its moment.
    #[inline(always)]
    fn turn(&self, s: Three<C>) -> Six<C> {
        let zero = [C::splat(zero::<C>()); 3];
        let [x, y, z] = self.turning;
        let force = cross_add::<C>(both::<C>(s), self.momentum, zero);
        [force, [dot::<C>(x, s), dot::<C>(y, s), dot::<C>(z, s)]]
    }
}

/// Vectors of some columns.
struct Vectors<C: Columns> {
    /// Ω̈ W + 2 Ω̇ G + Ω × F, force and moment.
    turning: Six<C>,
    /// 2 (Ω̇ W + Ω G), force and moment.
    with_rate: Six<C>,
    second: Six<C>,
    twice_first: Six<C>,
    twice_omega: Three<C>,
}

/// The derivatives of a residual.
pub(super) struct Slopes<'a, C: Columns> {
    links: &'a [Link],
    factors: &'a [C::Number],
    pub(super) rows: &'a [Own<C>],
    paths: &'a [C::Number],
}

impl<'a, C: Columns> Slopes<'a, C> {
    pub(super) fn new(
        links: &'a [Link],
        factors: &'a [C::Number],
        rows: &'a mut [Own<C>],
        paths: &'a [C::Number],
    ) -> Self {
        let mut slopes = Slopes { links, factors, rows: &[], paths };
        for first in (0..links.len()).step_by(C::WIDTH) {
            let (beyond, [omega, upsilon]) = (slopes.beyond(first), slopes.generators(first));
            let [p, l] = beyond.momenta_add([omega, upsilon], nothing::<C>());
            let [x, y, z] = beyond.turning;
            let turned = scaled_add::<C>(
                x,
                omega[0],
                scaled_add::<C>(y, omega[1], scaled_add::<C>(z, omega[2], [C::splat(zero::<C>()); 3])),
            );
            let half = cross_add::<C>(both::<C>(beyond.momentum), upsilon, turned);
            let mut scratch = [zero::<C>(); 16];
            let vectors = [omega, upsilon, p, l, half];
            for place in 0..15 {
                C::store(vectors[place / 3][place % 3], &mut scratch);
                for column in 0..C::WIDTH {
                    let Some(own) = rows.get_mut(first + column) else { break };
                    own[place] = scratch[column];
                }
            }
        }
        slopes.rows = rows;
        slopes
    }

    #[inline(always)]
    fn block(&self, row: usize, first: usize) -> C::Block {
        C::load(self.factors.get(row * self.links.len() + first..).unwrap_or_default())
    }

    #[inline(always)]
    fn three(&self, row: usize, first: usize) -> Three<C> {
        [self.block(row, first), self.block(row + 1, first), self.block(row + 2, first)]
    }

    #[inline(always)]
    fn six(&self, rows: [usize; 2], first: usize) -> Six<C> {
        [self.three(rows[0], first), self.three(rows[1], first)]
    }

    #[inline(always)]
    fn generators(&self, first: usize) -> Six<C> {
        self.six([rows::OMEGA, rows::UPSILON], first)
    }

    #[inline(always)]
    fn beyond(&self, first: usize) -> Beyond<C> {
        let three = |row: usize| self.three(row, first);
        let [ix, iy, iz] = rows::INERTIA;
        let [gx, gy, gz] = rows::TURNING;
        Beyond {
            mass: self.block(rows::MASS, first),
            moments: both::<C>(three(rows::MOMENTS)),
            inertia: [three(ix), three(iy), three(iz)],
            turning: [three(gx), three(gy), three(gz)],
            momentum: three(rows::MOMENTUM),
        }
    }

    #[inline(always)]
    fn vectors(&self, first: usize) -> Vectors<C> {
        let twice = |of: Three<C>| plus::<C>(of, of);
        let beyond = self.beyond(first);
        let generator = self.generators(first);
        let own_first = self.six([rows::FIRST_OMEGA, rows::FIRST_UPSILON], first);
        let twice_first = [twice(own_first[0]), twice(own_first[1])];
        let twice_omega = twice(generator[0]);
        let of_first = commutator_add::<C>(self.six(rows::VELOCITY, first), own_first, self.six(rows::ADDED, first));
        let second = commutator_add::<C>(self.six(rows::RATE, first), generator, of_first);
        let force = self.three(rows::FORCE, first);
        let omega = both::<C>(generator[0]);
        let [turned_force, turned_moment] = beyond.momenta_add(second, beyond.turn(twice_first[0]));
        let turned_moment = cross_add::<C>(omega, self.three(rows::MOMENT, first), turned_moment);
        let turning =
            [cross_add::<C>(omega, force, turned_force), cross_add::<C>(both::<C>(generator[1]), force, turned_moment)];
        let with_rate = beyond.momenta_add(twice_first, beyond.turn(twice_omega));
        Vectors { turning, with_rate, second, twice_first, twice_omega }
    }

    /// `−∂r/∂q` and `−∂r/∂v` of some columns, given ∂f/∂q and ∂f/∂v row by row.
    #[inline]
    pub(super) fn columns(&self, first: usize, forces: [&[C::Number]; 2], out: [&mut [C::Block]; 2]) {
        let n = self.links.len();
        let Vectors { turning, with_rate, second, twice_first, twice_omega } = self.vectors(first);
        let [by_q, by_v] = out;
        for (i, ((own, of_q), of_v)) in self.rows.iter().zip(&mut *by_q).zip(&mut *by_v).enumerate() {
            let above = || {
                let [omega, upsilon] = [three::<C>(own, own::OMEGA), three::<C>(own, own::UPSILON)];
                let power = |[force, moment]: Six<C>| dot_add::<C>(omega, moment, dot::<C>(upsilon, force));
                [power(turning), power(with_rate)]
            };
            let below = || {
                let [p, l] = [three::<C>(own, own::LINEAR_MOMENTUM), three::<C>(own, own::ANGULAR_MOMENTUM)];
                let z = three::<C>(own, own::HALF_GYRATION);
                let product = |[omega, upsilon]: Six<C>, of_z: Three<C>| {
                    dot_add::<C>(l, omega, dot_add::<C>(p, upsilon, dot::<C>(z, of_z)))
                };
                [product(second, twice_first[0]), product(twice_first, twice_omega)]
            };
            let [mut products_q, mut products_v] = if i <= first {
                above()
            } else if i >= first + C::WIDTH {
                below()
            } else {
                let ([below_q, below_v], [above_q, above_v]) = (below(), above());
                [C::join(below_q, above_q, i - first), C::join(below_v, above_v, i - first)]
            };
            if !self.paths.is_empty() {
                let on_path = C::load(self.paths.get(i * n + first..).unwrap_or_default());
                [products_q, products_v] = [products_q * on_path, products_v * on_path];
            }
            let [force_q, force_v] = forces;
            *of_q = -products_q + C::load(force_q.get(i * n + first..).unwrap_or_default());
            *of_v = -products_v + C::load(force_v.get(i * n + first..).unwrap_or_default());
        }
    }

    /// Subtracts from ∂f/∂q what a rotation vector, whose axes depend on its coordinates, adds to ∂r/∂q.
    #[inline]
    pub(super) fn subtract_diagonals(&self, of_q: &mut [C::Number]) {
        let n = self.links.len();
        let diagonals = self.factors.get(rows::DIAGONALS * n..).unwrap_or_default();
        for (diagonal, entries) in diagonals.chunks_exact(n.max(1)).enumerate() {
            for (i, added) in entries.iter().enumerate().filter(|(_, added)| !added.is_zero()) {
                let place = (i * n + i + diagonal).checked_sub(2);
                if let Some(entry) = place.and_then(|place| of_q.get_mut(place)) {
                    *entry = *entry + -*added;
                }
            }
        }
    }

    /// What changes of some coordinates and of their rates do, about the world's origin, while everything beyond is rigid.
    #[inline(always)]
    pub(super) fn changes(&self, first: usize, changes: &mut [Changes<C>]) {
        let Vectors { turning, with_rate, second, twice_first, twice_omega } = self.vectors(first);
        let mut scratch = [zero::<C>(); 16];
        let of_q = [turning[1], turning[0], second[0], second[1], twice_first[0]];
        let of_v = [with_rate[1], with_rate[0], twice_first[0], twice_first[1], twice_omega];
        for place in 0..15 {
            for (is_rate, vectors) in [(false, &of_q), (true, &of_v)] {
                C::store(vectors[place / 3][place % 3], &mut scratch);
                for column in 0..C::WIDTH {
                    let Some(change) = changes.get_mut(first + column) else { break };
                    let of = if is_rate { &mut change.of_v } else { &mut change.of_q };
                    of[place] = scratch[column];
                }
            }
        }
    }
}

/// Marks pairs of coordinates one of which is on the path of the other.
pub(super) fn mark_paths<C: Columns>(links: &[Link], paths: &mut [C::Number]) {
    let n = links.len();
    paths.fill(zero::<C>());
    for j in 0..n {
        let mut reached = Some(j);
        while let Some(i) = reached {
            for place in [i * n + j, j * n + i] {
                if let Some(flag) = paths.get_mut(place) {
                    *flag = one::<C>();
                }
            }
            reached = links.get(i).and_then(|link| link.before);
        }
    }
}
