//! Derivatives of the dynamics, multiplied from their factors in loops over the coordinates, several columns at a time.
//!
//! Of the inverse mass matrix, the factors of coordinate j are its axis n, the force λ and moment κ of everything beyond for a unit rate, divided
//! by the articulated inertia D along the axis, the offset d to its point from that of the coordinate before it, and 1/D, all in the world's axes.
//! `A⁻¹ R = Lᵀ D⁻¹ L R` takes an inward and an outward sweep for each column r of R:
//!
//! ```text
//! g_j = r_j − n · m,            m ← m + κ g_j + d × f,   f ← f + λ g_j      from the tips to the base; of a translation n · f
//! x_j = g_j/D − κ · α − λ · a,   α ← α + n x_j,            a ← a + α × d      from the base to the tips; of a translation a ← a + n x_j
//! ```
//!
//! Columns of `−A⁻¹ ∂r` need no column of ∂r, see `changes`. Matrices of several trees are zero between them, and are not computed there.
//!
//! The derivatives of the generalized forces that a motion requires are products of vectors of two coordinates, of i and of j, if one is on the
//! path of the other. Of everything beyond coordinate j, W is the pseudo-inertia, G is `∫ ẋ xᵀ dm` and F the force and moment that its motion
//! requires, about the world's origin; Ω_j moves it, V is its velocity before its own motion, γ gravity.
//!
//! ```text
//! ∂r_i/∂q_j = Ω_i · (Ω̈_j W + 2 Ω̇_j G + Ω_j × F),   ∂r_i/∂v_j = 2 Ω_i · (Ω̇_j W + Ω_j G)                i ≤ j
//! ∂r_i/∂q_j = (Ω_i W) · Ω̈_j + ½ z_i · 2 ω̇_j,        ∂r_i/∂v_j = (Ω_i W) · 2 Ω̇_j + ½ z_i · 2 ω_j         j < i, z · s = 2 Ω · (s G)
//! Ω̈ = [V̇, Ω] + [V, Ω̇], and what a rotation vector adds; gravity is an acceleration −γ
//! ```
//!
//! S. Singh, R. P. Russell, P. M. Wensing, IEEE Robotics and Automation Letters 7 (2022), for the derivatives; G. Rodriguez, K. Kreutz-Delgado, IEEE
//! Transactions on Robotics and Automation 8 (1992), for the factors.

#![expect(clippy::inline_always, reason = "inlined where wider vectors are known, loops use them")]

mod changes;
mod columns;
mod residual;
mod sweeps;
mod vectors;

use core::ops::Range;

pub use changes::Changes;
use changes::Entering;
pub use columns::{Columns, Constant, Eights, One, Sixteen};
use residual::{Slopes, mark_paths};
pub use sweeps::{Joint, Lanes, Row, States};
use sweeps::{LANES, Nothing, Sweeps, unit};
use vectors::{Three, one, zero};

/// What the sweeps must know of a coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Link {
    /// Whether it is a rotation.
    pub rotates: bool,
    /// The coordinate before it on its path.
    pub before: Option<usize>,
}

impl Link {
    /// Whether the coordinate at a place is attached to the one in front of it.
    #[inline]
    fn continues(self, place: usize) -> bool {
        self.before == place.checked_sub(1)
    }
}

/// Numbers of one coordinate, next to each other.
type Own<C> = [<C as Columns>::Number; 16];

/// Storage for what is computed on the way; all lists have an entry for each coordinate.
pub struct Workspace<'a, C: Columns> {
    /// For the factors of A⁻¹.
    pub joints: &'a mut [Joint<C>],
    /// For the factors of derivatives in their rows.
    pub rows: &'a mut [Own<C>],
    /// Columns of two matrices.
    pub columns: [&'a mut [C::Block]; 2],
    /// For what changes of the coordinates do.
    pub changes: &'a mut [Changes<C>],
    /// Columns of several matrices, side by side.
    pub swept: &'a mut [Row<C>],
    /// For the sweeps.
    pub states: States<'a, C>,
    /// Whether two coordinates are on one path, 1 or 0; empty if there are no branches.
    pub paths: &'a mut [C::Number],
}

/// Three numbers of a coordinate in all columns.
#[inline]
fn three<C: Columns>(own: &Own<C>, first: usize) -> Three<C> {
    let of = |k: usize| C::splat(own.get(first + k).copied().unwrap_or(zero::<C>()));
    [of(0), of(1), of(2)]
}

/// Writes columns from `first` on.
#[inline]
fn store<C: Columns>(columns: &[C::Block], first: usize, matrix: &mut [C::Number]) {
    for (column, row) in columns.iter().zip(matrix.chunks_exact_mut(columns.len().max(1))) {
        C::store(*column, row.get_mut(first..).unwrap_or_default());
    }
}

/// Whether some coordinate is not attached to the one in front of it.
pub fn has_branches(links: &[Link]) -> bool {
    links.iter().enumerate().any(|(place, link)| !link.continues(place))
}

/// Coordinates that have no path in common with others: those of a tree, or of several whose coordinates are mixed.
fn apart(links: &[Link]) -> impl Iterator<Item = Range<usize>> {
    let mut end = 0;
    core::iter::from_fn(move || {
        let start = end;
        end = links.len();
        let mut first = end;
        for (j, link) in links.iter().enumerate().skip(start + 1).rev() {
            first = first.min(link.before.unwrap_or(j));
            if first >= j {
                end = j;
            }
        }
        (start < end).then_some(start..end)
    })
}

/// Columns that are swept together.
struct Piece {
    columns: Range<usize>,
    /// Units of lanes that they take.
    units: usize,
}

/// Pieces of columns, as many as the lanes hold of several matrices.
fn pieces<C: Columns>(columns: &Range<usize>, matrices: usize) -> impl Iterator<Item = Piece> {
    let (Range { start, end }, width) = (columns.clone(), LANES / matrices);
    (start..end).step_by(width).map(move |first| {
        let columns = first..end.min(first + width);
        Piece { units: (matrices * columns.len()).div_ceil(unit::<C>()), columns }
    })
}

/// A matrix of n rows, and where its columns lie in the lanes.
struct Matrix<'a, T> {
    n: usize,
    numbers: &'a mut [T],
    lane: usize,
}

impl<T: Copy + Constant> Matrix<'_, T> {
    /// Part of a row.
    #[inline(always)]
    fn part(&mut self, row: usize, columns: &Range<usize>) -> &mut [T] {
        let first = row * self.n;
        self.numbers.get_mut(first + columns.start..first + columns.end).unwrap_or_default()
    }

    /// Whether entries of these columns are not zero in other rows.
    fn has_others(&mut self, own: &Range<usize>) -> bool {
        let mut is_zero = true;
        for row in (0..own.start).chain(own.end..self.n) {
            self.part(row, own).iter().for_each(|entry| is_zero &= entry.is_zero());
        }
        !is_zero
    }

    /// Makes entries of these columns zero in other rows.
    fn clear_others(&mut self, own: &Range<usize>) {
        for row in (0..own.start).chain(own.end..self.n) {
            self.part(row, own).fill(T::constant(0.0));
        }
    }

    /// Copies columns into lanes, and returns the end of the rows that are not zero.
    #[inline(always)]
    fn load(&mut self, own: &Range<usize>, columns: &Range<usize>, swept: &mut [[T; LANES]]) -> usize {
        let (lane, mut end) = (self.lane, 0);
        for i in own.start..own.end {
            let (part, Some(lanes)) = (self.part(i, columns), swept.get_mut(i).and_then(|row| row.get_mut(lane..)))
            else {
                continue;
            };
            let mut is_zero = true;
            copy(part, lanes);
            for k in 0..part.len() {
                is_zero &= part[k].is_zero();
            }
            if !is_zero {
                end = i + 1;
            }
        }
        end
    }

    /// Copies columns from lanes.
    #[inline(always)]
    fn store(&mut self, own: &Range<usize>, columns: &Range<usize>, swept: &[[T; LANES]]) {
        let lane = self.lane;
        for i in own.start..own.end {
            let (part, Some(lanes)) = (self.part(i, columns), swept.get(i).and_then(|row| row.get(lane..))) else {
                continue;
            };
            copy(lanes, part);
        }
    }
}

/// Copies as many numbers as both have, eight at a time.
#[inline(always)]
#[expect(clippy::manual_memcpy, reason = "short: a call would take longer than the loop")]
fn copy<T: Copy>(from: &[T], to: &mut [T]) {
    let count = from.len().min(to.len());
    let (Some(from), Some(to)) = (from.get(..count), to.get_mut(..count)) else { return };
    let ((eights, rest), (to_eights, to_rest)) = (from.as_chunks::<8>(), to.as_chunks_mut::<8>());
    for k in 0..eights.len().min(to_eights.len()) {
        to_eights[k] = eights[k];
    }
    for k in 0..rest.len().min(to_rest.len()) {
        to_rest[k] = rest[k];
    }
}

/// Makes units of lanes of some rows zero, except for columns of the unit matrix from a lane on.
#[inline(always)]
fn set_ones<C: Columns>(own: &Range<usize>, Piece { columns, units }: &Piece, first: usize, swept: &mut [Row<C>]) {
    for i in own.start..own.end {
        let Some(row) = swept.get_mut(i) else { continue };
        for k in 0..unit::<C>() * (*units).min(LANES / unit::<C>()) {
            row[k] = zero::<C>();
        }
        if i >= columns.start
            && i < columns.end
            && let Some(entry) = row.get_mut(first + i - columns.start)
        {
            *entry = one::<C>();
        }
    }
}

/// A⁻¹, row by row; `factors`: those of [`mass_factors`](crate::MotionDerivatives::mass_factors), row by row.
#[inline(always)]
pub fn inverse_mass_matrix<C: Columns>(
    links: &[Link],
    factors: &[C::Number],
    workspace: Workspace<'_, C>,
    inverse: &mut [C::Number],
) {
    let Workspace { joints, swept, mut states, .. } = workspace;
    let sweeps = Sweeps::<C>::new(links, factors, joints);
    let mut inverse = Matrix { n: links.len(), numbers: inverse, lane: 0 };
    for own in apart(links) {
        inverse.clear_others(&own);
        for piece in pieces::<C>(&own, 1) {
            set_ones::<C>(&own, &piece, 0, swept);
            let Piece { columns, units } = piece;
            sweeps.inward(own.start..columns.end, swept, units, &mut states, &mut Nothing);
            sweeps.outward(own.clone(), false, swept, units, &mut states, &mut Nothing);
            inverse.store(&own, &columns, swept);
        }
    }
}

/// `∂r/∂q` and `∂r/∂v` in place of `∂f/∂q` and `∂f/∂v`, row by row; `factors`: those of
/// [`residual_factors`](crate::MotionDerivatives::residual_factors).
pub fn residual_derivatives<C: Columns>(
    links: &[Link],
    factors: &[C::Number],
    workspace: Workspace<'_, C>,
    derivatives: &mut [C::Number],
) {
    let Workspace { rows, columns: [by_q, by_v], paths, .. } = workspace;
    if has_branches(links) {
        mark_paths::<C>(links, paths);
    }
    let slopes = Slopes::<C>::new(links, factors, rows, paths);
    let (of_q, of_v) = derivatives.split_at_mut(derivatives.len() / 2);
    slopes.subtract_diagonals(of_q);
    for first in (0..links.len()).step_by(C::WIDTH) {
        slopes.columns(first, [&*of_q, &*of_v], [&mut *by_q, &mut *by_v]);
        for (columns, matrix) in [(&mut *by_q, &mut *of_q), (&mut *by_v, &mut *of_v)] {
            for column in columns.iter_mut() {
                *column = -*column;
            }
            store::<C>(columns, first, matrix);
        }
    }
}

/// `∂q̈/∂q`, `∂q̈/∂v` and A⁻¹ in place of `∂f/∂q`, `∂f/∂v` and anything; `of_residual` and `of_mass`: factors of both.
#[inline(always)]
pub fn forward_dynamics_derivatives<C: Columns>(
    links: &[Link],
    [of_residual, of_mass]: [&[C::Number]; 2],
    workspace: Workspace<'_, C>,
    derivatives: &mut [C::Number],
) {
    let Workspace { joints, rows, changes, swept, mut states, .. } = workspace;
    let n = links.len();
    let (of_q, rest) = derivatives.split_at_mut(derivatives.len().min(n * n));
    let (of_v, inverse) = rest.split_at_mut(rest.len().min(n * n));
    let slopes = Slopes::<C>::new(links, of_residual, rows, &[]);
    slopes.subtract_diagonals(of_q);
    for first in (0..n).step_by(C::WIDTH) {
        slopes.changes(first, changes);
    }
    let mut sweeps = Sweeps::<C>::new(links, of_mass, joints);
    changes::give_way(&mut sweeps, slopes.rows, changes, swept, &mut states);
    let matrix = |numbers| Matrix { n, numbers, lane: 0 };
    let mut matrices = [matrix(of_q), matrix(of_v), matrix(inverse)];
    let [of_q, of_v, _] = &mut matrices;
    // Forces may act between what is apart.
    let is_coupled = apart(links).any(|own| of_q.has_others(&own) || of_v.has_others(&own));
    let whole = is_coupled.then_some(0..n);
    for own in whole.into_iter().chain(apart(links).take(if is_coupled { 0 } else { n })) {
        for piece in pieces::<C>(&own, 3) {
            let width = piece.columns.len();
            set_ones::<C>(&own, &piece, 2 * width, swept);
            let Piece { columns, units } = piece;
            let mut end = columns.end;
            for (matrix, lane) in matrices.iter_mut().zip([0, width, 2 * width]) {
                matrix.lane = lane;
                matrix.clear_others(&own);
            }
            for forces in matrices.iter_mut().take(2) {
                end = end.max(forces.load(&own, &columns, swept));
            }
            let mut entering = Entering { changes, first: columns.start, width };
            sweeps.inward(own.start..end, swept, units, &mut states, &mut entering);
            sweeps.outward(own.clone(), true, swept, units, &mut states, &mut entering);
            for matrix in &mut matrices {
                matrix.store(&own, &columns, swept);
            }
        }
    }
}
