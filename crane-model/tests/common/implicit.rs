//! What cranes written by hand need besides their equations: implicit systems by dense factors, and lanes of eight cranes, one after the other.

use crane_model::CraneModel;
use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// A at a pose.
pub fn mass_matrix<const N: usize, C: CraneModel<N>>(crane: &C, q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
    let mut mass = SMatrix::zeros();
    crane.mass_matrix(q, &mut mass);
    mass
}

/// Factors of `A + D̂`.
pub type Factors<const N: usize> = Option<Cholesky<f64, Const<N>>>;

/// Factors of `A + D̂` for added inertias of single coordinates.
pub fn factorise<const N: usize, C: CraneModel<N>>(
    crane: &C,
    q: &SVector<f64, N>,
    added_inertia: &SVector<f64, N>,
) -> Factors<N> {
    Cholesky::new(mass_matrix(crane, q) + SMatrix::from_diagonal(added_inertia))
}

/// x of `(A + D̂) x = r`; NaN if A + D̂ is not positive definite.
pub fn solve<const N: usize>(factors: &Factors<N>, r: &SVector<f64, N>) -> SVector<f64, N> {
    factors.as_ref().map_or(SVector::repeat(f64::NAN), |factors| factors.solve(r))
}

/// What a crane written by hand needs besides its equations, in its `impl CraneModel`: all parts, dense factors, and lanes one by one.
macro_rules! by_hand {
    ($size:tt) => {
        const PARTS: &'static [crane_model::Part] = &crane_model::Part::ALL;

        type Factors = $crate::common::implicit::Factors<$size>;
        type Lanes = crane_model::OneByOne<Self>;

        fn lanes(cranes: [&Self; 8]) -> Self::Lanes {
            crane_model::OneByOne(cranes.map(Clone::clone))
        }

        fn factorise(
            &self,
            q: &nalgebra::SVector<f64, $size>,
            added_inertia: &nalgebra::SVector<f64, $size>,
            _: &nalgebra::SMatrix<f64, 6, 6>,
        ) -> Self::Factors {
            $crate::common::implicit::factorise(self, q, added_inertia)
        }

        fn solve(&self, factors: &Self::Factors, r: &nalgebra::SVector<f64, $size>) -> nalgebra::SVector<f64, $size> {
            $crate::common::implicit::solve(factors, r)
        }
    };
}
pub(crate) use by_hand;
