//! Derivatives of the dynamics, multiplied from their factors in loops over the coordinates, several columns or several states at a time.
//!
//! Of the inverse mass matrix, the factors of coordinate j are its axis n, the force λ and moment κ of everything beyond for a unit rate, divided
//! by the articulated inertia D along the axis, the offset d to its point from that of the coordinate before it, and 1/D, all in the world's axes.
//! `A⁻¹ R = Lᵀ D⁻¹ L R` takes an inward and an outward sweep for each column r of R = 1:
//!
//! ```text
//! g_j = r_j − n · m,            m ← m + κ g_j + d × f,   f ← f + λ g_j      from the tips to the base; of a translation n · f
//! x_j = g_j/D − κ · α − λ · a,   α ← α + n x_j,            a ← a + α × d      from the base to the tips; of a translation a ← a + n x_j
//! ```
//!
//! Columns of `−A⁻¹ ∂r` are products of what these sweeps know, see `changes`; those of A⁻¹ with ∂f are added entry by entry of ∂f that is not zero.
//! Matrices of several trees are zero between them, and are not computed there.
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
mod give_way;
mod residual;
mod sweeps;
mod vectors;

use core::ops::Range;

use changes::COLUMNS as OF_CHANGES;
pub use changes::Changes;
pub use columns::{Carried, Columns, Constant, EightColumns, EightStates, One};
use give_way::give_way;
use residual::{Slopes, mark_paths};
use sweeps::{COLUMNS, Sweeps, part};
pub use sweeps::{Entry, Joint, States};

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
    fn continues(self, index: usize) -> bool {
        self.before == index.checked_sub(1)
    }
}

/// Numbers of one coordinate, next to each other.
type Own<C> = [<C as Columns>::Number; 16];

/// Storage for what is computed on the way; all lists have an entry for each coordinate, or [`units`] of them.
pub struct Workspace<'a, C: Columns> {
    /// For the factors of A⁻¹.
    pub joints: &'a mut [Joint<C>],
    /// For the factors of derivatives in their rows.
    pub rows: &'a mut [Own<C>],
    /// For what changes of the coordinates do.
    pub changes: &'a mut [Changes<C>],
    /// For columns of the matrices, side by side.
    pub swept: &'a mut [Entry<C>],
    /// For the sweeps.
    pub states: States<'a, C>,
    /// Whether two coordinates are on one path, 1 or 0; empty if there are no branches.
    pub paths: &'a mut [C::Number],
}

/// How many units of columns are swept together, for some coordinates.
#[must_use]
pub const fn units<C: Columns>(coordinates: usize) -> usize {
    let most = if coordinates < COLUMNS { coordinates } else { COLUMNS };
    (if most < OF_CHANGES { OF_CHANGES } else { most }).div_ceil(C::WIDTH)
}

/// A number made of others, state by state.
#[inline(always)]
fn combine<C: Columns, const COUNT: usize>(
    numbers: [&C::Number; COUNT],
    make: impl Fn([C::Lane; COUNT]) -> C::Lane,
) -> C::Number {
    let mut unit = C::zero();
    for state in 0..C::STATES {
        let mut lanes = [C::Lane::constant(0.0); COUNT];
        for k in 0..COUNT {
            lanes[k] = C::lane(numbers[k], state);
        }
        unit.as_mut()[state] = make(lanes);
    }
    C::number(&unit, 0)
}

/// Whether some coordinate is not attached to the one in front of it.
pub fn has_branches(links: &[Link]) -> bool {
    links.iter().enumerate().any(|(index, link)| !link.continues(index))
}

/// Coordinates that have no path in common with others: those of a tree, or of several whose coordinates are mixed.
fn apart(links: &[Link]) -> impl Iterator<Item = Range<usize>> {
    let mut end = 0;
    core::iter::from_fn(move || {
        let start = end;
        end = links.len();
        let mut first = end;
        for j in (start + 1..end).rev() {
            first = first.min(links.get(j).and_then(|link| link.before).unwrap_or(j));
            if first >= j {
                end = j;
            }
        }
        (start < end).then_some(start..end)
    })
}

/// Columns that are swept together, of coordinates that have no path in common with others.
struct Piece {
    own: Range<usize>,
    columns: Range<usize>,
    /// Units of a row, and those that they take.
    stride: usize,
    units: Range<usize>,
}

impl Piece {
    /// All of them.
    #[inline(always)]
    fn all<C: Columns>(links: &[Link], stride: usize) -> impl Iterator<Item = Piece> {
        let width = stride * C::WIDTH;
        apart(links).flat_map(move |range| {
            range.clone().step_by(width.max(1)).map(move |first| {
                let columns = first..range.end.min(first + width);
                let units = 0..columns.len().div_ceil(C::WIDTH);
                Piece { own: range.clone(), columns, stride, units }
            })
        })
    }

    /// Columns of A⁻¹, and of its products if there are `changes`.
    #[inline(always)]
    fn sweep<const CAUSES: bool, C: Columns>(
        &self,
        sweeps: &Sweeps<'_, C>,
        swept: &mut [Entry<C>],
        states: &mut States<'_, C>,
        changes: &[Changes<C>],
    ) {
        let Piece { own: range, columns, stride, units } = self;
        for i in 0..sweeps.links.len() {
            let row = part(swept, *stride, i, units);
            for k in 0..row.len() {
                row[k] = [C::zero(); 3];
            }
        }
        for (lane, i) in columns.clone().enumerate() {
            if let Some([unit, ..]) = swept.get_mut(i * stride + lane / C::WIDTH) {
                let of_column = lane % C::WIDTH..lane % C::WIDTH + C::STATES;
                unit.as_mut().get_mut(of_column).unwrap_or_default().fill(C::Lane::constant(1.0));
            }
        }
        let beyond = |j: usize| {
            let end = sweeps.joints.get(j).map_or(0, |joint| joint.end).min(columns.end);
            let unit = |column: usize| column.saturating_sub(columns.start);
            unit(j) / C::WIDTH..unit(end).div_ceil(C::WIDTH)
        };
        sweeps.inward::<CAUSES>(range.start..columns.end, beyond, swept, states, changes, &mut []);
        sweeps.outward::<CAUSES>(range.clone(), units, swept, states, changes);
    }

    /// Adds the product of A⁻¹ with an entry of ∂f/∂q or of ∂f/∂v, by its place among both.
    #[inline(always)]
    fn add_force<C: Columns>(&self, n: usize, index: usize, force: &C::Number, swept: &mut [Entry<C>]) {
        // Most are: a division takes longer than all the rest of them.
        if force.is_zero() {
            return;
        }
        let (row, j) = (index / n, index % n);
        let (which, i) = if row < n { (1, row) } else { (2, row - n) };
        if !self.own.contains(&i) {
            return;
        }
        for unit in self.units.clone() {
            let Some(&[x, ..]) = swept.get(i * self.stride + unit) else { continue };
            let Some(entry) = swept.get_mut(j * self.stride + unit) else { continue };
            entry[which] = C::product_add(force, &x, &entry[which]);
        }
    }

    /// Writes the first of the matrices, each state after the other: columns of A⁻¹ are its rows, and of its products rows lie side by side.
    #[inline(always)]
    fn write<C: Columns>(&self, n: usize, matrices: &[usize], swept: &[Entry<C>], out: &mut [C::Lane]) {
        let zero = C::zero();
        for unit in self.units.clone() {
            let row = self.columns.start + unit * C::WIDTH;
            let lanes = (self.columns.end - row).min(C::WIDTH) * C::STATES;
            for (index, matrix) in matrices.iter().enumerate() {
                let start =
                    |lane: usize| ((lane % C::STATES * matrices.len() + index) * n + row + lane / C::STATES) * n;
                for first in (0..n).step_by(8) {
                    // The last eight are complete, with some of those before.
                    let first = first.min(n.saturating_sub(8));
                    let mut block = [&zero; 8];
                    for k in 0..8 {
                        let Some(entry) = swept.get((first + k) * self.stride + unit) else { break };
                        block[k] = &entry[*matrix];
                    }
                    for pair in 0..(C::WIDTH * C::STATES).div_ceil(2) {
                        if 2 * pair >= lanes {
                            break;
                        }
                        let [one, other] = C::across(block, pair);
                        write_line(&one, start(2 * pair) + first, n, out);
                        if 2 * pair + 1 < lanes {
                            write_line(&other, start(2 * pair + 1) + first, n, out);
                        }
                    }
                }
            }
        }
    }
}

/// Writes eight numbers of a row of `n`, or all.
#[inline(always)]
fn write_line<T: Copy>(line: &[T; 8], start: usize, n: usize, out: &mut [T]) {
    let entries = out.get_mut(start..start + n.min(8)).unwrap_or_default();
    match entries.first_chunk_mut() {
        Some(eight) => *eight = *line,
        // By constant places: else all lines would lie in memory.
        None => {
            for k in 0..8 {
                if let Some(entry) = entries.get_mut(k) {
                    *entry = line[k];
                }
            }
        }
    }
}

/// Places of some numbers, without most of those that are zero.
#[derive(Clone, Debug)]
pub struct Places<'a, N> {
    numbers: &'a [N],
    next: usize,
}

impl<'a, N: Constant> Places<'a, N> {
    /// Of these.
    #[inline(always)]
    pub fn new(numbers: &'a [N]) -> Self {
        Places { numbers, next: 0 }
    }
}

impl<N: Constant> Iterator for Places<'_, N> {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let Places { numbers, next } = self;
        while next.is_multiple_of(8)
            && let Some(eight) = numbers.get(*next..).and_then(|rest| rest.first_chunk::<8>())
        {
            let mut is_zero = true;
            for k in 0..8 {
                is_zero &= eight[k].is_zero();
            }
            if !is_zero {
                break;
            }
            *next += 8;
        }
        *next += 1;
        if *next <= numbers.len() { Some(*next - 1) } else { None }
    }
}

/// A⁻¹, row by row, of each state; `factors`: those of [`mass_factors`](crate::CraneModel::mass_factors), row by row.
#[inline(always)]
pub fn inverse_mass_matrix<C: Columns>(
    links: &[Link],
    workspace: Workspace<'_, C>,
    factors: &[C::Number],
    inverse: &mut [C::Lane],
) {
    let Workspace { joints, swept, mut states, .. } = workspace;
    let sweeps = Sweeps::<C>::new(links, factors, joints);
    for piece in Piece::all::<C>(links, states.now.len()) {
        piece.sweep::<false, C>(&sweeps, swept, &mut states, &[]);
        piece.write::<C>(links.len(), &[0], swept, inverse);
    }
}

/// `∂r/∂q` and `∂r/∂v` in place of `∂f/∂q` and `∂f/∂v`, row by row; `factors`: those of
/// [`residual_factors`](crate::CraneModel::residual_factors).
#[inline(always)]
pub fn residual_derivatives<C: Columns>(
    links: &[Link],
    workspace: Workspace<'_, C>,
    factors: &[C::Number],
    derivatives: &mut [C::Number],
) {
    let Workspace { rows, paths, .. } = workspace;
    if has_branches(links) {
        mark_paths::<C>(links, paths);
    }
    let slopes = Slopes::<C>::new(links, factors, rows, &mut []);
    let (of_q, of_v) = derivatives.split_at_mut(derivatives.len() / 2);
    let diagonals = slopes.diagonals();
    for k in Places::new(diagonals) {
        let Some(added) = diagonals.get(k).filter(|added| !added.is_zero()) else { continue };
        if let Some(entry) = of_q.get_mut(slopes.place(k)) {
            *entry = combine::<C, 2>([entry, added], |[entry, added]| entry + -added);
        }
    }
    for first in (0..links.len()).step_by(C::WIDTH) {
        slopes.columns(first, paths, [&mut *of_q, &mut *of_v]);
    }
}

/// `∂q̈/∂q`, `∂q̈/∂v` and A⁻¹ of each state, row by row; `of_residual` and `of_mass`: factors of both; `forces`: `∂f/∂q` and `∂f/∂v`, row by row,
/// and the places of entries that may not be zero.
#[inline(always)]
pub fn forward_dynamics_derivatives<C: Columns>(
    links: &[Link],
    workspace: Workspace<'_, C>,
    [of_residual, of_mass]: [&[C::Number]; 2],
    (forces, places): (&[C::Number], impl Iterator<Item = usize> + Clone),
    derivatives: &mut [C::Lane],
) {
    let Workspace { joints, rows, changes, swept, mut states, .. } = workspace;
    let n = links.len();
    let slopes = Slopes::<C>::new(links, of_residual, rows, changes);
    let diagonals = slopes.diagonals();
    let mut sweeps = Sweeps::<C>::new(links, of_mass, joints);
    give_way(&mut sweeps, slopes.rows, changes, swept, &mut states);
    for piece in Piece::all::<C>(links, states.now.len()) {
        piece.sweep::<true, C>(&sweeps, swept, &mut states, changes);
        for index in places.clone() {
            if let Some(force) = forces.get(index) {
                piece.add_force::<C>(n, index, force, swept);
            }
        }
        for k in Places::new(diagonals) {
            if let Some(added) = diagonals.get(k) {
                let force = combine::<C, 1>([added], |[added]| -added);
                piece.add_force::<C>(n, slopes.place(k), &force, swept);
            }
        }
        piece.write::<C>(n, &[1, 2, 0], swept, derivatives);
    }
}
