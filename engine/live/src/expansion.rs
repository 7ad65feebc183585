//! Results computed from the factors that a function returns if its result is too long to be written out.

use std::ops::{Add, Mul, Neg};

use crane_codegen::program::ConcurrentAxes;
use crane_model::rt::fma;
use crane_model::rt::lanes::Fused;

/// A full mass matrix from axes, linear and angular momenta and offsets to the next point of all coordinates, with the order of
/// operations of compiled cranes: `a_ij = n_i · L_j` if coordinate i rotates, `n_i · P_j` if it translates, L_j about the point
/// of i. The angular momenta are shifted from point to point.
pub fn mass_matrix<T: Fused + Neg<Output = T> + Mul<Output = T>>(
    points: &[ConcurrentAxes],
    columns: &mut [T],
    out: &mut [T],
) {
    let n: usize = points.iter().map(|point| point.coordinates).sum();
    let (axes, rest) = columns.split_at_mut(3 * n);
    let (linear, rest) = rest.split_at_mut(3 * n);
    let (angular, offsets) = rest.split_at_mut(3 * n);
    let (axes, linear, offsets) = (axes.as_chunks::<3>().0, linear.as_chunks::<3>().0, offsets.as_chunks::<3>().0);
    let angular = angular.as_chunks_mut::<3>().0;
    let mut end = n;
    for point in points.iter().rev() {
        let begin = end - point.coordinates;
        for i in (begin..end).rev() {
            for j in i..n {
                if j > i {
                    angular[j] = moved(offsets[i], linear[j], angular[j]);
                }
                let entry = along(axes[i], if point.rotate { angular[j] } else { linear[j] });
                out[i + n * j] = entry;
                out[j + n * i] = entry;
            }
        }
        end = begin;
    }
}

/// `L + way × P`
fn moved<T: Fused + Neg<Output = T>>([wx, wy, wz]: [T; 3], [px, py, pz]: [T; 3], [lx, ly, lz]: [T; 3]) -> [T; 3] {
    [fma(wy, pz, fma(-wz, py, lx)), fma(wz, px, fma(-wx, pz, ly)), fma(wx, py, fma(-wy, px, lz))]
}

/// `n · x`
fn along<T: Fused + Mul<Output = T>>(n: [T; 3], x: [T; 3]) -> T {
    fma(n[0], x[0], fma(n[1], x[1], n[2] * x[2]))
}

/// `∂²T/∂q_m∂q_n = Ω_m ∂T/∂q_n`, body by body, m ≤ n, each column by column, from the axes of all coordinates and three rows of every first derivative;
/// `degrees`: the number of coordinates that move each body; `vectors`: first coordinates of rotation vectors, whose pairs have
/// an additional `Σ_k share_k ∂T/∂q_k`.
pub fn second_derivatives<T: Copy + Add<Output = T> + Mul<Output = T> + Neg<Output = T>>(
    degrees: &[usize],
    coordinates: usize,
    vectors: &[usize],
    (factors, zero): (&[T], T),
    out: &mut [T],
) {
    let (axes, rest) = factors.split_at(3 * coordinates);
    let (first, shares) = rest.split_at(rest.len() - 18 * vectors.len());
    let (axes, first, shares) = (axes.as_chunks::<3>().0, first.as_chunks::<12>().0, shares.as_chunks::<3>().0);
    let mut start = 0;
    let mut out = out.as_chunks_mut::<16>().0.iter_mut();
    for &count in degrees {
        for m in 0..count {
            for n in m..count {
                if let Some(entry) = out.next() {
                    *entry = turned(axes[m], &first[start + n], zero);
                    let within = |of: &usize| *of <= m && n < of + 3;
                    if let Some(vector) = vectors.iter().position(within) {
                        let (of, row) = (vectors[vector], m - vectors[vector]);
                        let pair = 6 * vector + row * 3 - row * row.saturating_sub(1) / 2 + n - m;
                        for (k, share) in shares[pair].iter().enumerate() {
                            for (index, number) in first[start + of + k].iter().enumerate() {
                                let place = 4 * (index % 4) + index / 4;
                                entry[place] = entry[place] + *share * *number;
                            }
                        }
                    }
                }
            }
        }
        start += count;
    }
}

/// `ω ×` every column of a matrix of three rows, stored row by row; a matrix column by column.
fn turned<T: Copy + Add<Output = T> + Mul<Output = T> + Neg<Output = T>>(
    [x, y, z]: [T; 3],
    rows: &[T; 12],
    zero: T,
) -> [T; 16] {
    let minus = |a: T, b: T| a + -b;
    let column = |k: usize| {
        let [a, b, c] = [rows[k], rows[4 + k], rows[8 + k]];
        [minus(y * c, z * b), minus(z * a, x * c), minus(x * b, y * a), zero]
    };
    let columns = [column(0), column(1), column(2), column(3)];
    std::array::from_fn(|index| columns[index / 4][index % 4])
}
