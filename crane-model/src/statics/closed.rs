//! Equilibrium with closed loops: the equations of the open chain, restricted to motions that leave the loops closed.
//!
//! In coordinates scaled by the stiffness, `x = D^½ q`, with Q an orthonormal basis of the rows of J and `Π = I − Q Qᵀ`, a pose on φ = 0 is in
//! equilibrium if `Π r = 0`; then `Jᵀ λ = −r`. Its tangent is that of the Lagrangian,
//!
//! ```text
//! K̃ = Π (K + Σ λ_i ∂²φ_i/∂q²) Π + Q Qᵀ
//! ```
//!
//! which has the eigenvalues of K on the null space of J, and 1 otherwise: the pose is stable exactly if K̃ is positive definite, as the
//! bordered matrix `[K Jᵀ; J 0]` then has as many negative eigenvalues as J has rows (Haynsworth). Newton steps lie in the null space; the
//! pose is then moved back onto φ = 0 by Gauss–Newton steps, in which soft coordinates move most.

use nalgebra::{DMatrix, DVector};

use crate::{
    CoordinateKind, CoordinateRole, Description,
    dyn_crane::DynCrane,
    loop_joints::{Loops, geometric_stiffness},
};

/// A coordinate is at most this many times softer than the stiffest of its kind, for the choice of what moves when a loop closes.
const SOFTEST: f64 = 1e-6;

/// D of a crane with loops.
pub(super) struct Closed {
    /// D^½
    scale: DVector<f64>,
    prescribed: Vec<usize>,
}

/// Q and R with `D^-½ Jᵀ = Q R` at a pose, J of the independent equations, and their gaps.
struct Rows {
    basis: DMatrix<f64>,
    triangle: DMatrix<f64>,
    gaps: DVector<f64>,
    independent: Vec<usize>,
    equations: usize,
}

impl Closed {
    /// From the stiffness of the open chain at the guess.
    pub fn new(stiffness: &DMatrix<f64>, description: &Description) -> Self {
        let kind = |i: usize| description.coordinates[i].kind;
        let greatest = |of: CoordinateKind| {
            let own = (0..stiffness.nrows()).filter(|&i| kind(i) == of).map(|i| stiffness[(i, i)].abs());
            own.filter(|entry| entry.is_finite()).fold(0.0, f64::max)
        };
        let of_kinds = [CoordinateKind::Translation, CoordinateKind::Rotation].map(greatest);
        let either = of_kinds[0].max(of_kinds[1]).max(f64::MIN_POSITIVE);
        let scale = DVector::from_fn(stiffness.nrows(), |i, _| {
            let own = of_kinds[usize::from(kind(i) == CoordinateKind::Rotation)];
            let own = if own > 0.0 { own } else { either };
            stiffness[(i, i)].abs().clamp(SOFTEST * own, own).sqrt()
        });
        Self { scale, prescribed: description.prescribed() }
    }

    /// Moves a pose onto the loops; returns whether they close.
    pub fn close(&self, crane: &dyn DynCrane, q: &mut [f64]) -> bool {
        let roles: Vec<CoordinateRole> = crane.description().coordinates.iter().map(|info| info.role).collect();
        let mut soften = |_: &[f64], r: &[f64], x: &mut [f64]| {
            for (i, (x, r)) in x.iter_mut().zip(r).enumerate() {
                *x = if roles[i] == CoordinateRole::Prescribed { 0.0 } else { r / self.scale[i].powi(2) };
            }
        };
        Loops::new(crane).assemble(crane, q, &mut soften).is_ok()
    }

    fn rows(&self, crane: &dyn DynCrane, q: &[f64]) -> Rows {
        let n = q.len();
        let mut loops = Loops::new(crane);
        loops.evaluate(crane, q, &vec![0.0; n]);
        loops.choose();
        let independent = loops.independent().to_vec();
        let columns = DMatrix::from_fn(n, independent.len(), |i, k| {
            let entry = loops.jacobian()[independent[k] * n + i] / self.scale[i];
            if self.prescribed.contains(&i) { 0.0 } else { entry }
        });
        let (basis, triangle) = columns.qr().unpack();
        let gaps = DVector::from_iterator(independent.len(), independent.iter().map(|&row| loops.gap(row)));
        Rows { basis, triangle, gaps, independent, equations: crane.loop_equations() }
    }

    /// The residual of motions that leave the loops closed, `D^½ Π D^-½ r`.
    pub fn residual(&self, crane: &dyn DynCrane, q: &[f64], residual: &DVector<f64>) -> DVector<f64> {
        let rows = self.rows(crane, q);
        self.project(&rows, residual).component_mul(&self.scale)
    }

    /// `Π D^-½ r`, the part of a force along the motions that leave the loops closed, in scaled coordinates.
    fn project(&self, rows: &Rows, force: &DVector<f64>) -> DVector<f64> {
        let scaled = force.component_div(&self.scale);
        &scaled - &rows.basis * rows.basis.tr_mul(&scaled)
    }

    /// `D^½ K̃ D^½`, from the residual and the stiffness of the open chain, symmetric up to rounding if this one is.
    pub fn stiffness(
        &self,
        crane: &dyn DynCrane,
        q: &[f64],
        residual: &DVector<f64>,
        stiffness: &DMatrix<f64>,
    ) -> DMatrix<f64> {
        let rows = self.rows(crane, q);
        let whole = self.lagrangian(crane, q, &rows, residual, stiffness);
        let basis = &rows.basis;
        let half = &whole - basis * basis.tr_mul(&whole);
        let mut both = &half - (&half * basis) * basis.transpose() + basis * basis.transpose();
        self.restore(&mut both);
        both
    }

    /// A force r that acts on the motions that leave the loops closed, together with the gaps of the loops, and its derivatives by q and by a
    /// parameter, from those of the open chain:
    ///
    /// ```text
    /// D^½ (Π D^-½ r + Q R⁻ᵀ φ)        by q: D^½ (Π D^-½ (∂r/∂q + Σ λ_i ∂²φ_i/∂q²) D^-½ + Q Qᵀ) D^½
    /// ```
    ///
    /// The derivative is exact where r is in equilibrium.
    pub fn partly_loaded(
        &self,
        crane: &dyn DynCrane,
        q: &[f64],
        force: &DVector<f64>,
        by_pose: &DMatrix<f64>,
        by_parameter: &DVector<f64>,
    ) -> (DVector<f64>, DMatrix<f64>, DVector<f64>) {
        let rows = self.rows(crane, q);
        let basis = &rows.basis;
        let gaps = rows.triangle.tr_solve_upper_triangular(&rows.gaps).unwrap_or_else(|| rows.gaps.clone() * f64::NAN);
        let value = (self.project(&rows, force) + basis * gaps).component_mul(&self.scale);
        let whole = self.lagrangian(crane, q, &rows, force, by_pose);
        let mut derivative = &whole - basis * basis.tr_mul(&whole) + basis * basis.transpose();
        self.restore(&mut derivative);
        (value, derivative, self.project(&rows, by_parameter).component_mul(&self.scale))
    }

    /// `D^-½ (K + Σ λ_i ∂²φ_i/∂q²) D^-½`, where λ balances the residual.
    fn lagrangian(
        &self,
        crane: &dyn DynCrane,
        q: &[f64],
        rows: &Rows,
        residual: &DVector<f64>,
        stiffness: &DMatrix<f64>,
    ) -> DMatrix<f64> {
        let multipliers = rows.multipliers(&residual.component_div(&self.scale));
        let mut geometric = geometric_stiffness(crane, q, &multipliers);
        for &j in &self.prescribed {
            geometric.row_mut(j).fill(0.0);
            geometric.column_mut(j).fill(0.0);
        }
        let mut whole = stiffness + geometric;
        for (i, scale) in self.scale.iter().enumerate() {
            whole.row_mut(i).scale_mut(1.0 / scale);
            whole.column_mut(i).scale_mut(1.0 / scale);
        }
        whole
    }

    /// `D^½ X D^½` in place of X.
    fn restore(&self, matrix: &mut DMatrix<f64>) {
        for (i, scale) in self.scale.iter().enumerate() {
            matrix.row_mut(i).scale_mut(*scale);
            matrix.column_mut(i).scale_mut(*scale);
        }
    }
}

impl Rows {
    /// λ of every equation, by least squares from a scaled residual: `R λ = −Qᵀ r`.
    fn multipliers(&self, scaled: &DVector<f64>) -> Vec<f64> {
        let mut multipliers = vec![0.0; self.equations];
        let along = -self.basis.tr_mul(scaled);
        if let Some(shares) = self.triangle.solve_upper_triangular(&along) {
            for (&equation, share) in self.independent.iter().zip(shares.iter()) {
                multipliers[equation] = *share;
            }
        }
        multipliers
    }
}
