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

mod columns;
mod inverse;
mod residual;
mod vectors;

pub use columns::{Columns, Constant, Eights, One, Sixteen};
use inverse::Sweeps;
use residual::Slopes;
use vectors::{Three, zero};

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
    /// For the factors of A⁻¹, and whether the offsets are not zero.
    pub joints: &'a mut [(Own<C>, bool)],
    /// For the factors of derivatives in their rows.
    pub rows: &'a mut [Own<C>],
    /// Columns of two matrices.
    pub columns: [&'a mut [C::Block]; 2],
    /// For branches; empty if there are none.
    pub states: &'a mut [[[C::Block; 3]; 2]],
    /// Whether two coordinates are on one path, 1 or 0; empty if there are no branches.
    pub paths: &'a mut [C::Number],
}

/// Three numbers of a coordinate in all columns.
#[inline]
fn three<C: Columns>(own: &Own<C>, first: usize) -> Three<C> {
    let of = |k: usize| C::splat(own.get(first + k).copied().unwrap_or(zero::<C>()));
    [of(0), of(1), of(2)]
}

/// Their opposites.
#[inline]
fn minus<C: Columns>(own: &Own<C>, first: usize) -> Three<C> {
    let of = |k: usize| C::splat(-own.get(first + k).copied().unwrap_or(zero::<C>()));
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

/// A⁻¹, row by row; `factors`: those of [`mass_factors`](crate::MotionDerivatives::mass_factors), row by row.
pub fn inverse_mass_matrix<C: Columns>(
    links: &[Link],
    factors: &[C::Number],
    workspace: Workspace<'_, C>,
    inverse: &mut [C::Number],
) {
    let Workspace { joints, columns: [columns, _], states, .. } = workspace;
    Sweeps::<C>::new(links, factors, joints).invert(columns, states, inverse);
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
    let slopes = Slopes::<C>::new(links, factors, rows, paths);
    let (of_q, of_v) = derivatives.split_at_mut(derivatives.len() / 2);
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
pub fn forward_dynamics_derivatives<C: Columns>(
    links: &[Link],
    [of_residual, of_mass]: [&[C::Number]; 2],
    workspace: Workspace<'_, C>,
    derivatives: &mut [C::Number],
) {
    let Workspace { joints, rows, columns: [by_q, by_v], states, paths } = workspace;
    let slopes = Slopes::<C>::new(links, of_residual, rows, paths);
    let sweeps = Sweeps::<C>::new(links, of_mass, joints);
    let n = links.len();
    let (of_q, rest) = derivatives.split_at_mut(derivatives.len().min(n * n));
    let (of_v, inverse) = rest.split_at_mut(rest.len().min(n * n));
    for first in (0..n).step_by(C::WIDTH) {
        slopes.columns(first, [&*of_q, &*of_v], [&mut *by_q, &mut *by_v]);
        for (columns, matrix) in [(&mut *by_q, &mut *of_q), (&mut *by_v, &mut *of_v)] {
            sweeps.solve(columns, n, states);
            store::<C>(columns, first, matrix);
        }
    }
    sweeps.invert(by_q, states, inverse);
}
