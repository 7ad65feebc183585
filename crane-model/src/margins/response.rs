//! The response of an output to what a loop acts on, from the Hessenberg form of the state matrix: O(n²) for a frequency.

use nalgebra::{Complex, DMatrix, DVector, Hessenberg, linalg::balancing};

use crate::modes::{NoModes, eigenvalues};

/// What follows the input with a power of s: a column of B and an entry of D.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Power of s.
    pub power: i32,
    /// Column of B.
    pub b: DVector<f64>,
    /// Entry of D.
    pub d: f64,
}

/// `G(s) = Σ s^k (c (s − A)⁻¹ b_k + d_k)`.
#[derive(Clone, Debug)]
pub struct Plant {
    /// Hessenberg form of A, balanced, row by row.
    hessenberg: Vec<f64>,
    pub(super) c: Vec<f64>,
    pub(super) terms: Vec<Term>,
    poles: Vec<Complex<f64>>,
}

impl Plant {
    /// From a state matrix, what follows the input, and a row of C.
    ///
    /// # Errors
    /// Numbers are not finite, or the eigenvalues of A are not found.
    pub fn new(a: &DMatrix<f64>, mut terms: Vec<Term>, c: &DVector<f64>) -> Result<Self, NoModes> {
        let poles = eigenvalues(a.clone())?;
        let n = a.nrows();
        if n < 2 {
            let hessenberg = a.as_slice().to_vec();
            return Ok(Self { hessenberg, c: c.as_slice().to_vec(), terms, poles });
        }
        let mut balanced = a.clone();
        let scales = balancing::balance_parlett_reinsch(&mut balanced);
        let (basis, hessenberg) = Hessenberg::new(balanced).unpack();
        for term in &mut terms {
            term.b = basis.tr_mul(&term.b.component_div(&scales));
        }
        let c = basis.tr_mul(&c.component_mul(&scales));
        Ok(Self { hessenberg: hessenberg.transpose().as_slice().to_vec(), c: c.as_slice().to_vec(), terms, poles })
    }

    /// The poles with Im λ ≥ 0, 1/s.
    pub fn poles(&self) -> &[Complex<f64>] {
        &self.poles
    }

    /// The state matrix in the basis of b and c.
    pub(super) fn matrix(&self) -> DMatrix<f64> {
        DMatrix::from_row_slice(self.c.len(), self.c.len(), &self.hessenberg)
    }

    /// Whether an input follows with a negative power of s.
    pub(super) fn integrals(&self) -> bool {
        self.terms.iter().any(|term| term.power < 0)
    }

    /// G(s).
    pub fn response(&self, s: Complex<f64>) -> Complex<f64> {
        let (right, through) = self.input(|power| s.powi(power));
        self.output(&self.solve(s, right)) + through
    }

    /// G(s) and its derivative.
    pub(super) fn response_and_slope(&self, s: Complex<f64>) -> [Complex<f64>; 2] {
        let (right, through) = self.input(|power| s.powi(power));
        let (mut right_by_s, through_by_s) = self.input(|power| s.powi(power - 1) * f64::from(power));
        let states = self.solve(s, right);
        right_by_s.iter_mut().zip(&states).for_each(|(right, state)| *right -= state);
        [self.output(&states) + through, self.output(&self.solve(s, right_by_s)) + through_by_s]
    }

    /// `Σ f_k b_k` and `Σ f_k d_k` with factors of the powers of s.
    fn input(&self, factor: impl Fn(i32) -> Complex<f64>) -> (Vec<Complex<f64>>, Complex<f64>) {
        let (mut right, mut through) = (vec![Complex::from(0.0); self.c.len()], Complex::from(0.0));
        for Term { power, b, d } in &self.terms {
            let factor = factor(*power);
            through += factor * *d;
            right.iter_mut().zip(b).for_each(|(right, b)| *right += factor * *b);
        }
        (right, through)
    }

    /// `(s − A)⁻¹ right`.
    fn solve(&self, s: Complex<f64>, mut right: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
        let n = self.c.len();
        let mut matrix: Vec<Complex<f64>> = self.hessenberg.iter().map(|entry| Complex::from(-entry)).collect();
        for j in 0..n {
            matrix[j * n + j] += s;
        }
        solve_hessenberg(&mut matrix, &mut right, n);
        right
    }

    fn output(&self, states: &[Complex<f64>]) -> Complex<f64> {
        states.iter().zip(&self.c).map(|(x, c)| x * *c).sum()
    }
}

/// Replaces the right-hand side by the solution, by Gaussian elimination with exchanges of neighbouring rows; the matrix is overwritten.
fn solve_hessenberg(matrix: &mut [Complex<f64>], right: &mut [Complex<f64>], n: usize) {
    for k in 1..n {
        let (above, below) = matrix.split_at_mut(k * n);
        let (pivot, row) = (&mut above[(k - 1) * n + k - 1..], &mut below[k - 1..n]);
        if row[0].norm_sqr() > pivot[0].norm_sqr() {
            pivot[..row.len()].swap_with_slice(row);
            right.swap(k - 1, k);
        }
        if row[0] == Complex::from(0.0) {
            continue;
        }
        let factor = row[0] / pivot[0];
        for (entry, pivot) in row[1..].iter_mut().zip(&pivot[1..]) {
            *entry -= factor * pivot;
        }
        let known = right[k - 1];
        right[k] -= factor * known;
    }
    for k in (0..n).rev() {
        let mut sum = right[k];
        for j in k + 1..n {
            sum -= matrix[k * n + j] * right[j];
        }
        right[k] = sum / matrix[k * n + k];
    }
}
