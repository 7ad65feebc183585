//! The contribution of forces with states of their own to the linear system of an implicit step, once those states are eliminated.
//!
//! With `U` the rows ∂ℓ/∂q of the forces, c the length of the implicit part of the step, g the rates of the states x and
//! `W = (I/c − ∂g/∂x)⁻¹`:
//!
//! ```text
//! κ = F_ℓ + F_x W g_ℓ,     δ = F_ℓ̇ + F_x W g_ℓ̇,     S = −(c δ + c² κ)
//! (M + Uᵀ S U) z = … + c² Uᵀ (δ U G + κ U (c G + P) + F_x W R/c)
//! ```
//!
//! with the right-hand side R of the states. Local forces, as those of bristles, act on single coordinates: their κ and δ are a stiffness
//! and a damping there. Others, as those of cylinders, span several coordinates or share states; by Woodbury's identity, each takes one solution with M.

use nalgebra::DMatrix;

use crate::{
    StateAt,
    dyn_crane::Functions,
    force_states::ForceStates,
    stateful_force::{ForceRow, STATES, StatefulForce},
};

/// The crane's forces that have states, evaluated at a state of the crane, and their contribution to the system there.
pub(crate) struct ForceStateUpdate {
    force_states: ForceStates,
    /// Whether bristles that stick have the steeper of their slopes on either side of rest.
    pub steeper_bristles: bool,
    rates: Vec<f64>,
    by_states: DMatrix<f64>,
    /// W of the coupled forces, as factors of its inverse, and of each local one.
    of_coupled: Factors,
    of_local: Vec<f64>,
    /// Of the coupled forces.
    kappa: DMatrix<f64>,
    delta: DMatrix<f64>,
    added_inertia: DMatrix<f64>,
    /// M⁻¹ Uᵀ, force by force.
    inverse_columns: Vec<Vec<f64>>,
    /// U M⁻¹ Uᵀ.
    inverse: DMatrix<f64>,
    /// I + S U M⁻¹ Uᵀ.
    correction: Factors,
    /// Workspace: one number per coordinate, one per state, one per coupled force, and `U g` and `U p` per coupled force.
    column: Vec<f64>,
    of_states: Vec<f64>,
    shares: Vec<f64>,
    along: Vec<[f64; 2]>,
}

impl ForceStateUpdate {
    /// Storage for the forces of a crane.
    pub fn new(crane: &dyn Functions) -> Self {
        let force_states = ForceStates::new(crane.description());
        let n = crane.description().coordinates.len();
        let ([coupled, of_coupled], len) = (force_states.coupled(), force_states.len());
        let square = |size| DMatrix::zeros(size, size);
        Self {
            rates: vec![0.0; len],
            by_states: square(len),
            of_coupled: Factors::new(of_coupled),
            of_local: vec![0.0; force_states.count() - coupled],
            kappa: square(coupled),
            delta: square(coupled),
            added_inertia: square(coupled),
            inverse_columns: vec![vec![0.0; n]; coupled],
            inverse: square(coupled),
            correction: Factors::new(coupled),
            column: vec![0.0; n],
            of_states: vec![0.0; len],
            shares: vec![0.0; coupled],
            along: vec![[0.0; 2]; coupled],
            steeper_bristles: false,
            force_states,
        }
    }

    /// Motions and commands change: what is kept of the last time does not hold any more.
    pub fn forget(&mut self) {
        self.force_states.forget();
    }

    /// Evaluates the forces at a state, and adds stiffness and damping of local forces to those of their coordinates.
    pub fn evaluate(&mut self, crane: &dyn Functions, moment: &StateAt<'_>, c: f64, joints: &mut [[f64; 2]]) {
        if self.force_states.is_empty() {
            return;
        }
        self.force_states.evaluate(crane, moment, &mut self.rates, Some(&mut self.by_states));
        if self.steeper_bristles {
            self.force_states.steepen(moment, c);
        }
        for (inverse, (force, row)) in self.of_local.iter_mut().zip(local(&self.force_states)) {
            *inverse = 1.0 / (1.0 / c - self.by_states[(force.first, force.first)]);
            let pull = force.by_states[0] * *inverse;
            let stiffness = -(force.by_length + pull * force.rates_by_length[0]);
            let damping = -(force.by_speed + pull * force.rates_by_speed[0]);
            // Where friction falls with the rate, an inexact derivative keeps the system positive definite.
            if damping + stiffness * c > 0.0 {
                joints[row.first][0] += stiffness;
                joints[row.first][1] += damping;
            }
        }
    }

    /// Prepares solutions with coupled forces at the state evaluated; `solve` solves the system without them.
    pub fn factorise(&mut self, c: f64, solve: &mut dyn FnMut(&[f64], &mut [f64])) {
        let Self { force_states, by_states, of_coupled, kappa, delta, added_inertia, inverse, inverse_columns, .. } =
            self;
        let [coupled, states] = force_states.coupled();
        if coupled == 0 {
            return;
        }
        of_coupled.factorise(|row, column| f64::from(row == column) / c - by_states[(row, column)]);
        let forces = &force_states.forces()[..coupled];
        // What only states change that no force feels, as those of feet in the air and of feet that stick, has neither stiffness nor damping.
        let is_felt = |force: &StatefulForce| {
            let feels = |other: &StatefulForce| other.first == force.first && other.by_states != [0.0; STATES];
            !force.is_of_foot || forces.iter().any(feels)
        };
        for (column, force) in forces.iter().enumerate() {
            if !is_felt(force) {
                kappa.column_mut(column).fill(0.0);
                delta.column_mut(column).fill(0.0);
                kappa[(column, column)] = force.by_length;
                delta[(column, column)] = force.by_speed;
                continue;
            }
            for (matrix, rates) in [(&mut *kappa, force.rates_by_length), (&mut *delta, force.rates_by_speed)] {
                let of_states = &mut self.of_states[..states];
                of_states.fill(0.0);
                of_states[force.first..force.first + force.count].copy_from_slice(&rates[..force.count]);
                of_coupled.solve(of_states);
                for (row, other) in forces.iter().enumerate() {
                    matrix[(row, column)] = other.pull(of_states);
                }
            }
            kappa[(column, column)] += force.by_length;
            delta[(column, column)] += force.by_speed;
        }
        for ((added_inertia, delta), kappa) in added_inertia.iter_mut().zip(delta.iter()).zip(kappa.iter()) {
            *added_inertia = -(delta * c + kappa * (c * c));
        }
        let rows = &force_states.rows()[..coupled];
        for (column, (row, inverse_column)) in rows.iter().zip(inverse_columns).enumerate() {
            // S has nothing of a foot that sticks.
            if (0..coupled).all(|other| added_inertia[(other, column)] == 0.0 && added_inertia[(column, other)] == 0.0)
            {
                inverse_column.fill(0.0);
                (0..coupled).for_each(|row| inverse[(row, column)] = 0.0);
                continue;
            }
            self.column.fill(0.0);
            row.add_to(&mut self.column, 1.0);
            solve(&self.column, inverse_column);
            for (row, other) in rows.iter().enumerate() {
                inverse[(row, column)] = other.along(inverse_column);
            }
        }
        self.correction.factorise(|row, column| {
            let share = |place: usize| added_inertia[(row, place)] * inverse[(place, column)];
            f64::from(row == column) + (0..coupled).map(share).sum::<f64>()
        });
    }

    /// Adds `−δ U G − κ U (c G + P)` of the coupled forces and `−F_x W R/c` of all forces; for local ones the first two are among those of the
    /// joints.
    pub fn add_to(&mut self, (g, p): (&[f64], &[f64]), r: &[f64], c: f64, right: &mut [f64]) {
        let [coupled, states] = self.force_states.coupled();
        let (forces, rows) = (&self.force_states.forces()[..coupled], &self.force_states.rows()[..coupled]);
        self.of_states.copy_from_slice(r);
        self.of_coupled.solve(&mut self.of_states[..states]);
        for (along, row) in self.along.iter_mut().zip(rows) {
            *along = [row.along(g), row.along(p)];
        }
        for (row, (force, own)) in forces.iter().zip(rows).enumerate() {
            let of_force = |(column, [g, p]): (usize, &[f64; 2])| {
                self.delta[(row, column)] * g + self.kappa[(row, column)] * (g * c + p)
            };
            let sum = self.along.iter().enumerate().map(of_force).sum::<f64>() + force.pull(&self.of_states) / c;
            own.add_to(right, -sum);
        }
        for (inverse, (force, row)) in self.of_local.iter().zip(local(&self.force_states)) {
            right[row.first] -= force.by_states[0] * inverse * r[force.first] / c;
        }
    }

    /// Turns the solution of the system without coupled forces into that of the system with them.
    pub fn correct(&mut self, solution: &mut [f64]) {
        for ([along, _], row) in self.along.iter_mut().zip(self.force_states.rows()) {
            *along = row.along(solution);
        }
        for (row, share) in self.shares.iter_mut().enumerate() {
            let of_force = |(column, [along, _]): (usize, &[f64; 2])| self.added_inertia[(row, column)] * along;
            *share = self.along.iter().enumerate().map(of_force).sum();
        }
        self.correction.solve(&mut self.shares);
        for (inverse_column, share) in self.inverse_columns.iter().zip(&self.shares) {
            for (x, entry) in solution.iter_mut().zip(inverse_column) {
                *x -= share * entry;
            }
        }
    }

    /// The transpose of [`correct`](Self::correct), in place.
    pub fn pull_back_correction(&mut self, weights: &mut [f64]) {
        for (share, inverse_column) in self.shares.iter_mut().zip(&self.inverse_columns) {
            *share = inverse_column.iter().zip(&*weights).map(|(entry, weight)| entry * weight).sum();
        }
        self.correction.solve_transposed(&mut self.shares);
        for (column, row) in self.force_states.rows().iter().enumerate().take(self.shares.len()) {
            let share: f64 =
                self.shares.iter().enumerate().map(|(of, share)| self.added_inertia[(of, column)] * share).sum();
            row.add_to(weights, -share);
        }
    }

    /// The transpose of [`add_to`](Self::add_to): adds the weights of G, P and R, given those of what it adds to.
    pub fn pull_back_right(&mut self, weights: &[f64], c: f64, (g, p): (&mut [f64], &mut [f64]), r: &mut [f64]) {
        let [coupled, states] = self.force_states.coupled();
        let (forces, rows) = (&self.force_states.forces()[..coupled], &self.force_states.rows()[..coupled]);
        for (share, row) in self.shares.iter_mut().zip(rows) {
            *share = -row.along(weights);
        }
        self.of_states.fill(0.0);
        for (column, (force, row)) in forces.iter().zip(rows).enumerate() {
            let share = self.shares[column];
            let pulls = self.of_states[force.first..].iter_mut().zip(&force.by_states).take(force.count);
            pulls.for_each(|(sum, slope)| *sum += slope * share / c);
            let [mut of_g, mut of_p] = [0.0; 2];
            for (of, share) in self.shares.iter().enumerate() {
                of_g += (self.delta[(of, column)] + self.kappa[(of, column)] * c) * share;
                of_p += self.kappa[(of, column)] * share;
            }
            row.add_to(g, of_g);
            row.add_to(p, of_p);
        }
        self.of_coupled.solve_transposed(&mut self.of_states[..states]);
        r.iter_mut().zip(&self.of_states).take(states).for_each(|(sum, weight)| *sum += weight);
        for (inverse, (force, row)) in self.of_local.iter().zip(local(&self.force_states)) {
            r[force.first] -= force.by_states[0] * inverse * weights[row.first] / c;
        }
    }

    /// The transpose of [`states`](Self::states): the weights of R, given those of the increments of the states; adds those of the increments
    /// of pose and rates.
    pub fn pull_back_states(&self, weights: &[f64], (p, w): (&mut [f64], &mut [f64]), r: &mut [f64]) {
        r.copy_from_slice(weights);
        let (of_coupled, of_local) = r.split_at_mut(self.force_states.coupled()[1]);
        self.of_coupled.solve_transposed(of_coupled);
        of_local.iter_mut().zip(&self.of_local).for_each(|(weight, inverse)| *weight *= inverse);
        for (force, row) in self.force_states.forces().iter().zip(self.force_states.rows()) {
            let part = &r[force.first..force.first + force.count];
            let sum = |slopes: &[f64]| slopes.iter().zip(part).map(|(slope, weight)| slope * weight).sum();
            row.add_to(p, sum(&force.rates_by_length));
            row.add_to(w, sum(&force.rates_by_speed));
        }
    }

    /// The increments of the states, `W (R + g_ℓ U p + g_ℓ̇ U w)`, given those of pose and rates.
    pub fn states(&self, (p, w): (&[f64], &[f64]), r: &[f64], out: &mut [f64]) {
        out.copy_from_slice(r);
        for (force, row) in self.force_states.forces().iter().zip(self.force_states.rows()) {
            let part = &mut out[force.first..force.first + force.count];
            let (p, w) = (row.along(p), row.along(w));
            for (i, x) in part.iter_mut().enumerate() {
                *x += force.rates_by_length[i] * p + force.rates_by_speed[i] * w;
            }
        }
        let (of_coupled, of_local) = out.split_at_mut(self.force_states.coupled()[1]);
        self.of_coupled.solve(of_coupled);
        for (x, inverse) in of_local.iter_mut().zip(&self.of_local) {
            *x *= inverse;
        }
    }
}

/// Local forces, which have one state each, and their rows.
fn local(force_states: &ForceStates) -> impl Iterator<Item = (&StatefulForce, &ForceRow)> {
    let [coupled, _] = force_states.coupled();
    force_states.forces().iter().zip(force_states.rows()).skip(coupled)
}

/// LU factors of a matrix, with row exchanges, in storage that is reused: nalgebra allocates its factors for each matrix.
struct Factors {
    matrix: DMatrix<f64>,
    /// The row with which each row was exchanged.
    exchanged: Vec<usize>,
}

impl Factors {
    fn new(size: usize) -> Self {
        Self { matrix: DMatrix::identity(size, size), exchanged: (0..size).collect() }
    }

    /// Gaussian elimination of the matrix with these entries, with the largest entry of each column as pivot.
    fn factorise(&mut self, entry: impl Fn(usize, usize) -> f64) {
        let Self { matrix, exchanged } = self;
        let size = exchanged.len();
        for column in 0..size {
            for row in 0..size {
                matrix[(row, column)] = entry(row, column);
            }
        }
        for k in 0..size {
            let pivot = (k..size).max_by(|&a, &b| matrix[(a, k)].abs().total_cmp(&matrix[(b, k)].abs())).unwrap_or(k);
            exchanged[k] = pivot;
            matrix.swap_rows(k, pivot);
            for row in k + 1..size {
                let factor = matrix[(row, k)] / matrix[(k, k)];
                matrix[(row, k)] = factor;
                for column in k + 1..size {
                    matrix[(row, column)] -= factor * matrix[(k, column)];
                }
            }
        }
    }

    /// The solution in place of the right-hand side; not finite if the matrix is singular.
    fn solve(&self, x: &mut [f64]) {
        let Self { matrix, exchanged } = self;
        for (row, &other) in exchanged.iter().enumerate() {
            x.swap(row, other);
        }
        let size = x.len();
        for column in 0..size {
            let known = x[column];
            for (x, entry) in x[column + 1..].iter_mut().zip(&matrix.as_slice()[column * (size + 1) + 1..]) {
                *x -= entry * known;
            }
        }
        for column in (0..size).rev() {
            let known = x[column] / matrix[(column, column)];
            x[column] = known;
            for (x, entry) in x[..column].iter_mut().zip(&matrix.as_slice()[column * size..]) {
                *x -= entry * known;
            }
        }
    }

    /// The solution with the transposed matrix, in place of the right-hand side.
    fn solve_transposed(&self, x: &mut [f64]) {
        let Self { matrix, exchanged } = self;
        let size = x.len();
        for row in 0..size {
            let known: f64 = (0..row).map(|k| matrix[(k, row)] * x[k]).sum();
            x[row] = (x[row] - known) / matrix[(row, row)];
        }
        for row in (0..size).rev() {
            let known: f64 = (row + 1..size).map(|k| matrix[(k, row)] * x[k]).sum();
            x[row] -= known;
        }
        for (row, &other) in exchanged.iter().enumerate().rev() {
            x.swap(row, other);
        }
    }
}

impl StatefulForce {
    /// `F_x x`
    fn pull(&self, x: &[f64]) -> f64 {
        let states = &x[self.first..self.first + self.count];
        self.by_states.iter().zip(states).map(|(slope, x)| slope * x).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_solve_systems_that_need_exchanges_of_rows() {
        let matrix =
            DMatrix::from_row_slice(4, 4, &[0., 2., 1., 3., 4., -1., 0., 2., 1., 5., -2., 0., 3., 3., 3., -7.]);
        let expected = [1.0, -2.0, 0.5, 4.0];
        let mut factors = Factors::new(4);
        // The storage of the first matrix is reused for the second.
        for scale in [7.0, 1.0] {
            factors.factorise(|row, column| scale * matrix[(row, column)]);
            let mut x: Vec<f64> =
                (0..4).map(|row| scale * (matrix.row(row) * DMatrix::from_column_slice(4, 1, &expected))[0]).collect();
            factors.solve(&mut x);
            // A few rounding errors of numbers below 10.
            assert!(x.iter().zip(expected).all(|(x, expected)| (x - expected).abs() < 1e-14), "{x:?}");
            let mut x: Vec<f64> = (0..4)
                .map(|column| scale * matrix.column(column).dot(&DMatrix::from_column_slice(4, 1, &expected).column(0)))
                .collect();
            factors.solve_transposed(&mut x);
            assert!(x.iter().zip(expected).all(|(x, expected)| (x - expected).abs() < 1e-14), "{x:?}");
        }
        Factors::new(0).solve(&mut []);
        Factors::new(0).solve_transposed(&mut []);
    }
}
