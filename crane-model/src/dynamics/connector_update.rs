//! The contribution of connectors to the linear system of an implicit step: a term of low rank.
//!
//! A connector whose length changes with `J q̇` has the stiffness `Jᵀ k J` and the damping `Jᵀ d J`. With M the system without
//! connectors, their rows J in U and `R = diag(c d + c² k)`, the Woodbury identity solves the system with connectors by solutions of M:
//!
//! ```text
//! (M + Uᵀ R U)⁻¹ r = y − W S⁻¹ U y,     y = M⁻¹ r,     W = M⁻¹ Uᵀ,     S = R⁻¹ + U W
//! ```
//!
//! A factorisation therefore costs one more solution for each connector. M. A. Woodbury, Inverting modified matrices, Princeton
//! University 1950.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::{
    Tension,
    dyn_crane::{DynImplicit, DynSystem},
};

/// The connectors of a crane at a state.
pub(super) struct ConnectorUpdate {
    rows: Vec<Row>,
    /// S.
    schur: Option<Cholesky<f64, Dyn>>,
    /// S⁻¹ U y.
    shares: DVector<f64>,
    /// Rows J of all connectors.
    jacobians: Vec<f64>,
    tensions: Vec<Tension>,
}

/// A connector; J is 0 while it does not resist.
struct Row {
    /// The coordinates that change its length: the first, and the one after the last.
    spanned: [usize; 2],
    /// J of the spanned coordinates.
    jacobian: Vec<f64>,
    /// M⁻¹ Jᵀ.
    inverse_column: Vec<f64>,
    /// k, N/m, and d, N s/m.
    stiffness_and_damping: [f64; 2],
    /// `c d + c² k`
    added_inertia: f64,
}

impl ConnectorUpdate {
    /// Storage for the connectors of a crane.
    pub fn new(crane: &dyn DynImplicit) -> Self {
        let n = crane.size();
        let connectors = &crane.description().connectors;
        let row = |spanned @ [first, end]: [usize; 2]| Row {
            spanned,
            jacobian: vec![0.0; end - first],
            inverse_column: vec![0.0; n],
            stiffness_and_damping: [0.0; 2],
            added_inertia: 0.0,
        };
        Self {
            rows: connectors.iter().map(|connector| row(connector.spanned)).collect(),
            schur: None,
            shares: DVector::zeros(connectors.len()),
            jacobians: vec![0.0; connectors.len() * n],
            tensions: vec![Tension::ZERO; connectors.len()],
        }
    }

    /// Evaluates J, k and d at a state, and prepares solutions; `factors` are those of the system without connectors.
    pub fn factorise(
        &mut self,
        crane: &dyn DynImplicit,
        t: f64,
        (q, v): (&[f64], &[f64]),
        c: f64,
        factors: &mut dyn DynSystem,
    ) {
        let (count, n) = (self.rows.len(), q.len());
        if count == 0 {
            return;
        }
        crane.connector_tensions(t, q, v, &mut self.tensions);
        crane.connector_jacobians(q, &mut self.jacobians);
        for ((row, tension), jacobian) in self.rows.iter_mut().zip(&self.tensions).zip(self.jacobians.chunks_exact(n)) {
            row.stiffness_and_damping = tension.stiffness_and_damping();
            let [stiffness, damping] = row.stiffness_and_damping;
            row.added_inertia = damping * c + stiffness * (c * c);
            if row.added_inertia > 0.0 {
                let [first, end] = row.spanned;
                row.jacobian.copy_from_slice(&jacobian[first..end]);
                factors.solve(jacobian, &mut row.inverse_column);
            } else {
                row.jacobian.fill(0.0);
                row.inverse_column.fill(0.0);
            }
        }
        let room = self.schur.take().map_or_else(|| DMatrix::zeros(count, count), Cholesky::unpack_dirty);
        self.schur = Cholesky::new(self.fill_schur(room));
    }

    /// S; a connector that does not resist has 1 on the diagonal.
    fn fill_schur(&self, mut schur: DMatrix<f64>) -> DMatrix<f64> {
        for (i, one) in self.rows.iter().enumerate() {
            for (j, other) in self.rows.iter().enumerate() {
                schur[(i, j)] = one.along(&other.inverse_column);
            }
            schur[(i, i)] += if one.added_inertia > 0.0 { 1.0 / one.added_inertia } else { 1.0 };
        }
        schur
    }

    /// Whether at a state a connector resists much more or much less than where the system was factorised.
    pub fn switched(&mut self, crane: &dyn DynImplicit, t: f64, (q, v): (&[f64], &[f64])) -> bool {
        if self.rows.is_empty() {
            return false;
        }
        crane.connector_tensions(t, q, v, &mut self.tensions);
        let mut pairs = self
            .rows
            .iter()
            .zip(&self.tensions)
            .map(|(row, now)| (row.stiffness_and_damping, now.stiffness_and_damping()));
        pairs.any(|(before, now)| before.iter().zip(now).any(|(before, now)| differs(*before, now)))
    }

    /// Adds `D̂ G + K̂ (c G + P)` of the connectors.
    pub fn add_to(&self, (g, p): (&[f64], &[f64]), c: f64, right: &mut [f64]) {
        for row in &self.rows {
            let [stiffness, damping] = row.stiffness_and_damping;
            let (g, p) = (row.along(g), row.along(p));
            let force = damping * g + stiffness * (c * g + p);
            for (right, column) in right[row.spanned[0]..].iter_mut().zip(&row.jacobian) {
                *right += force * column;
            }
        }
    }

    /// The transpose of [`add_to`](Self::add_to): adds the weights of G and P, given those of what it adds to.
    pub fn pull_back(&self, weights: &[f64], c: f64, (g, p): (&mut [f64], &mut [f64])) {
        for row in &self.rows {
            let [stiffness, damping] = row.stiffness_and_damping;
            let force = row.along(weights);
            for (sum, factor) in [(&mut *g, damping + stiffness * c), (&mut *p, stiffness)] {
                for (sum, column) in sum[row.spanned[0]..].iter_mut().zip(&row.jacobian) {
                    *sum += force * factor * column;
                }
            }
        }
    }

    /// Turns the solution of the system without connectors into that of the system with them.
    pub fn correct(&mut self, solution: &mut [f64]) {
        let Some(schur) = &self.schur else { return };
        for (share, row) in self.shares.iter_mut().zip(&self.rows) {
            *share = row.along(solution);
        }
        schur.solve_mut(&mut self.shares);
        for (row, share) in self.rows.iter().zip(&self.shares) {
            for (x, entry) in solution.iter_mut().zip(&row.inverse_column) {
                *x -= share * entry;
            }
        }
    }
}

impl Row {
    /// J x
    fn along(&self, x: &[f64]) -> f64 {
        self.jacobian.iter().zip(&x[self.spanned[0]..]).map(|(column, x)| column * x).sum()
    }
}

/// Whether a stiffness or a damping is less than half or more than twice what it was.
pub(super) fn differs(before: f64, now: f64) -> bool {
    (now - before).abs() > 0.5 * before.abs().max(now.abs())
}
