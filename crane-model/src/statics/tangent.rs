//! Tangent stiffness in its principal directions.

use std::cell::OnceCell;

use nalgebra::{Cholesky, DMatrix, DVector, Dyn, SymmetricEigen};

use super::Status;
use crate::{CoordinateKind, Description, Text};

/// A diagonal entry below this fraction of the largest of its kind (N/m or N m/rad) counts as zero stiffness. Real
/// cranes span about 1e9 (a chassis against a hinge), those with nearly rigid drives 1e12; rounding leaves about 1e-16.
const LEAST_STIFFNESS: f64 = 1e-13;
/// A direction is free below this fraction of the largest scaled stiffness, which scaling brings to about 1: a chain of 96 bars hung
/// between stiff points has 1e-9, rounding leaves 1e-14.
const FREE: f64 = 1e-10;
/// A direction is soft below this fraction: where a Newton step does not help, one that limits the motion in soft directions may.
const SOFT: f64 = 1e-7;
/// A coordinate belongs to a direction if its component is at least this fraction of the largest one.
const SHARE: f64 = 0.3;

/// Tangents of more coordinates are factorised by halves: their columns no longer fit into the caches.
const LARGE: usize = 500;
/// Size of blocks that are not halved any more.
const BLOCK: usize = 64;

/// `K = S⁻¹ M S⁻¹`, with `S = diag(1/√|K_ii|)`: m and rad become comparable, and relative coordinates nearly decouple.
///
/// Where M has no direction that a limit leaves alone, its factors give the Newton step; where it is also positive definite, the equilibrium is stable.
/// Only elsewhere are its principal directions computed, `M = U Λ Uᵀ`, which takes ten to thirty times as long.
pub(super) struct Tangent {
    scale: DVector<f64>,
    scaled: DMatrix<f64>,
    factors: Option<Factors>,
    principal: OnceCell<Principal>,
}

/// The factors of a regular tangent.
struct Factors {
    kind: Kind,
    /// A lower bound of the ratio of the smallest to the largest eigenvalue, by size: `1 / (‖M‖ ‖M⁻¹‖)` with Frobenius norms, which bound the
    /// eigenvalues.
    least_ratio: f64,
}

enum Kind {
    /// `M = L Lᵀ`, of a definite one.
    Definite(Cholesky<f64, Dyn>),
    /// L⁻¹ of a large definite one.
    Large(DMatrix<f64>),
    /// M⁻¹ of another one.
    Indefinite(DMatrix<f64>),
}

impl Factors {
    fn new(scaled: &DMatrix<f64>) -> Option<Self> {
        let n = scaled.nrows();
        let inverse = if n > LARGE { inverse_of_factor(scaled.clone()) } else { None };
        let (kind, size) = if let Some(inverse) = inverse {
            let size = inverse.norm_squared();
            (Kind::Large(inverse), size)
        } else if let Some(factors) = scaled.clone().cholesky() {
            let mut inverse = DMatrix::identity(n, n);
            factors.l_dirty().solve_lower_triangular_mut(&mut inverse);
            // ‖M⁻¹‖ ≤ tr M⁻¹ = ‖L⁻¹‖².
            (Kind::Definite(factors), inverse.norm_squared())
        } else {
            let inverse = scaled.clone().try_inverse()?;
            let size = inverse.norm();
            (Kind::Indefinite(inverse), size)
        };
        Some(Self { kind, least_ratio: (scaled.norm() * size).recip() })
    }

    fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        match &self.kind {
            Kind::Definite(factors) => factors.solve(right),
            Kind::Large(inverse) => inverse.tr_mul(&(inverse * right)),
            Kind::Indefinite(inverse) => inverse * right,
        }
    }
}

/// L⁻¹ of `M = L Lᵀ` by halves, in products of matrices; `None` unless M is positive definite. With the halves of M, `[A Bᵀ; B C]`,
///
/// ```text
/// L = [L₁ 0; X L₂]      X = B L₁⁻ᵀ,  L₂ L₂ᵀ = C − X Xᵀ        L⁻¹ = [L₁⁻¹ 0; −L₂⁻¹ X L₁⁻¹  L₂⁻¹]
/// ```
fn inverse_of_factor(matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = matrix.nrows();
    let mut inverse = DMatrix::identity(n, n);
    if n <= BLOCK {
        matrix.cholesky()?.l_dirty().solve_lower_triangular_mut(&mut inverse);
        return Some(inverse);
    }
    let half = n / 2;
    let rest = n - half;
    let first = inverse_of_factor(matrix.view((0, 0), (half, half)).into_owned())?;
    let across = matrix.view((half, 0), (rest, half)) * first.transpose();
    let second = inverse_of_factor(matrix.view((half, half), (rest, rest)) - &across * across.transpose())?;
    inverse.view_mut((half, 0), (rest, half)).copy_from(&-(&second * across * &first));
    inverse.view_mut((0, 0), (half, half)).copy_from(&first);
    inverse.view_mut((half, half), (rest, rest)).copy_from(&second);
    Some(inverse)
}

/// The principal directions of a tangent.
struct Principal {
    values: DVector<f64>,
    vectors: DMatrix<f64>,
    greatest: f64,
}

impl Principal {
    fn new(scaled: DMatrix<f64>) -> Self {
        let SymmetricEigen { eigenvalues: values, eigenvectors: vectors } = scaled.symmetric_eigen();
        let greatest = values.amax().max(f64::MIN_POSITIVE);
        Self { values, vectors, greatest }
    }
}

/// Which directions a Newton step leaves alone.
#[derive(Clone, Copy, Debug)]
pub(super) enum Limit {
    /// Those that nothing constrains.
    Free,
    /// Also those that hardly anything constrains.
    Soft,
}

impl Limit {
    /// The fraction of the largest scaled stiffness below which a direction counts as such.
    const fn fraction(self) -> f64 {
        match self {
            Self::Free => FREE,
            Self::Soft => SOFT,
        }
    }
}

impl Tangent {
    /// Factorises `K`; `None` unless all its elements are finite.
    pub(super) fn new(stiffness: &DMatrix<f64>, description: &Description) -> Option<Self> {
        if !stiffness.iter().all(|x| x.is_finite()) {
            return None;
        }
        let n = stiffness.nrows();
        let kind = |i: usize| description.coordinates[i].kind;
        let greatest = |of: CoordinateKind| {
            (0..n).filter(|&i| kind(i) == of).map(|i| stiffness[(i, i)].abs()).fold(f64::MIN_POSITIVE, f64::max)
        };
        let (translation, rotation) = (greatest(CoordinateKind::Translation), greatest(CoordinateKind::Rotation));
        let scale = DVector::from_fn(n, |i, _| {
            let least = LEAST_STIFFNESS
                * match kind(i) {
                    CoordinateKind::Translation => translation,
                    CoordinateKind::Rotation => rotation,
                };
            stiffness[(i, i)].abs().max(least).sqrt().recip()
        });
        let scaled = DMatrix::from_fn(n, n, |i, j| stiffness[(i, j)] * scale[i] * scale[j]);
        Some(Self { scale, factors: Factors::new(&scaled), scaled, principal: OnceCell::new() })
    }

    /// The factors, if no direction is within a limit.
    fn regular(&self, limit: Limit) -> Option<&Factors> {
        self.factors.as_ref().filter(|factors| factors.least_ratio > limit.fraction())
    }

    fn principal(&self) -> &Principal {
        self.principal.get_or_init(|| Principal::new(self.scaled.clone()))
    }

    /// Newton step `−K⁻¹ r`; directions within the limit get the smallest stiffness beyond it.
    pub(super) fn step(&self, residual: &DVector<f64>, limit: Limit) -> DVector<f64> {
        let scaled = residual.component_mul(&self.scale);
        let step = self.regular(limit).map_or_else(
            || {
                let Principal { values, vectors, greatest } = self.principal();
                let least = limit.fraction() * greatest;
                let mut along = vectors.tr_mul(&scaled);
                for (component, &value) in along.iter_mut().zip(values) {
                    *component /= if value.abs() < least { least.copysign(value) } else { value };
                }
                vectors * along
            },
            |factors| factors.solve(&scaled),
        );
        -step.component_mul(&self.scale)
    }

    /// The kind of equilibrium.
    pub(super) fn status(&self, names: &Description) -> Status {
        let unstable = self.negative_direction(names).map(|coordinates| Status::Unstable { coordinates });
        unstable
            .or_else(|| self.free_directions(names, Limit::Free).map(|coordinates| Status::Singular { coordinates }))
            .unwrap_or(Status::Converged)
    }

    /// Coordinates of unconstrained directions, if there are any.
    pub(super) fn free_directions(&self, names: &Description, limit: Limit) -> Option<Vec<Text>> {
        if self.regular(limit).is_some() {
            return None;
        }
        let Principal { values, vectors, greatest } = self.principal();
        let least = limit.fraction() * greatest;
        let free = (0..values.len()).filter(|&k| values[k].abs() < least);
        let mut coordinates: Vec<_> = free.flat_map(|k| names_of(vectors, k, names)).collect();
        coordinates.sort_unstable();
        coordinates.dedup();
        (!coordinates.is_empty()).then_some(coordinates)
    }

    /// Whether a direction has a negative stiffness.
    pub(super) fn has_negative_direction(&self, names: &Description) -> bool {
        self.negative_direction(names).is_some()
    }

    /// Coordinates of the direction of the most negative stiffness, if there is one.
    fn negative_direction(&self, names: &Description) -> Option<Vec<Text>> {
        let is_definite = |factors: &Factors| matches!(factors.kind, Kind::Definite(_) | Kind::Large(_));
        if self.regular(Limit::Free).is_some_and(is_definite) {
            return None;
        }
        let Principal { values, vectors, greatest } = self.principal();
        let k = values.imin();
        (values[k] < -FREE * greatest).then(|| names_of(vectors, k, names))
    }
}

/// The coordinates with a share in a principal direction.
fn names_of(vectors: &DMatrix<f64>, k: usize, names: &Description) -> Vec<Text> {
    let direction = vectors.column(k);
    let least = SHARE * direction.amax();
    let mut share: Vec<usize> = (0..direction.len()).filter(|&i| direction[i].abs() >= least).collect();
    share.sort_by(|&i, &j| direction[j].abs().total_cmp(&direction[i].abs()));
    share.into_iter().map(|i| names.coordinates[i].name.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the factors of nalgebra, with halves of different sizes; and a matrix that is not definite far down.
    #[test]
    fn factors_by_halves_are_those_of_the_whole() {
        const SIZE: usize = 3 * BLOCK + 7;
        let mut matrix = DMatrix::from_fn(SIZE, SIZE, |i, j| ((3 * i.min(j) + 5 * i.max(j)) as f64).sin());
        matrix.fill_diagonal(SIZE as f64);
        let inverse = inverse_of_factor(matrix.clone()).expect("a definite matrix");
        let whole = matrix.clone().cholesky().expect("a definite matrix").l();
        // Rounding of sums of numbers below 1; the diagonal dominates.
        assert!((inverse * whole - DMatrix::identity(SIZE, SIZE)).amax() < 1e-14);
        matrix[(SIZE - 1, SIZE - 1)] = -1.0;
        assert!(inverse_of_factor(matrix).is_none());
    }
}
