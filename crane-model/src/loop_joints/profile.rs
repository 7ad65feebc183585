//! Symmetric matrices of equations that couple only with near ones.
//!
//! A row of the lower triangle is stored from its first entry that may not be zero. So are those of the Cholesky factor: it has no entries before
//! them. r rows of width w take r w² operations, and the full triangle r³/3.

/// Which entries of a lower triangle are stored, row by row.
pub(super) struct Profile {
    /// The first column of each row, and the place of the entry that the row would have in column 0.
    rows: Vec<[usize; 2]>,
    len: usize,
}

impl Profile {
    /// Without rows so far, and without allocation up to so many.
    pub fn new(rows: usize) -> Self {
        Self { rows: Vec::with_capacity(rows), len: 0 }
    }

    /// Removes all rows.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.len = 0;
    }

    /// Adds a row with entries from a column to the diagonal.
    pub fn add(&mut self, first: usize) {
        // Every row before has an entry.
        self.rows.push([first, self.len - first]);
        self.len += self.rows.len() - first;
    }

    /// Number of entries.
    pub const fn len(&self) -> usize {
        self.len
    }

    /// The first column of a row.
    pub fn first(&self, row: usize) -> usize {
        self.rows[row][0]
    }

    /// Where an entry is stored.
    pub fn place(&self, row: usize, column: usize) -> usize {
        self.rows[row][1] + column
    }

    /// Replaces a matrix by its Cholesky factor; not finite unless the matrix is positive definite.
    pub fn factorise(&self, matrix: &mut [f64]) {
        for (i, &[first, own]) in self.rows.iter().enumerate() {
            for (j, &[other_first, other]) in self.rows[..i].iter().enumerate().skip(first) {
                let from = first.max(other_first);
                let sum = dot(&matrix[own + from..own + j], &matrix[other + from..other + j]);
                matrix[own + j] = (matrix[own + j] - sum) / matrix[other + j];
            }
            let row = &matrix[own + first..own + i];
            matrix[own + i] = (matrix[own + i] - dot(row, row)).sqrt();
        }
    }

    /// The solution in place of the right-hand side, from a Cholesky factor.
    pub fn solve(&self, factor: &[f64], x: &mut [f64]) {
        for (i, &[first, own]) in self.rows.iter().enumerate() {
            x[i] = (x[i] - dot(&factor[own + first..own + i], &x[first..i])) / factor[own + i];
        }
        for (i, &[first, own]) in self.rows.iter().enumerate().rev() {
            x[i] /= factor[own + i];
            let (before, known) = x.split_at_mut(i);
            for (x, entry) in before[first..].iter_mut().zip(&factor[own + first..]) {
                *x -= entry * known[0];
            }
        }
    }
}

/// `a · b` in four sums, which the processor adds at a time.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((fours, rest), (other_fours, others)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in fours.iter().zip(other_fours) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let rest: f64 = rest.iter().zip(others).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    /// Against the dense factors of nalgebra, with rows that begin anywhere, also at their diagonal.
    #[test]
    fn solutions_are_those_of_the_full_matrix() {
        const FIRSTS: [usize; 12] = [0, 0, 2, 1, 4, 4, 2, 6, 8, 3, 9, 0];
        let size = FIRSTS.len();
        let mut full = DMatrix::identity(size, size) * 4.0;
        let mut profile = Profile::new(size);
        let mut matrix = Vec::new();
        for (i, &first) in FIRSTS.iter().enumerate() {
            profile.add(first);
            for j in first..i {
                let entry = ((7 * i + 3 * j) as f64).sin();
                (full[(i, j)], full[(j, i)]) = (entry, entry);
            }
            matrix.extend((first..=i).map(|j| full[(i, j)]));
        }
        assert_eq!(profile.len(), matrix.len());
        let right = DVector::from_fn(size, |i, _| (i as f64).cos());
        let mut found = right.as_slice().to_vec();
        profile.factorise(&mut matrix);
        profile.solve(&matrix, &mut found);
        let expected = full.cholesky().expect("a positive definite matrix").solve(&right);
        // The condition of the matrix, some 10, times rounding.
        assert!((DVector::from_vec(found) - expected).amax() < 1e-14);
    }
}
