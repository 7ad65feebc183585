//! Undamped modes, `K x = ω² A x`.

use std::f64::consts::TAU;

use nalgebra::{DVector, SymmetricEigen};

use super::{NoModes, SmallMotions};

/// An undamped mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Eigenvalue ω², rad²/s²; negative where the pose is unstable.
    pub omega_squared: f64,
    /// Shape x in generalized coordinates, `xᵀ A x = 1`.
    pub shape: DVector<f64>,
    /// Indices of the dominant coordinates, largest share of the energy first.
    pub dominating: Vec<usize>,
}

impl Mode {
    /// Frequency `ω/2π`, Hz; `None` where the pose is unstable in this mode.
    pub fn frequency(&self) -> Option<f64> {
        (self.omega_squared >= 0.0).then(|| self.omega_squared.sqrt() / TAU)
    }
}

/// Undamped modes, lowest first: with `A = L Lᵀ` the symmetric eigenproblem of `L⁻¹ K L⁻ᵀ`.
///
/// # Errors
/// The mass matrix is not positive definite.
pub fn undamped(motions: &SmallMotions) -> Result<Vec<Mode>, NoModes> {
    if motions.mass.is_empty() {
        return Ok(Vec::new());
    }
    let factor = motions.factors()?.unpack();
    let half = factor.solve_lower_triangular(&motions.stiffness).ok_or(NoModes::MassMatrix)?;
    let whole = factor.solve_lower_triangular(&half.transpose()).ok_or(NoModes::MassMatrix)?;
    // Symmetric up to rounding; the eigenvalue routine reads only one half.
    let SymmetricEigen { eigenvalues, eigenvectors } = ((&whole + whole.transpose()) * 0.5).symmetric_eigen();
    let shapes = factor.tr_solve_lower_triangular(&eigenvectors).ok_or(NoModes::MassMatrix)?;

    let mut modes: Vec<Mode> = eigenvalues
        .iter()
        .zip(shapes.column_iter())
        .map(|(&omega_squared, shape)| {
            let shape = shape.into_owned();
            let dominating = motions.dominating(&shape);
            Mode { omega_squared, shape: motions.shape(&shape), dominating }
        })
        .collect();
    modes.sort_by(|a, b| a.omega_squared.total_cmp(&b.omega_squared));
    Ok(modes)
}
