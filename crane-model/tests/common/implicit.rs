//! Implicit systems of cranes written by hand, by dense factors; lanes of eight cranes, evaluated one after the other.

use crane_model::{Dynamics, Ensemble, Implicit, OneByOne};
use nalgebra::{Cholesky, Const, SMatrix, SVector};

use super::{DoublePendulum, Fixed, Lift, Sledge};

/// A at a pose.
pub fn mass_matrix<const N: usize, C: Dynamics<N>>(crane: &C, q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
    let mut mass = SMatrix::zeros();
    crane.mass_matrix(q, &mut mass);
    mass
}

/// Factors of `A + D̂`.
pub type Factors<const N: usize> = Option<Cholesky<f64, Const<N>>>;

/// Factors of `A + D̂` for added inertias of single coordinates.
pub fn factorise<const N: usize, C: Dynamics<N>>(
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

macro_rules! implicit {
    ($crane:ty, $size:literal, $stiffness_and_damping:expr) => {
        impl Implicit<$size> for $crane {
            type Factors = Factors<$size>;

            fn factorise(
                &self,
                q: &SVector<f64, $size>,
                added_inertia: &SVector<f64, $size>,
                _: &SMatrix<f64, 6, 6>,
            ) -> Self::Factors {
                factorise(self, q, added_inertia)
            }

            fn solve(&self, factors: &Self::Factors, r: &SVector<f64, $size>) -> SVector<f64, $size> {
                solve(factors, r)
            }

            fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
                let stiffness_and_damping: fn(&Self) -> [[f64; 2]; $size] = $stiffness_and_damping;
                out.copy_from_slice(&stiffness_and_damping(self));
            }
        }

        impl Ensemble<$size> for $crane {
            type Lanes = OneByOne<Self>;

            fn lanes(cranes: [&Self; 8]) -> Self::Lanes {
                OneByOne(cranes.map(Clone::clone))
            }
        }
    };
}

implicit!(Lift, 1, |lift| [[lift.stiffness, lift.damping]]);
implicit!(DoublePendulum, 2, |_| [[0.0; 2]; 2]);
implicit!(Sledge, 2, |_| [[0.0; 2]; 2]);
implicit!(Fixed, 0, |_| []);
