//! Tangent stiffnesses filled in a loop over pairs of coordinates.

use core::ops::{Add, Mul};

use super::fma;
use super::fused::Fused;

/// A full tangent stiffness from `ω_i` and `υ_i` of all coordinates, moment M and force F of each segment, and entries: `ω_i · M + υ_i · F` in
/// the column and the rows of a segment, `[column, first, end]`, and the entries, `[row, column]`, in addition.
pub fn fill_tangent<T: Fused + Add<Output = T> + Mul<Output = T>>(
    segments: &[[usize; 3]],
    entries: &[[usize; 2]],
    (factors, zero): (&[T], T),
    out: &mut [T],
) {
    // 6 n + 6 segments + entries
    let n = (factors.len() - 6 * segments.len() - entries.len()) / 6;
    let (axes, rest) = factors.split_at(3 * n);
    let (linear, rest) = rest.split_at(3 * n);
    let (wrenches, numbers) = rest.split_at(6 * segments.len());
    let (axes, linear, wrenches) = (axes.as_chunks::<3>().0, linear.as_chunks::<3>().0, wrenches.as_chunks::<6>().0);
    out.fill(zero);
    for ([j, first, end], [mx, my, mz, fx, fy, fz]) in segments.iter().zip(wrenches) {
        let rows = axes[*first..*end].iter().zip(&linear[*first..*end]);
        for (entry, ([x, y, z], [u, v, w])) in out[j * n + first..].iter_mut().zip(rows) {
            let of_force = fma(*u, *fx, fma(*v, *fy, *w * *fz));
            *entry = fma(*x, *mx, fma(*y, *my, fma(*z, *mz, of_force)));
        }
    }
    for ([i, j], number) in entries.iter().zip(numbers) {
        out[j * n + i] = out[j * n + i] + *number;
    }
    for column in 0..n {
        for row in 0..column {
            out[row * n + column] = out[column * n + row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two coordinates with whole numbers: a segment over both rows of the second column, one in the first, and entries.
    #[test]
    fn segments_and_entries_are_summed() {
        let velocities = [[1.0, 0.0, 2.0], [0.0, 3.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 1.0]].concat();
        let wrenches = [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]].concat();
        let factors = [velocities, wrenches, vec![10.0, 20.0]].concat();
        let mut out = vec![f64::NAN; 4];
        fill_tangent(&[[1, 0, 2], [0, 0, 1]], &[[1, 1], [0, 1]], (&factors, 0.0), &mut out);
        // ω₀ · M + υ₀ · F = 7 + 5, ω₁ · M + υ₁ · F = 6 + 10
        assert_eq!(out, [1.0, 32.0, 32.0, 26.0]);
    }
}
