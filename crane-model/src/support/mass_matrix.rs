//! Mass matrices filled in a loop, and mass matrix and bias together.

use nalgebra::SMatrix;

use super::lanes::{Fused, f64x8, fma};

/// What a mass matrix is made of, coordinate by coordinate, in the world's axes: `a_ij = n_i · L_j` where coordinate i turns
/// and `n_i · P_j` where it slides, i ≤ j, with L_j taken about the point of i.
#[derive(Clone, Copy, Debug)]
pub struct MassColumns<const N: usize> {
    /// Axes n.
    pub axes: [[f64; 3]; N],
    /// Linear momenta P of all that the coordinate moves, at unit rate; x, y and z of all coordinates.
    pub linear: [[f64; N]; 3],
    /// Angular momenta L about the coordinate's own point.
    pub angular: [[f64; N]; 3],
    /// Ways from the coordinate's point to that of the next.
    pub ways: [[f64; 3]; N],
    /// Bias e, if it is computed along with it.
    pub bias: [f64; N],
}

impl<const N: usize> MassColumns<N> {
    /// All zero.
    #[inline]
    pub fn zeros() -> Self {
        MassColumns {
            axes: [[0.0; 3]; N],
            linear: [[0.0; N]; 3],
            angular: [[0.0; N]; 3],
            ways: [[0.0; 3]; N],
            bias: [0.0; N],
        }
    }

    /// The matrix.
    #[inline]
    pub fn mass_matrix(mut self, turns: &[bool; N]) -> SMatrix<f64, N, N> {
        let mut lower = [[0.0; N]; N];
        self.fill(turns, &mut lower);
        for column in 0..N {
            for row in 0..column {
                lower[column][row] = lower[row][column];
            }
        }
        SMatrix::from(lower)
    }

    /// The lower triangle, column by column: row i of the upper triangle is column i of the lower one. What stands above the
    /// diagonal is no result.
    #[inline]
    pub fn fill(&mut self, turns: &[bool; N], lower: &mut [[f64; N]; N]) {
        let [px, py, pz] = self.linear.each_ref().map(|p| p.as_chunks::<8>());
        let [lx, ly, lz] = self.angular.each_mut().map(|l| l.as_chunks_mut::<8>());
        let rows = self.axes.iter().zip(&self.ways).zip(turns).zip(lower).enumerate().rev();
        for (i, (((axis, way), turns), column)) in rows {
            let (eights, rest) = column.as_chunks_mut::<8>();
            let row = Row { i, axis, way, turns: *turns };
            // Eight columns at a time from the one that holds the diagonal, then those that are left.
            let linear = px.0.iter().zip(py.0).zip(pz.0);
            let angular = lx.0.iter_mut().zip(ly.0.iter_mut()).zip(lz.0.iter_mut());
            let blocks = linear.zip(angular).zip(eights).enumerate().skip(i / 8);
            for (block, ((((px, py), pz), ((lx, ly), lz)), out)) in blocks {
                let p = [px, py, pz].map(|p| f64x8::new(*p));
                let mut l = [&*lx, &*ly, &*lz].map(|l| f64x8::new(*l));
                *out = row.eight(8 * block, p, &mut l).to_array();
                [*lx, *ly, *lz] = l.map(f64x8::to_array);
            }
            let linear = px.1.iter().zip(py.1).zip(pz.1);
            let angular = lx.1.iter_mut().zip(ly.1.iter_mut()).zip(lz.1.iter_mut());
            let single = linear.zip(angular).zip(rest).enumerate();
            for (k, ((((px, py), pz), ((lx, ly), lz)), out)) in single {
                let mut l = [*lx, *ly, *lz];
                *out = row.single(N / 8 * 8 + k, [*px, *py, *pz], &mut l);
                [*lx, *ly, *lz] = l;
            }
        }
    }
}

/// What row i makes of the momenta of a column j: moves L to the point of i, if j comes after i, and returns `a_ij`.
struct Row<'a> {
    i: usize,
    axis: &'a [f64; 3],
    way: &'a [f64; 3],
    turns: bool,
}

/// Lanes after a lane.
const AFTER: [[f64; 8]; 8] = {
    let mut after = [[0.0; 8]; 8];
    let mut lane = 0;
    while lane < 64 {
        after[lane / 8][lane % 8] = if lane % 8 > lane / 8 { 1.0 } else { 0.0 };
        lane += 1;
    }
    after
};

impl Row<'_> {
    /// Columns `first` to `first + 7`.
    #[inline]
    fn eight(&self, first: usize, p: [f64x8; 3], l: &mut [f64x8; 3]) -> f64x8 {
        let here = f64x8::new(if first <= self.i { AFTER[self.i % 8] } else { [1.0; 8] });
        if self.way != &[0.0; 3] {
            moved(self.way.map(|x| here * x), p, l);
        }
        along(self.axis.map(f64x8::splat), if self.turns { *l } else { p })
    }

    /// Column `j`.
    #[inline]
    fn single(&self, j: usize, p: [f64; 3], l: &mut [f64; 3]) -> f64 {
        if j > self.i {
            moved(*self.way, p, l);
        }
        along(*self.axis, if self.turns { *l } else { p })
    }
}

/// `L += way × P`
#[inline]
fn moved<T: Fused + core::ops::Neg<Output = T>>(way: [T; 3], p: [T; 3], l: &mut [T; 3]) {
    let ([wx, wy, wz], [px, py, pz], [lx, ly, lz]) = (way, p, *l);
    *l = [fma(wy, pz, fma(-wz, py, lx)), fma(wz, px, fma(-wx, pz, ly)), fma(wx, py, fma(-wy, px, lz))];
}

/// `n · x`
#[inline]
fn along<T: Fused + core::ops::Mul<Output = T>>(n: [T; 3], x: [T; 3]) -> T {
    fma(n[0], x[0], fma(n[1], x[1], n[2] * x[2]))
}

/// Mass matrix, its lower triangle, and bias.
#[derive(Clone, Copy, Debug)]
pub struct MassAndBias<const N: usize> {
    /// Columns of A from the diagonal down.
    pub mass: [[f64; N]; N],
    /// Bias e.
    pub bias: [f64; N],
}

impl<const N: usize> MassAndBias<N> {
    /// All zero.
    #[inline]
    pub fn zeros() -> Self {
        MassAndBias { mass: [[0.0; N]; N], bias: [0.0; N] }
    }
}
