//! Functions that generated code calls, in addition to nalgebra.

pub mod derivatives;
mod fused;
pub mod lanes;
mod mass_matrix;
mod sin_cos;
mod stumpff;
mod tangent;

pub use lanes::{exp, fma, select, sqrt};
pub use mass_matrix::{ConcurrentAxes, MassAndBias, MassColumns};
pub use sin_cos::{sin_cos, sin_cos_lanes};
pub use stumpff::{next_stumpff, stumpff, stumpff_lanes};
pub use tangent::fill_tangent;

/// Numbers of sines and cosines, for code that is made at run time.
pub mod sines {
    pub use super::sin_cos::{COSINE, HALF_PI, LARGEST, ROUND, SINE};
}

use nalgebra::{Matrix4, SMatrix, Vector3};

/// Completes a symmetric matrix, of whose columns only the entries from the diagonal down are known.
#[inline]
pub fn mirror<const N: usize>(columns: &mut [[f64; N]; N]) {
    for column in 0..N {
        for row in 0..column {
            columns[column][row] = columns[row][column];
        }
    }
}

/// A symmetric matrix from its columns from the diagonal down; entries above the diagonal are ignored.
#[inline]
pub fn symmetric<const N: usize>(mut lower: [[f64; N]; N]) -> SMatrix<f64, N, N> {
    mirror(&mut lower);
    SMatrix::from(lower)
}

/// Copies results into the caller's slice, as many as fit.
#[inline]
pub fn fill<T: Copy>(out: &mut [T], results: &[T]) {
    for (entry, result) in out.iter_mut().zip(results) {
        *entry = *result;
    }
}

/// The factors of the second derivatives of transforms, `∂²T/∂q_m∂q_n = Ω_m Ω_n T`: the columns of `Ω_n T` are directions, so
/// `Ω_m` only rotates them about its axis.
#[derive(Clone, Copy, Debug)]
pub struct TransformFactors<const N: usize, const D: usize, const V: usize = 0> {
    /// `ω_m`, zero for a translation.
    pub axes: [Vector3<f64>; N],
    /// `∂T/∂q_n`, body by body.
    pub first: [Matrix4<f64>; D],
    /// First coordinates of rotation vectors; a pair of the three coordinates k of such a vector has the additional term
    /// `Σ_k share_k ∂T/∂q_k`.
    pub vectors: [usize; V],
    /// The shares of the six pairs of each rotation vector, row by row of a triangle.
    pub shares: [[[f64; 3]; 6]; V],
}

impl<const N: usize, const D: usize, const V: usize> TransformFactors<N, D, V> {
    /// All zero.
    pub fn zeros() -> Self {
        TransformFactors {
            axes: [Vector3::zeros(); N],
            first: [Matrix4::zeros(); D],
            vectors: [0; V],
            shares: [[[0.0; 3]; 6]; V],
        }
    }

    /// `∂²T/∂q_m∂q_n`, body by body, m ≤ n; `degrees`: the number of coordinates that move each body.
    pub fn second_derivatives(&self, degrees: &[usize], out: &mut [Matrix4<f64>]) {
        let mut first = self.first.as_slice();
        let mut out = out.iter_mut();
        for &count in degrees {
            let (of_body, rest) = first.split_at(count.min(first.len()));
            first = rest;
            for (m, axis) in self.axes.iter().enumerate().take(count) {
                let shares = self.shares_of(m);
                for ((n, derivative), out) in of_body.iter().enumerate().skip(m).zip(&mut out) {
                    *out = turned(axis, derivative);
                    let Some((first, pairs)) = shares.filter(|(first, _)| n < first + 3) else { continue };
                    let row = m - first;
                    let pair = row * 3 - row * row.saturating_sub(1) / 2 + n - m;
                    for (share, of_body) in pairs.get(pair).into_iter().flatten().zip(of_body.iter().skip(first)) {
                        *out += *share * of_body;
                    }
                }
            }
        }
    }

    /// The rotation vector that a coordinate belongs to: its first coordinate and its shares.
    fn shares_of(&self, coordinate: usize) -> Option<(usize, &[[f64; 3]; 6])> {
        let belongs = |(first, _): &(usize, _)| (*first..first + 3).contains(&coordinate);
        self.vectors.iter().copied().zip(&self.shares).find(belongs)
    }
}

/// `ω × column` of every column.
#[inline]
fn turned(axis: &Vector3<f64>, matrix: &Matrix4<f64>) -> Matrix4<f64> {
    let mut turned = Matrix4::zeros();
    for (out, column) in turned.data.0.iter_mut().zip(&matrix.data.0) {
        out[0] = axis.y * column[2] - axis.z * column[1];
        out[1] = axis.z * column[0] - axis.x * column[2];
        out[2] = axis.x * column[1] - axis.y * column[0];
    }
    turned
}
