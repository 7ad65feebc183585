//! What generated code calls besides nalgebra.

pub mod lanes;
mod mass_matrix;
mod sin_cos;

pub use lanes::fma;
pub use mass_matrix::{MassAndBias, MassColumns, Point};
pub use sin_cos::{sin_cos, sin_cos_lanes};

use nalgebra::{Matrix4, SMatrix, Vector3};

/// A symmetric matrix from its upper triangle: `upper[column][row]` with row ≤ column; what stands below is ignored.
#[inline]
pub fn symmetric<const N: usize>(mut upper: [[f64; N]; N]) -> SMatrix<f64, N, N> {
    for column in 0..N {
        for row in column + 1..N {
            upper[column][row] = upper[row][column];
        }
    }
    SMatrix::from(upper)
}

/// Copies results into the caller's place for them, as many as it has room for.
#[inline]
pub fn fill<T: Copy>(out: &mut [T], results: &[T]) {
    for (place, result) in out.iter_mut().zip(results) {
        *place = *result;
    }
}

/// What the second derivatives of transforms are made of, `∂²T/∂q_m∂q_n = Ω_m Ω_n T`: the columns of `Ω_n T` are
/// directions, so `Ω_m` only turns them about its axis.
#[derive(Clone, Copy, Debug)]
pub struct TransformFactors<const N: usize, const D: usize> {
    /// `ω_m`, zero for a translation.
    pub axes: [Vector3<f64>; N],
    /// `∂T/∂q_n`, body by body.
    pub first: [Matrix4<f64>; D],
}

impl<const N: usize, const D: usize> TransformFactors<N, D> {
    /// All zero.
    pub fn zeros() -> Self {
        TransformFactors { axes: [Vector3::zeros(); N], first: [Matrix4::zeros(); D] }
    }

    /// `∂²T/∂q_m∂q_n`, body by body, m ≤ n; `degrees`: how many coordinates move each body.
    pub fn second_derivatives(&self, degrees: &[usize], out: &mut [Matrix4<f64>]) {
        let mut first = self.first.as_slice();
        let mut out = out.iter_mut();
        for &count in degrees {
            let (own, rest) = first.split_at(count.min(first.len()));
            first = rest;
            for (m, axis) in self.axes.iter().enumerate().take(count) {
                for (derivative, out) in own.iter().skip(m).zip(&mut out) {
                    *out = turned(axis, derivative);
                }
            }
        }
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
