//! Eigenvalues and eigenvectors of a real matrix from its Schur form, by back substitution [Golub and Van Loan 2013, Sec. 7.6.4].

use nalgebra::{Complex, DMatrix, DVector};

/// A vector with larger entries than this is scaled down, so that none overflows.
const LARGE: f64 = 1e100;

/// Differences of entries of T below this are rounding.
pub fn rounding(t: &DMatrix<f64>) -> f64 {
    f64::EPSILON * t.amax()
}

/// A block on the diagonal of a quasi-triangular matrix: one real eigenvalue, or a conjugate pair.
#[derive(Clone, Copy)]
pub enum Block {
    /// At this index.
    Real(usize),
    /// At this index and the next.
    Pair(usize),
}

impl Block {
    /// The blocks of a quasi-triangular matrix.
    pub fn all(t: &DMatrix<f64>) -> Vec<Self> {
        let mut blocks = Vec::new();
        let mut row = 0;
        while row < t.nrows() {
            let pair = row + 1 < t.nrows() && t[(row + 1, row)] != 0.0;
            blocks.push(if pair { Block::Pair(row) } else { Block::Real(row) });
            row += if pair { 2 } else { 1 };
        }
        blocks
    }

    /// Its eigenvalue with Im λ ≥ 0.
    pub fn eigenvalue(self, t: &DMatrix<f64>) -> Complex<f64> {
        match self {
            Block::Real(i) => t[(i, i)].into(),
            Block::Pair(i) => {
                let half = 0.5 * (t[(i, i)] - t[(i + 1, i + 1)]);
                let discriminant = t[(i, i + 1)] * t[(i + 1, i)] + half * half;
                Complex::new(0.5 * (t[(i, i)] + t[(i + 1, i + 1)]), (-discriminant).max(0.0).sqrt())
            }
        }
    }

    /// Its eigenvector in the basis of the Schur form: `(T − λ) y = 0`, up to the end of the block, beyond which y is 0. Where eigenvalues
    /// coincide, their difference is replaced by `least`, the size of [`rounding`] errors.
    pub fn eigenvector(self, t: &DMatrix<f64>, blocks: &[Block], least: f64) -> DVector<Complex<f64>> {
        let lambda = self.eigenvalue(t);
        let apart = |difference: Complex<f64>| if difference.norm() < least { least.into() } else { difference };
        let (start, size) = match self {
            Block::Real(i) => (i, 1),
            Block::Pair(i) => (i, 2),
        };
        // `right` is −Σ T y over the known entries of y; solved rows contain y itself.
        let mut right: DVector<Complex<f64>> = DVector::zeros(start + size);
        let known = |right: &mut DVector<Complex<f64>>, column: usize, above: usize, y: Complex<f64>| {
            for row in 0..above {
                right[row] -= y * t[(row, column)];
            }
            right[column] = y;
        };
        known(&mut right, start + size - 1, start, Complex::from(1.0));
        if let Block::Pair(i) = self {
            known(&mut right, i, i, -Complex::from(t[(i, i + 1)]) / apart(t[(i, i)] - lambda));
        }
        let before = blocks.iter().rev().skip_while(|block| block.first_row() >= start);
        for block in before {
            match *block {
                Block::Real(i) => {
                    let y = right[i] / apart(t[(i, i)] - lambda);
                    known(&mut right, i, i, y);
                }
                Block::Pair(i) => {
                    let (a, d) = (t[(i, i)] - lambda, t[(i + 1, i + 1)] - lambda);
                    let (b, c) = (t[(i, i + 1)], t[(i + 1, i)]);
                    let determinant = a * d - b * c;
                    let smallest = least * (a.norm() + d.norm() + b.abs() + c.abs());
                    let determinant = if determinant.norm() < smallest { smallest.into() } else { determinant };
                    let (first, second) = (right[i], right[i + 1]);
                    known(&mut right, i + 1, i, (second * a - first * c) / determinant);
                    known(&mut right, i, i, (first * d - second * b) / determinant);
                }
            }
            if right.camax() > LARGE {
                right.unscale_mut(LARGE);
            }
        }
        right
    }

    fn first_row(self) -> usize {
        match self {
            Block::Real(i) | Block::Pair(i) => i,
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Schur;

    use super::*;

    /// A matrix of random entries: some eigenvalues are real, some in pairs.
    fn random(n: usize) -> DMatrix<f64> {
        let mut seed = 1_u32;
        DMatrix::from_fn(n, n, |_, _| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 23) - 1.0
        })
    }

    #[test]
    fn eigenvectors_of_random_matrices_satisfy_their_equation() {
        for n in [1, 2, 3, 8, 25] {
            let matrix = random(n);
            let (vectors, t) = Schur::new(matrix.clone()).unpack();
            let blocks = Block::all(&t);
            assert!(n < 8 || blocks.iter().any(|block| matches!(block, Block::Real(_))), "some are real");
            for block in &blocks {
                let lambda = block.eigenvalue(&t);
                let y = block.eigenvector(&t, &blocks, rounding(&t));
                let complex = |matrix: &DMatrix<f64>| matrix.map(Complex::from);
                let x = complex(&vectors).columns(0, y.len()) * &y;
                let off = complex(&matrix) * &x - &x * lambda;
                // The Schur form is that of a matrix perturbed by a few rounding errors per row.
                assert!(off.camax() < 1e-13 * n as f64 * x.camax(), "{n}: {lambda}: {:e}", off.camax() / x.camax());
            }
        }
    }

    #[test]
    fn equal_eigenvalues_have_finite_vectors() {
        let t = DMatrix::from_row_slice(3, 3, &[2.0, 1.0, 5.0, 0.0, 2.0, 3.0, 0.0, 0.0, 2.0]);
        let blocks = Block::all(&t);
        for block in &blocks {
            let y = block.eigenvector(&t, &blocks, rounding(&t));
            // There is only one eigenvector: the first unit vector.
            assert!(y.iter().all(|y| y.re.is_finite()) && y[0].norm() >= y.camax() * (1.0 - 1e-12), "{y}");
        }
    }
}
