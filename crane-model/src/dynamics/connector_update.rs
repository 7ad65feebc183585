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
    StateAt, Tension,
    dyn_crane::{DynSystem, Functions},
    interleaved,
};

/// The connectors of a crane at a state, of each crane of a fleet.
pub(super) struct ConnectorUpdate {
    /// Number of cranes.
    cranes: usize,
    rows: Vec<ConnectorRow>,
    /// The lower triangle of `U W` of all cranes.
    products: Vec<f64>,
    /// S of each crane.
    schur: Vec<Option<Cholesky<f64, Dyn>>>,
    /// `−S⁻¹ U y` of all cranes.
    shares: Vec<f64>,
    /// The same of one crane.
    of_crane: DVector<f64>,
    /// Rows J of all connectors.
    jacobians: Vec<f64>,
    tensions: Vec<Tension>,
    /// Workspace: two numbers of each crane.
    along: [Vec<f64>; 2],
}

/// A connector of each crane; J of a crane is 0 while it does not resist there.
struct ConnectorRow {
    /// The coordinates that change its length: the first, and the one after the last.
    spanned: [usize; 2],
    /// J of the spanned coordinates.
    jacobian: Vec<f64>,
    /// M⁻¹ Jᵀ.
    inverse_column: Vec<f64>,
    /// k, N/m, and d, N s/m.
    stiffness_and_damping: Vec<[f64; 2]>,
    /// `c d + c² k`
    added_inertia: Vec<f64>,
}

impl ConnectorUpdate {
    /// Storage for the connectors of a crane.
    pub fn new(crane: &dyn Functions) -> Self {
        let (n, cranes) = (crane.size(), crane.cranes());
        let connectors = &crane.description().connectors;
        let count = connectors.len() / cranes;
        let zeros = |len: usize| vec![0.0; len];
        let row = |spanned @ [first, end]: [usize; 2]| ConnectorRow {
            spanned,
            jacobian: zeros(end - first),
            inverse_column: zeros(n),
            stiffness_and_damping: vec![[0.0; 2]; cranes],
            added_inertia: zeros(cranes),
        };
        Self {
            cranes,
            rows: connectors.iter().step_by(cranes).map(|connector| row(connector.spanned)).collect(),
            products: zeros(count * (count + 1) / 2 * cranes),
            schur: vec![None; cranes],
            shares: zeros(count * cranes),
            of_crane: DVector::zeros(count),
            jacobians: zeros(count * n),
            tensions: vec![Tension::ZERO; connectors.len()],
            along: [zeros(cranes), zeros(cranes)],
        }
    }

    /// Evaluates J, k and d at a state, and prepares solutions; `factors` are those of the system without connectors.
    pub fn factorise(
        &mut self,
        crane: &dyn Functions,
        &StateAt { t, q, v, .. }: &StateAt<'_>,
        c: f64,
        factors: &mut dyn DynSystem,
    ) {
        if self.rows.is_empty() {
            return;
        }
        crane.connector_tensions(t, q, v, &mut self.tensions);
        crane.connector_jacobians(q, &mut self.jacobians);
        let evaluated = self.tensions.chunks_exact(self.cranes).zip(self.jacobians.chunks_exact_mut(q.len()));
        for (row, (tensions, jacobian)) in self.rows.iter_mut().zip(evaluated) {
            row.take(tensions, jacobian, c);
            if row.resists() {
                factors.solve(jacobian, &mut row.inverse_column);
            } else {
                row.inverse_column.fill(0.0);
            }
        }
        self.multiply();
        for crane in 0..self.cranes {
            let count = self.rows.len();
            let room = self.schur[crane].take().map_or_else(|| DMatrix::zeros(count, count), Cholesky::unpack_dirty);
            self.schur[crane] = Cholesky::new(self.fill_schur(crane, room));
        }
    }

    /// The lower triangle of `U W`, row by row.
    fn multiply(&mut self) {
        let mut products = self.products.chunks_exact_mut(self.cranes);
        for (i, one) in self.rows.iter().enumerate() {
            for (other, product) in self.rows[..=i].iter().zip(&mut products) {
                one.along(&other.inverse_column, product);
            }
        }
    }

    /// The lower triangle of S of a crane; a connector that does not resist has 1 on the diagonal.
    fn fill_schur(&self, crane: usize, mut schur: DMatrix<f64>) -> DMatrix<f64> {
        let mut products = interleaved::of_crane(&self.products, crane, self.cranes);
        for (i, row) in self.rows.iter().enumerate() {
            for (j, product) in (0..=i).zip(&mut products) {
                schur[(i, j)] = *product;
            }
            let added_inertia = row.added_inertia[crane];
            schur[(i, i)] += if added_inertia > 0.0 { 1.0 / added_inertia } else { 1.0 };
        }
        schur
    }

    /// Whether at a state a connector resists much more or much less than where the system was factorised.
    pub fn switched(&mut self, crane: &dyn Functions, &StateAt { t, q, v, .. }: &StateAt<'_>) -> bool {
        if self.rows.is_empty() {
            return false;
        }
        crane.connector_tensions(t, q, v, &mut self.tensions);
        let before = self.rows.iter().flat_map(|row| &row.stiffness_and_damping);
        let mut pairs = before.zip(&self.tensions).map(|(before, now)| (before, now.stiffness_and_damping()));
        pairs.any(|(before, now)| before.iter().zip(now).any(|(before, now)| differs(*before, now)))
    }

    /// Adds `D̂ G + K̂ (c G + P)` of the connectors.
    pub fn add_to(&mut self, (g, p): (&[f64], &[f64]), c: f64, right: &mut [f64]) {
        let [forces, of_p] = &mut self.along;
        for row in &self.rows {
            row.along(g, forces);
            row.along(p, of_p);
            for ((force, p), [stiffness, damping]) in forces.iter_mut().zip(&*of_p).zip(&row.stiffness_and_damping) {
                *force = damping * *force + stiffness * (c * *force + p);
            }
            row.add_to(right, forces);
        }
    }

    /// The transpose of [`add_to`](Self::add_to): adds the weights of G and P, given those of what it adds to.
    pub fn pull_back(&mut self, weights: &[f64], c: f64, (g, p): (&mut [f64], &mut [f64])) {
        let [of_g, of_p] = &mut self.along;
        for row in &self.rows {
            row.along(weights, of_p);
            for ((g, p), [stiffness, damping]) in of_g.iter_mut().zip(&mut *of_p).zip(&row.stiffness_and_damping) {
                (*g, *p) = (*p * (damping + stiffness * c), *p * stiffness);
            }
            row.add_to(g, of_g);
            row.add_to(p, of_p);
        }
    }

    /// Turns the solution of the system without connectors into that of the system with them.
    pub fn correct(&mut self, solution: &mut [f64]) {
        let Self { cranes, rows, schur, shares, of_crane, .. } = self;
        if rows.is_empty() || schur.iter().all(Option::is_none) {
            return;
        }
        for (row, shares) in rows.iter().zip(shares.chunks_exact_mut(*cranes)) {
            row.along(solution, shares);
        }
        for (crane, schur) in schur.iter().enumerate() {
            interleaved::gather(shares, crane, *cranes, of_crane.as_mut_slice());
            if let Some(schur) = schur {
                schur.solve_mut(of_crane);
            }
            let own = interleaved::of_crane_mut(shares, crane, *cranes);
            own.zip(&*of_crane).for_each(|(share, own)| *share = -own);
        }
        for (row, shares) in rows.iter().zip(shares.chunks_exact(*cranes)) {
            interleaved::add(shares, &row.inverse_column, solution);
        }
    }
}

impl ConnectorRow {
    /// Takes k and d of each crane, and J, which becomes 0 where they do not resist.
    fn take(&mut self, tensions: &[Tension], jacobian: &mut [f64], c: f64) {
        let of_cranes = self.stiffness_and_damping.iter_mut().zip(&mut self.added_inertia);
        for (crane, ((stiffness_and_damping, added_inertia), tension)) in of_cranes.zip(tensions).enumerate() {
            *stiffness_and_damping = tension.stiffness_and_damping();
            let [stiffness, damping] = *stiffness_and_damping;
            *added_inertia = damping * c + stiffness * (c * c);
            let resists = *added_inertia > 0.0;
            if !resists {
                interleaved::of_crane_mut(jacobian, crane, tensions.len()).for_each(|entry| *entry = 0.0);
            }
        }
        let [first, end] = self.spanned;
        self.jacobian.copy_from_slice(&jacobian[first..end]);
    }

    /// Whether it resists in any crane.
    fn resists(&self) -> bool {
        self.added_inertia.iter().any(|added_inertia| *added_inertia > 0.0)
    }

    /// `J x` of each crane.
    fn along(&self, x: &[f64], out: &mut [f64]) {
        interleaved::dot(&self.jacobian, &x[self.spanned[0]..], out);
    }

    /// Adds `Jᵀ F` of each crane.
    fn add_to(&self, generalized: &mut [f64], forces: &[f64]) {
        interleaved::add(forces, &self.jacobian, &mut generalized[self.spanned[0]..]);
    }
}

/// Whether a stiffness or a damping is less than half or more than twice what it was.
pub(super) fn differs(before: f64, now: f64) -> bool {
    (now - before).abs() > 0.5 * before.abs().max(now.abs())
}
