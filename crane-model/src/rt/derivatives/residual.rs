//! Derivatives of the residual, from vectors of each coordinate.

#![expect(clippy::inline_always, reason = "inlined where wider vectors are known, loops use them")]

use core::ops::Range;

use super::changes::Changes;
use super::columns::{Columns, Constant, Scalar};
use super::vectors::{Six, Three, commutator_add, cross_add, cross_subtract, dot, dot_add, plus, scaled_add, three};
use super::{Link, Own};

/// First rows of the vectors of [`residual_factors`](crate::CraneModel::residual_factors).
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

/// Of a change of a coordinate, and of its rate: the moment and force that it requires, while everything beyond is rigid, its
/// angular and linear acceleration, and twice the angular rates. About the world's origin.
type Vectors<T> = [[T; 15]; 2];

/// How many rows of factors the vectors need.
const ROWS: usize = rows::DIAGONALS;

/// The factors of a coordinate and a state: those of some coordinates and states, in a lane.
struct Factors<'a, C: Columns>(&'a [C::Unit; ROWS], usize);

impl<C: Columns<Lane = L>, L: Scalar> Factors<'_, C> {
    #[inline(always)]
    fn one(&self, row: usize) -> L {
        self.0[row].as_ref()[self.1]
    }

    #[inline(always)]
    fn three(&self, row: usize) -> Three<L> {
        [self.one(row), self.one(row + 1), self.one(row + 2)]
    }

    #[inline(always)]
    fn six(&self, rows: [usize; 2]) -> Six<L> {
        [self.three(rows[0]), self.three(rows[1])]
    }

    /// Force and moment `Ω W + c`, W of everything beyond.
    #[inline(always)]
    fn momenta_add(&self, [omega, upsilon]: Six<L>, [force, moment]: Six<L>) -> Six<L> {
        let moments = self.three(rows::MOMENTS);
        let force = cross_subtract(moments, omega, scaled_add(upsilon, self.one(rows::MASS), force));
        let moment = cross_add(moments, upsilon, moment);
        let [x, y, z] = three!(|k| self.three(rows::INERTIA[k]));
        [force, [dot_add(x, omega, moment[0]), dot_add(y, omega, moment[1]), dot_add(z, omega, moment[2])]]
    }

    /// `∫ s × ẋ dm` and its moment.
    #[inline(always)]
    fn turn(&self, s: Three<L>) -> Six<L> {
        let force = cross_add(s, self.three(rows::MOMENTUM), [L::constant(0.0); 3]);
        [force, three!(|k| dot(self.three(rows::TURNING[k]), s))]
    }

    /// What a coordinate's own row needs, see [`own`].
    #[inline(always)]
    fn own(&self) -> [L; 15] {
        let [omega, upsilon] = self.six([rows::OMEGA, rows::UPSILON]);
        let zero = [L::constant(0.0); 3];
        let [p, l] = self.momenta_add([omega, upsilon], [zero; 2]);
        let [x, y, z] = three!(|k| self.three(rows::TURNING[k]));
        let turned = scaled_add(x, omega[0], scaled_add(y, omega[1], scaled_add(z, omega[2], zero)));
        let half = cross_add(self.three(rows::MOMENTUM), upsilon, turned);
        flat([omega, upsilon, p, l, half])
    }

    #[inline(always)]
    fn vectors(&self) -> Vectors<L> {
        let twice = |of: Three<L>| plus(of, of);
        let generator = self.six([rows::OMEGA, rows::UPSILON]);
        let own_first = self.six([rows::FIRST_OMEGA, rows::FIRST_UPSILON]);
        let (twice_first, twice_omega) = ([twice(own_first[0]), twice(own_first[1])], twice(generator[0]));
        let of_first = commutator_add(self.six(rows::VELOCITY), own_first, self.six(rows::ADDED));
        let second = commutator_add(self.six(rows::RATE), generator, of_first);
        let force = self.three(rows::FORCE);
        let [turned_force, turned_moment] = self.momenta_add(second, self.turn(twice_first[0]));
        let turned_moment = cross_add(generator[0], self.three(rows::MOMENT), turned_moment);
        let turning = [cross_add(generator[0], force, turned_force), cross_add(generator[1], force, turned_moment)];
        let with_rate = self.momenta_add(twice_first, self.turn(twice_omega));
        [
            flat([turning[1], turning[0], second[0], second[1], twice_first[0]]),
            flat([with_rate[1], with_rate[0], twice_first[0], twice_first[1], twice_omega]),
        ]
    }
}

#[inline(always)]
fn flat<L: Copy>([a, b, c, d, e]: [Three<L>; 5]) -> [L; 15] {
    [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], d[0], d[1], d[2], e[0], e[1], e[2]]
}

/// The derivatives of a residual.
pub(super) struct Slopes<'a, C: Columns> {
    links: &'a [Link],
    factors: &'a [C::Number],
    pub(super) rows: &'a [Own<C>],
}

impl<'a, C: Columns> Slopes<'a, C> {
    /// Also writes what `changes` of coordinates and of their rates do, about the world's origin, while everything beyond is rigid.
    #[inline(always)]
    pub(super) fn new(
        links: &'a [Link],
        factors: &'a [C::Number],
        rows: &'a mut [Own<C>],
        changes: &mut [Changes<C>],
    ) -> Self {
        let mut slopes = Slopes { links, factors, rows: &[] };
        // Written in place: what a function returns would be copied.
        let mut factors = [C::zero(); ROWS];
        let mut vectors = [[C::zero(); 15]; 2];
        for first in (0..links.len()).step_by(C::WIDTH) {
            slopes.factors(first, &mut factors);
            let mut units = [C::zero(); 15];
            for lane in 0..C::WIDTH * C::STATES {
                let own = Factors::<C>(&factors, lane).own();
                for index in 0..15 {
                    units[index].as_mut()[lane] = own[index];
                }
            }
            for column in 0..C::WIDTH {
                let Some(own) = rows.get_mut(first + column) else { break };
                for index in 0..15 {
                    own[index] = C::number(&units[index], column);
                }
            }
            if changes.is_empty() {
                continue;
            }
            Self::vectors(&factors, &mut vectors);
            for column in 0..C::WIDTH {
                let Some(Changes { of, .. }) = changes.get_mut(first + column) else { break };
                for index in 0..15 {
                    (of[0][index], of[1][index]) =
                        (C::number(&vectors[0][index], column), C::number(&vectors[1][index], column));
                }
            }
        }
        slopes.rows = rows;
        slopes
    }

    #[inline(always)]
    fn factors(&self, first: usize, factors: &mut [C::Unit; ROWS]) {
        for row in 0..ROWS {
            factors[row] = C::load(self.factors.get(row * self.links.len() + first..).unwrap_or_default());
        }
    }

    #[inline(always)]
    fn vectors(factors: &[C::Unit; ROWS], units: &mut Vectors<C::Unit>) {
        for lane in 0..C::WIDTH * C::STATES {
            let vectors = Factors::<C>(factors, lane).vectors();
            for which in 0..2 {
                for index in 0..15 {
                    units[which][index].as_mut()[lane] = vectors[which][index];
                }
            }
        }
    }

    /// ∂r/∂q and ∂r/∂v of some columns in place of ∂f/∂q and ∂f/∂v, row by row; `paths`: see [`mark_paths`], or nothing.
    #[inline(always)]
    pub(super) fn columns(&self, first: usize, paths: &[C::Number], matrices: [&mut [C::Number]; 2]) {
        let n = self.links.len();
        let mut factors = [C::zero(); ROWS];
        let mut vectors = [[C::zero(); 15]; 2];
        self.factors(first, &mut factors);
        Self::vectors(&factors, &mut vectors);
        for (matrix, units) in matrices.into_iter().zip(&vectors) {
            self.entries::<true, false>(0..first, first, paths, units, matrix);
            self.entries::<true, true>(first..n.min(first + C::WIDTH), first, paths, units, matrix);
            self.entries::<false, true>(first + C::WIDTH..n, first, paths, units, matrix);
        }
    }

    /// Of some rows; whether entries are above the diagonal or on it, and whether below.
    #[inline(always)]
    fn entries<const ABOVE: bool, const BELOW: bool>(
        &self,
        own_rows: Range<usize>,
        first: usize,
        paths: &[C::Number],
        units: &[C::Unit; 15],
        matrix: &mut [C::Number],
    ) {
        let n = self.links.len();
        for i in own_rows {
            let (Some(own), Some(rest)) = (self.rows.get(i), matrix.get_mut(i * n + first..)) else { break };
            // Also of the next row, which is not written: all of a vector is loaded in one piece.
            let mut entries = C::load(rest);
            let on_path =
                if paths.is_empty() { C::zero() } else { C::load(paths.get(i * n + first..).unwrap_or_default()) };
            for lane in 0..C::WIDTH * C::STATES {
                let own = |first: usize| three!(|k| C::lane(&own[first + k], lane));
                let unit = |first: usize| three!(|k| units[first + k].as_ref()[lane]);
                let above = || dot_add(own(own::OMEGA), unit(0), dot(own(own::UPSILON), unit(3)));
                let below = || {
                    let gyration = dot(own(own::HALF_GYRATION), unit(12));
                    let below = dot_add(own(own::LINEAR_MOMENTUM), unit(9), gyration);
                    dot_add(own(own::ANGULAR_MOMENTUM), unit(6), below)
                };
                let mut product = match (ABOVE, BELOW) {
                    (true, false) => above(),
                    (false, _) => below(),
                    (true, true) => {
                        let (above, below) = (above(), below());
                        if i <= first + lane / C::STATES { above } else { below }
                    }
                };
                if !paths.is_empty() {
                    product = product * on_path.as_ref()[lane];
                }
                let entry = &mut entries.as_mut()[lane];
                *entry = -(-product + *entry);
            }
            C::store(&entries, rest.get_mut(..n - first).unwrap_or_default());
        }
    }

    /// What rotation vectors, whose axes depend on their coordinates, add to ∂r/∂q, on five diagonals.
    #[inline(always)]
    pub(super) fn diagonals(&self) -> &'a [C::Number] {
        self.factors.get(rows::DIAGONALS * self.links.len()..).unwrap_or_default()
    }

    /// The place in the matrix of a number of the diagonals that is not zero.
    #[inline(always)]
    pub(super) fn place(&self, k: usize) -> usize {
        let n = self.links.len();
        (k % n * n + k % n + k / n).saturating_sub(2)
    }
}

/// Marks pairs of coordinates one of which is on the path of the other.
pub(super) fn mark_paths<C: Columns>(links: &[Link], paths: &mut [C::Number]) {
    let n = links.len();
    paths.fill(C::Number::constant(0.0));
    for j in 0..n {
        let mut reached = Some(j);
        while let Some(i) = reached {
            for index in [i * n + j, j * n + i] {
                if let Some(flag) = paths.get_mut(index) {
                    *flag = C::Number::constant(1.0);
                }
            }
            reached = links.get(i).and_then(|link| link.before);
        }
    }
}
