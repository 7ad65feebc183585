//! The equations of the loop joints of one crane, of those of a fleet.

use super::independence::Independence;

/// The loops of a crane.
pub(super) struct OfCrane {
    /// Its index.
    pub crane: usize,
    /// Which equations are independent.
    pub independence: Independence,
    /// The place of each of them among the rows of all cranes.
    places: Vec<usize>,
    /// S of the independent equations, then its Cholesky factor, row by row.
    schur: Vec<f64>,
    /// Numbers of the independent equations.
    shares: Vec<f64>,
}

impl OfCrane {
    /// Of the crane with an index, whose equations transmit moments or not, joint by joint.
    pub fn new(crane: usize, groups: Vec<Vec<bool>>) -> Self {
        let independence = Independence::new(groups);
        let count = independence.len();
        let places = Vec::with_capacity(count);
        Self { crane, independence, places, schur: vec![0.0; count * count], shares: vec![0.0; count] }
    }

    /// Adds the rows of its independent equations to those of other cranes, and notes their places.
    pub fn order(&mut self, rows: &mut Vec<usize>) {
        self.places.clear();
        for row in self.independence.kept() {
            let place = rows.iter().position(|other| other == row).unwrap_or(rows.len());
            if place == rows.len() {
                rows.push(*row);
            }
            self.places.push(place);
        }
    }

    /// Factorises S, given the products `J M⁻¹ Jᵀ` of two places of which the first is not before the second.
    pub fn factorise(&mut self, product: impl Fn(usize, usize) -> f64) {
        let Self { places, schur, .. } = self;
        let size = places.len();
        for (i, &one) in places.iter().enumerate() {
            for (j, &other) in places[..=i].iter().enumerate() {
                schur[i * size + j] = product(one.max(other), one.min(other));
            }
        }
        cholesky(&mut schur[..size * size], size);
    }

    /// `−S⁻¹` times its numbers among those of all cranes, in place; 0 for its dependent equations among some rows.
    pub fn solve(&mut self, rows: &[usize], cranes: usize, all: &mut [f64]) {
        let Self { crane, independence, schur, shares, .. } = self;
        let (kept, size) = (independence.kept(), independence.kept().len());
        let place = |row: &usize| row * cranes + *crane;
        shares.iter_mut().zip(kept).for_each(|(share, row)| *share = all[place(row)]);
        solve_cholesky(&schur[..size * size], size, &mut shares[..size]);
        for row in rows {
            all[place(row)] = 0.0;
        }
        shares.iter().zip(kept).for_each(|(share, row)| all[place(row)] = -share);
    }
}

/// Replaces the lower triangle of a symmetric matrix by its Cholesky factor; not finite unless the matrix is positive definite.
fn cholesky(matrix: &mut [f64], size: usize) {
    for i in 0..size {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| matrix[i * size + k] * matrix[j * size + k]).sum();
            let rest = matrix[i * size + j] - sum;
            matrix[i * size + j] = if i == j { rest.sqrt() } else { rest / matrix[j * size + j] };
        }
    }
}

/// The solution in place of the right-hand side, from a Cholesky factor.
fn solve_cholesky(factor: &[f64], size: usize, x: &mut [f64]) {
    for i in 0..size {
        let known: f64 = (0..i).map(|k| factor[i * size + k] * x[k]).sum();
        x[i] = (x[i] - known) / factor[i * size + i];
    }
    for i in (0..size).rev() {
        let known: f64 = (i + 1..size).map(|k| factor[k * size + i] * x[k]).sum();
        x[i] = (x[i] - known) / factor[i * size + i];
    }
}
