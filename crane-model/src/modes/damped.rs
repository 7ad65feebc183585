//! Damped eigenvalues, `(λ²A + λD + K) x = 0`.

use std::f64::consts::TAU;

use nalgebra::{Complex, DVector, Schur, linalg::balancing};

use super::{NoModes, SmallMotions};

/// Iterations of the QR algorithm for each eigenvalue: 2 to 4 are usual.
const ITERATIONS: usize = 100;
/// Relative accuracy of the QR algorithm.
const PRECISION: f64 = f64::EPSILON;
/// Relative offset of the shift of inverse iteration: off the eigenvalue by enough for a regular matrix, by little enough
/// for convergence in two steps.
const OFFSET: f64 = 1e-7;

/// A damped mode: a conjugate pair of eigenvalues, or one real one.
#[derive(Clone, Debug, PartialEq)]
pub struct DampedMode {
    /// Eigenvalue λ with Im λ ≥ 0, 1/s.
    pub eigenvalue: Complex<f64>,
    /// Indices of the coordinates that dominate, greatest share of the energy first.
    pub dominating: Vec<usize>,
}

impl DampedMode {
    /// Undamped frequency `|λ|/2π`, Hz.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.norm() / TAU
    }

    /// Damping ratio `ζ = −Re λ/|λ|`: 1 for a mode that creeps back without swinging, negative for one that grows.
    pub fn damping_ratio(&self) -> f64 {
        if self.eigenvalue.norm() > 0.0 { -self.eigenvalue.re / self.eigenvalue.norm() } else { 0.0 }
    }
}

/// Damped modes, lowest frequency first: eigenvalues of the balanced state matrix, shapes by inverse iteration.
///
/// # Errors
/// The mass matrix is not positive definite, or the QR algorithm does not come to an end.
pub fn damped(motions: &SmallMotions) -> Result<Vec<DampedMode>, NoModes> {
    if motions.mass.is_empty() {
        return Ok(Vec::new());
    }
    let mut state = motions.state_matrix()?;
    if !state.iter().all(|x| x.is_finite()) {
        return Err(NoModes::Eigenvalues);
    }
    balancing::balance_parlett_reinsch(&mut state);
    let iterations = ITERATIONS * state.nrows();
    let schur = Schur::try_new(state, PRECISION, iterations).ok_or(NoModes::Eigenvalues)?;
    let mut modes: Vec<DampedMode> = schur
        .complex_eigenvalues()
        .iter()
        .filter(|eigenvalue| eigenvalue.im >= 0.0)
        .map(|&eigenvalue| {
            let dominating = shape(motions, eigenvalue).map_or_else(Vec::new, |shape| motions.dominating(&shape));
            DampedMode { eigenvalue, dominating }
        })
        .collect();
    modes.sort_by(|a, b| a.eigenvalue.norm().total_cmp(&b.eigenvalue.norm()));
    Ok(modes)
}

/// Shape of the mode with eigenvalue λ; `None` if the dynamic stiffness is singular at the shift too.
fn shape(motions: &SmallMotions, eigenvalue: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let n = motions.mass.nrows();
    let shift = eigenvalue * (1.0 + OFFSET) + Complex::new(0.0, f64::EPSILON);
    let factors = motions.dynamic_stiffness(shift).lu();
    // Any start that is not orthogonal to the shape; equal displacements in the measure of energy.
    let mut shape =
        DVector::from_fn(n, |i, _| Complex::from(motions.mass[(i, i)].abs().max(f64::MIN_POSITIVE).sqrt().recip()));
    for _ in 0..2 {
        shape = factors.solve(&shape)?;
        let size = shape.camax();
        if !(size.is_normal()) {
            return None;
        }
        shape.unscale_mut(size);
    }
    Some(shape)
}
