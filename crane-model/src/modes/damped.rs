//! Damped eigenvalues, `(λ²A + λD + K) x = 0`.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector, Schur, linalg::balancing};

use super::{
    NoModes, SmallMotions, damping_ratio,
    eigenvectors::{Block, rounding},
};

/// Maximum iterations of the QR algorithm per eigenvalue: 2 to 4 are usual.
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

    /// [Damping ratio](damping_ratio); 0 where it is the rounding of its eigenvalue, whose parts are known to some 1e-12 of its size.
    pub fn damping_ratio(&self) -> f64 {
        /// No crane is damped so little.
        const ROUNDING: f64 = 1e-9;
        let ratio = damping_ratio(self.eigenvalue);
        if ratio.abs() < ROUNDING { 0.0 } else { ratio }
    }
}

/// Damped modes, lowest frequency first: eigenvalues and shapes of the balanced state matrix from its Schur form.
///
/// # Errors
/// The mass matrix is not positive definite, or the QR algorithm does not converge.
pub fn damped(motions: &SmallMotions) -> Result<Vec<DampedMode>, NoModes> {
    Ok(damped_with_shapes(motions)?.into_iter().map(|(mode, _)| mode).collect())
}

/// A shape in generalized coordinates, with phases.
pub type ComplexShape = DVector<Complex<f64>>;

/// Damped modes and their shapes x, lowest frequency first: displacements `Re (x exp λt)` of the coordinates that can move, with
/// `xᴴ A x = 1` and the dominant coordinate real and positive.
///
/// # Errors
/// As [`damped`].
pub fn damped_with_shapes(motions: &SmallMotions) -> Result<Vec<(DampedMode, ComplexShape)>, NoModes> {
    if motions.mass.is_empty() {
        return Ok(Vec::new());
    }
    let n = motions.mass.nrows();
    let mass = motions.mass.map(Complex::from);
    let mut modes: Vec<_> = eigenpairs(motions.state_matrix()?)?
        .into_iter()
        .map(|(eigenvalue, vector)| {
            let shape = vector.rows(0, n).into_owned();
            let dominating = motions.dominating(&shape);
            let first = motions.unknowns.iter().position(|unknown| Some(unknown) == dominating.first());
            let shape = normalised(shape, &mass, first);
            (DampedMode { eigenvalue, dominating }, shape)
        })
        .collect();
    modes.sort_by(|(a, _), (b, _)| a.eigenvalue.norm().total_cmp(&b.eigenvalue.norm()));
    Ok(modes)
}

/// The shape with `xᴴ A x = 1`, and real and positive at the index `at`.
fn normalised(shape: ComplexShape, mass: &DMatrix<Complex<f64>>, at: Option<usize>) -> ComplexShape {
    let norm = shape.dotc(&(mass * &shape)).re.sqrt();
    let phase = at.map_or(0.0, |largest| shape[largest].arg());
    if norm > 0.0 { shape * Complex::from_polar(1.0 / norm, -phase) } else { shape }
}

/// An eigenvalue and its eigenvector.
pub(super) type Eigenpair = (Complex<f64>, ComplexShape);

/// The eigenvalues of a state matrix with Im λ ≥ 0.
///
/// # Errors
/// The matrix has numbers that are not finite, or the QR algorithm does not converge.
pub(crate) fn eigenvalues(mut state: DMatrix<f64>) -> Result<Vec<Complex<f64>>, NoModes> {
    if state.is_empty() {
        return Ok(Vec::new());
    }
    if !state.iter().all(|x| x.is_finite()) {
        return Err(NoModes::Eigenvalues);
    }
    balancing::balance_parlett_reinsch(&mut state);
    let iterations = ITERATIONS * state.nrows();
    let (_, t) = Schur::try_new(state, PRECISION, iterations).ok_or(NoModes::Eigenvalues)?.unpack();
    Ok(Block::all(&t).iter().map(|block| block.eigenvalue(&t)).collect())
}

/// The eigenvalues of a state matrix with Im λ ≥ 0, and their eigenvectors, from the Schur form of the balanced matrix.
///
/// # Errors
/// The matrix has numbers that are not finite, or the QR algorithm does not converge.
pub(super) fn eigenpairs(mut state: DMatrix<f64>) -> Result<Vec<Eigenpair>, NoModes> {
    if !state.iter().all(|x| x.is_finite()) {
        return Err(NoModes::Eigenvalues);
    }
    let scales = balancing::balance_parlett_reinsch(&mut state);
    let iterations = ITERATIONS * state.nrows();
    let (vectors, t) = Schur::try_new(state, PRECISION, iterations).ok_or(NoModes::Eigenvalues)?.unpack();
    let (blocks, least) = (Block::all(&t), rounding(&t));
    let pair = |block: &Block| {
        let vector = original(&vectors, &scales, &block.eigenvector(&t, &blocks, least));
        (block.eigenvalue(&t), vector)
    };
    Ok(blocks.iter().map(pair).collect())
}

/// The eigenvector of a matrix whose balanced form has the eigenvector `y` in the basis of its Schur form.
fn original(vectors: &DMatrix<f64>, scales: &DVector<f64>, y: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
    let mut vector: DVector<Complex<f64>> = DVector::zeros(scales.len());
    for (column, y) in vectors.column_iter().zip(y) {
        for (x, (entry, scale)) in vector.iter_mut().zip(column.iter().zip(scales)) {
            *x += *y * (*entry * *scale);
        }
    }
    vector
}
