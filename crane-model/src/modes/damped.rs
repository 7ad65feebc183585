//! Damped eigenvalues, `(λ²A + λD + K) x = 0`.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector, Schur, linalg::balancing};

use super::{
    NoModes, SmallMotions,
    eigenvectors::{Block, rounding},
};

/// Iterations of the QR algorithm for each eigenvalue: 2 to 4 are usual.
const ITERATIONS: usize = 100;
/// Relative accuracy of the QR algorithm.
const PRECISION: f64 = f64::EPSILON;

/// A damped mode: a conjugate pair of eigenvalues, or one real one.
#[derive(Clone, Debug, PartialEq)]
pub struct DampedMode {
    /// Eigenvalue λ with Im λ ≥ 0, 1/s.
    pub eigenvalue: Complex<f64>,
    /// Indices of the dominant coordinates, largest share of the energy first.
    pub dominating: Vec<usize>,
}

impl DampedMode {
    /// Undamped frequency `|λ|/2π`, Hz.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.norm() / TAU
    }

    /// Damping ratio `ζ = −Re λ/|λ|`: 1 for a mode that returns without oscillating, negative for one that grows.
    pub fn damping_ratio(&self) -> f64 {
        if self.eigenvalue.norm() > 0.0 { -self.eigenvalue.re / self.eigenvalue.norm() } else { 0.0 }
    }
}

/// Damped modes, lowest frequency first: eigenvalues and shapes of the balanced state matrix from its Schur form.
///
/// # Errors
/// The mass matrix is not positive definite, or the QR algorithm does not converge.
pub fn damped(motions: &SmallMotions) -> Result<Vec<DampedMode>, NoModes> {
    if motions.mass.is_empty() {
        return Ok(Vec::new());
    }
    let mut state = motions.state_matrix()?;
    if !state.iter().all(|x| x.is_finite()) {
        return Err(NoModes::Eigenvalues);
    }
    let scales = balancing::balance_parlett_reinsch(&mut state);
    let iterations = ITERATIONS * state.nrows();
    let (vectors, t) = Schur::try_new(state, PRECISION, iterations).ok_or(NoModes::Eigenvalues)?.unpack();
    let (blocks, least) = (Block::all(&t), rounding(&t));
    let mut modes: Vec<DampedMode> = blocks
        .iter()
        .map(|block| {
            let shape = shape(&vectors, &scales, &block.eigenvector(&t, &blocks, least));
            DampedMode { eigenvalue: block.eigenvalue(&t), dominating: motions.dominating(&shape) }
        })
        .collect();
    modes.sort_by(|a, b| a.eigenvalue.norm().total_cmp(&b.eigenvalue.norm()));
    Ok(modes)
}

/// Displacements of a mode, the upper half of its state, from its eigenvector `y` in the basis of the Schur form.
fn shape(vectors: &DMatrix<f64>, scales: &DVector<f64>, y: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let n = scales.len() / 2;
    let mut shape: DVector<Complex<f64>> = DVector::zeros(n);
    for (column, y) in vectors.column_iter().zip(y) {
        for (x, (entry, scale)) in shape.iter_mut().zip(column.iter().zip(scales)) {
            *x += *y * (*entry * *scale);
        }
    }
    shape
}
