//! Mass matrices filled in a loop, and mass matrix and bias together.

use super::lanes::{f64x8, fma};
use super::mirror;

/// The factors of a mass matrix, coordinate by coordinate, in the world's axes: `a_ij = n_i · L_j` if coordinate i rotates and
/// `n_i · P_j` if it translates, i ≤ j, with L_j about the point of i. `E` groups of eight hold `N` columns.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct MassColumns<const N: usize, const E: usize> {
    /// Momenta of the coordinates, in groups of eight.
    pub eights: [Momenta; E],
    /// Axes n.
    pub axes: [[f64; 3]; N],
    /// Offsets from the coordinate's point to that of the next.
    pub offsets: [[f64; 3]; N],
    /// Bias e, if it is computed together with the matrix.
    pub bias: [f64; N],
}

/// Momenta of everything that eight coordinates move, at unit rate; x, y and z of all eight.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Momenta {
    /// Linear momenta P.
    pub linear: [[f64; 8]; 3],
    /// Angular momenta L about the coordinate's own point.
    pub angular: [[f64; 8]; 3],
}

/// Consecutive coordinates that act at one point: at most three, and either all rotate or all translate.
#[derive(Clone, Copy, Debug)]
pub struct ConcurrentAxes {
    /// Their number.
    pub coordinates: usize,
    /// Whether they rotate.
    pub rotate: bool,
}

impl<const N: usize, const E: usize> MassColumns<N, E> {
    /// All zero.
    #[inline]
    pub fn zeros() -> Self {
        MassColumns {
            eights: [Momenta { linear: [[0.0; 8]; 3], angular: [[0.0; 8]; 3] }; E],
            axes: [[0.0; 3]; N],
            offsets: [[0.0; 3]; N],
            bias: [0.0; N],
        }
    }

    /// The matrix, column by column.
    #[inline]
    pub fn mass_matrix(&mut self, points: &[ConcurrentAxes], columns: &mut [[f64; N]; N]) {
        self.fill(points, columns);
        mirror(columns);
    }

    /// The lower triangle, column by column: row i of the upper triangle is column i of the lower one. The entries above
    /// the diagonal are meaningless.
    #[inline]
    pub fn fill(&mut self, points: &[ConcurrentAxes], lower: &mut [[f64; N]; N]) {
        let eights = &mut self.eights;
        let mut rows = Rows { axes: &self.axes, offsets: &self.offsets, lower };
        for point in points.iter().rev() {
            match point.coordinates {
                1 => rows.last::<1>(point.rotate, eights),
                2 => rows.last::<2>(point.rotate, eights),
                _ => rows.last::<3>(point.rotate, eights),
            }
        }
    }
}

/// Rows not yet filled.
struct Rows<'a, const N: usize> {
    axes: &'a [[f64; 3]],
    offsets: &'a [[f64; 3]],
    lower: &'a mut [[f64; N]],
}

impl<const N: usize> Rows<'_, N> {
    /// Fills the last `K` rows, whose coordinates act at one point.
    #[inline]
    fn last<const K: usize>(&mut self, rotate: bool, eights: &mut [Momenta]) {
        let lower = core::mem::take(&mut self.lower);
        let last =
            (self.axes.split_last_chunk::<K>(), self.offsets.split_last_chunk::<K>(), lower.split_last_chunk_mut());
        let (Some((axes, of_body)), Some((offsets, after)), Some((lower, rows))) = last else { return };
        let offset = after.last().unwrap_or(&[0.0; 3]);
        let first = axes.len();
        (self.axes, self.offsets, self.lower) = (axes, offsets, lower);
        let axes = of_body.map(|axis| axis.map(f64x8::splat));
        if rotate {
            fill(first, offset, rows, eights, |_, l| axes.map(|n| along(n, l)));
        } else {
            fill(first, offset, rows, eights, |p, _| axes.map(|n| along(n, p)));
        }
    }
}

/// The lanes of eight columns.
const LANES: f64x8 = f64x8::new([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);

/// Fills the rows from `first` on, eight columns at a time, with the `entries` of their momenta; the momenta of columns after these rows
/// are first shifted by `offset`.
#[inline]
fn fill<const K: usize, const N: usize>(
    first: usize,
    offset: &[f64; 3],
    rows: &mut [[f64; N]; K],
    eights: &mut [Momenta],
    entries: impl Fn([f64x8; 3], [f64x8; 3]) -> [f64x8; K],
) {
    let offset = offset.map(f64x8::splat);
    for (eight, momenta) in eights.iter_mut().enumerate().skip(first / 8) {
        let p = momenta.linear.map(f64x8::new);
        let mut offset = offset;
        if 8 * eight < first + K {
            let after = (LANES + number(8 * eight)).simd_ge(number(first + K));
            offset = offset.map(|w| w & after);
        }
        let l = moved(offset, p, momenta.angular.map(f64x8::new));
        momenta.angular = l.map(f64x8::to_array);
        for (row, entries) in rows.iter_mut().zip(entries(p, l)) {
            let (eights, rest) = row.as_chunks_mut::<8>();
            match eights.get_mut(eight) {
                Some(block) => *block = entries.to_array(),
                None => rest.iter_mut().zip(entries.to_array()).for_each(|(block, entry)| *block = entry),
            }
        }
    }
}

/// An index in all lanes.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "indices of columns are small")]
fn number(index: usize) -> f64x8 {
    f64x8::splat(index as f64)
}

/// `L + offset × P`
#[inline]
fn moved([wx, wy, wz]: [f64x8; 3], [px, py, pz]: [f64x8; 3], [lx, ly, lz]: [f64x8; 3]) -> [f64x8; 3] {
    [fma(wy, pz, fma(-wz, py, lx)), fma(wz, px, fma(-wx, pz, ly)), fma(wx, py, fma(-wy, px, lz))]
}

/// `n · x`
#[inline]
fn along(n: [f64x8; 3], x: [f64x8; 3]) -> f64x8 {
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
