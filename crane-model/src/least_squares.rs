//! Linear equations whose matrix may lack rank: `A P = Q R` with exchange of columns shows the rank, and gives the solution of least length.
//!
//! The singular value decomposition of nalgebra would give both, but is in error by 2e-5 of the largest singular value for the matrix of the
//! tests below.

use nalgebra::{DMatrix, DVector};

/// `A x = b` in the sense of least squares.
pub(crate) struct LeastSquares {
    /// Orthonormal columns that span those of A.
    basis: DMatrix<f64>,
    /// R, upper triangular, diagonal falling.
    triangle: DMatrix<f64>,
    /// The column of A in each column of R.
    order: Vec<usize>,
    /// How many diagonal elements of R are not zero.
    rank: usize,
}

impl LeastSquares {
    /// Factors of a matrix of finite numbers, in whose triangle smaller diagonal elements than `smallest` are zero.
    pub fn new(matrix: DMatrix<f64>, smallest: f64) -> Self {
        // With rows of zeros, a matrix is never wide: R is then square.
        let rows = matrix.nrows().max(matrix.ncols());
        let (basis, triangle, exchanges) = matrix.resize_vertically(rows, 0.0).col_piv_qr().unpack();
        let mut order = DMatrix::from_fn(1, triangle.ncols(), |_, column| column);
        exchanges.permute_columns(&mut order);
        let rank = triangle.diagonal().iter().take_while(|entry| entry.abs() > smallest).count();
        Self { basis, triangle, order: order.iter().copied().collect(), rank }
    }

    /// Whether the columns of A are independent: then only one x solves the equations.
    pub fn is_unique(&self) -> bool {
        self.rank == self.order.len()
    }

    /// The shortest x with the least squares of `A x − b`. From `R = [R₁; 0]` and `R₁ᵀ = Q₂ R₂` follows `P x = Q₂ R₂⁻ᵀ Qᵀ b`.
    pub fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        let projected = self.basis.view((0, 0), (right.len(), self.rank)).tr_mul(right);
        let (across, inner) = self.triangle.rows(0, self.rank).transpose().qr().unpack();
        let shares = inner.transpose().solve_lower_triangular(&projected)?;
        Some(self.reordered(&(across * shares)))
    }

    /// A direction x with `A x = 0`, if the columns of A depend on each other.
    pub fn null_direction(&self) -> Option<DVector<f64>> {
        if self.is_unique() {
            return None;
        }
        let independent = self.triangle.view((0, 0), (self.rank, self.rank));
        let shares = independent.solve_upper_triangular(&self.triangle.view((0, self.rank), (self.rank, 1)))?;
        let mut direction = DVector::zeros(self.order.len());
        direction.rows_mut(0, self.rank).copy_from(&-shares);
        direction[self.rank] = 1.0;
        Some(self.reordered(&direction))
    }

    /// Numbers of the columns of R as those of A.
    fn reordered(&self, numbers: &DVector<f64>) -> DVector<f64> {
        let mut found = DVector::zeros(self.order.len());
        for (&column, number) in self.order.iter().zip(numbers.iter()) {
            found[column] = *number;
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A load, a rod and a cylinder on three bodies of a crane: columns of very different lengths, which nalgebra's singular value
    /// decomposition puts together with an error of 4e-2.
    fn forces_on_three_bodies() -> DMatrix<f64> {
        let load = [403.9, 244.7, -7.471, -826.412_244_637_374, 1_345.323_615_882_514_8, -614.003_052_146_166_6];
        let rod = [
            -0.059_988_964_126_324_79,
            0.297_022_655_474_466_7,
            0.952_984_189_962_219_1,
            0.326_868_590_575_050_7,
            -0.269_598_263_011_278_9,
            0.104_603_340_640_058_62,
        ];
        let cylinder = [
            0.111_220_404_627_901_82,
            -0.570_211_850_270_489_4,
            -0.813_933_945_357_675_2,
            0.718_492_599_520_710_1,
            0.126_078_082_505_038_4,
            0.009_853_159_439_822_574,
        ];
        let mut columns = DMatrix::zeros(96, 3);
        for i in 0..6 {
            columns[(18 + i, 0)] = load[i];
            (columns[(90 + i, 1)], columns[(18 + i, 1)]) = (rod[i], -rod[i]);
            (columns[(6 + i, 2)], columns[(18 + i, 2)]) = (cylinder[i], -cylinder[i]);
        }
        columns
    }

    #[test]
    fn factors_are_found_again() {
        let columns = forces_on_three_bodies();
        let factors = DVector::from_vec(vec![0.4, 232.6, 53_276.0]);
        let solver = LeastSquares::new(columns.clone(), 1e-9);
        assert!(solver.is_unique() && solver.null_direction().is_none());
        let found = solver.solve(&(columns * &factors)).expect("a solution");
        // The condition of the matrix, 1e3, times rounding of the largest sum, 5e4.
        assert!((found - factors).amax() < 1e-9);
    }

    #[test]
    fn the_shortest_solution_of_dependent_columns() {
        // The third column is the sum of the others: x + s (1, 1, −1) are all solutions of A x = A (1, 2, 3), and s = 0 is not the shortest.
        let columns = DMatrix::from_row_slice(4, 3, &[1.0, 0.0, 1.0, 2.0, 1.0, 3.0, 0.0, 1.0, 1.0, 1.0, -1.0, 0.0]);
        let solver = LeastSquares::new(columns.clone(), 1e-9);
        assert!(!solver.is_unique());
        let free = solver.null_direction().expect("a direction");
        assert!((&columns * &free).amax() < 1e-14 && (free[0] - free[1]).abs() < 1e-14 && free[0] != 0.0);
        let right = &columns * DVector::from_vec(vec![1.0, 2.0, 3.0]) + DVector::from_vec(vec![0.1, -0.2, 0.3, 0.0]);
        let found = solver.solve(&right).expect("a solution");
        assert!((columns.transpose() * (&columns * &found - right)).amax() < 1e-13, "least squares");
        assert!(found.dot(&free).abs() < 1e-14, "the shortest");
    }

    #[test]
    fn fewer_equations_than_unknowns() {
        let solver = LeastSquares::new(DMatrix::from_row_slice(1, 2, &[3.0, 4.0]), 1e-9);
        let found = solver.solve(&DVector::from_vec(vec![25.0])).expect("a solution");
        assert!((found - DVector::from_vec(vec![3.0, 4.0])).amax() < 1e-14);
    }
}
