//! The linear system of an implicit step, of half the size.
//!
//! On the second-order form `A q̈ = e + f`, the Jacobian holds stiffness and damping of springs and dampers alone,
//! `J = [[0, I], [−A⁻¹K̂, −A⁻¹D̂]]`: gravity, velocity forces and the change of A are left out. Then
//! `(I/c − J) u = (P, G + A⁻¹F)` with `u = (p, w)` comes down to one system with as many unknowns as coordinates, which the
//! O(n) recursion solves:
//!
//! ```text
//! (A + cD̂ + c²K̂) z = −c² ((D̂ + cK̂) G + K̂ P) + c F,     w = c G + z,     p = c (w + P)
//! ```

use nalgebra::{SMatrix, SVector};

use super::motion::Motion;
use crate::Implicit;

/// A diagonal matrix, but for the block of the base's coordinates.
struct Structured<const N: usize> {
    diagonal: SVector<f64, N>,
    base: SMatrix<f64, 6, 6>,
}

impl<const N: usize> Structured<N> {
    fn times(&self, x: &SVector<f64, N>) -> SVector<f64, N> {
        let mut product = self.diagonal.component_mul(x);
        let [column] = &mut product.data.0;
        for (base, x) in self.base.data.0.iter().zip(&x.data.0[0]) {
            for (product, base) in column.iter_mut().zip(base) {
                *product += base * x;
            }
        }
        product
    }
}

/// `A + cD̂ + c²K̂`, factorised.
pub(super) struct System<const N: usize, C: Implicit<N>> {
    factors: C::Factors,
    stiffness: Structured<N>,
    damping: Structured<N>,
    /// c, s.
    c: f64,
}

impl<const N: usize, C: Implicit<N>> System<N, C> {
    /// About the pose `q`.
    pub fn new(crane: &C, q: &SVector<f64, N>, c: f64) -> Self {
        let mut joints = [[0.0; 2]; N];
        crane.joint_impedances(&mut joints);
        let diagonal = |of: usize| SVector::from_fn(|i, _| joints[i][of]);
        let stiffness = Structured { diagonal: diagonal(0), base: crane.base_stiffness(q) };
        let damping = Structured { diagonal: diagonal(1), base: crane.base_damping(q) };
        let resistance = damping.diagonal * c + stiffness.diagonal * (c * c);
        let base = damping.base * c + stiffness.base * (c * c);
        Self { factors: crane.factorise(q, &resistance, &base), stiffness, damping, c }
    }

    /// u for a right-hand side `(P, G, ·)` and a force F.
    pub fn solve<const M: usize>(&self, crane: &C, rhs: &Motion<N, M>, force: &SVector<f64, N>) -> Motion<N, M> {
        let Motion { q: p, v: g, sum } = rhs;
        let c = self.c;
        let right = (self.damping.times(g) + self.stiffness.times(&(g * c + p))) * (-c * c) + force * c;
        let w = g * c + crane.solve(&self.factors, &right);
        Motion { q: (w + p) * c, v: w, sum: sum * c }
    }
}
