//! The expansion of results that are left as factors, because there are too many of them to write out.

use super::OperationCount;
use super::shape::{ConcurrentAxes, Shape};
use crate::symbolic::Scalar;

impl Shape {
    /// The result from its slots: the slots themselves, unless they are factors.
    pub fn expand<S: Scalar>(&self, slots: Vec<S>) -> Vec<S> {
        match self {
            Shape::TransformFactors { degrees, rotations, vectors } => {
                second_derivatives(degrees, rotations.len(), vectors, &slots)
            }
            Shape::Columns { n, points, .. } => {
                let (columns, bias) = slots.split_at(12 * n);
                let mut expanded = mass_matrix(points, columns);
                expanded.extend_from_slice(bias);
                expanded
            }
            Shape::Tangent { n, segments, entries } => tangent(*n, segments, entries, &slots),
            _ => slots,
        }
    }

    /// The shape of expanded slots.
    #[must_use]
    pub fn expanded(&self) -> Shape {
        match self {
            Shape::TransformFactors { degrees, .. } => {
                Shape::Transforms { counts: degrees.iter().map(|n| n * (n + 1) / 2).collect(), corner: 0 }
            }
            Shape::Columns { n, bias: true, .. } => Shape::MassAndBias(*n),
            Shape::Columns { n, bias: false, .. } | Shape::Tangent { n, .. } => Shape::Symmetric(*n),
            _ => self.clone(),
        }
    }

    /// Operations of [`Shape::expand`]; translations cost none.
    #[must_use]
    pub fn expansion_count(&self) -> OperationCount {
        match self {
            Shape::TransformFactors { degrees, rotations, vectors } => {
                let of = |&count: &usize| (0..count).filter(|&m| rotations[m]).map(|m| count - m).sum::<usize>();
                let pairs: usize = degrees.iter().map(of).sum();
                // Three products in each of twelve entries of six pairs.
                let of = |&count: &usize| vectors.iter().filter(|&&first| first < count).count();
                let curved = 6 * 36 * degrees.iter().map(of).sum::<usize>();
                OperationCount {
                    additions: 12 * pairs + curved,
                    multiplications: 24 * pairs + curved,
                    ..OperationCount::default()
                }
            }
            Shape::Columns { n, points, .. } => {
                // An inner product per entry, a cross product per column after a point.
                let entries = n * (n + 1) / 2;
                let after = |left: &mut usize, point: &ConcurrentAxes| {
                    *left -= point.coordinates;
                    Some(*left)
                };
                let moved: usize = points.iter().scan(*n, after).sum();
                OperationCount {
                    additions: 2 * entries + 6 * moved,
                    multiplications: 3 * entries + 6 * moved,
                    ..OperationCount::default()
                }
            }
            Shape::Tangent { segments, entries, .. } => {
                let pairs: usize = segments.iter().map(|[_, first, end]| end - first).sum();
                OperationCount {
                    additions: 5 * pairs + entries.len(),
                    multiplications: 6 * pairs,
                    ..OperationCount::default()
                }
            }
            _ => OperationCount::default(),
        }
    }
}

/// Pairs of second derivatives, body by body, from axes and first derivatives.
fn second_derivatives<S: Scalar>(degrees: &[usize], coordinates: usize, vectors: &[usize], slots: &[S]) -> Vec<S> {
    let (axes, derivatives) = slots.split_at(3 * coordinates);
    let (derivatives, shares) = derivatives.split_at(derivatives.len() - 18 * vectors.len());
    let derivative = |at: usize| &derivatives[12 * at..12 * at + 12];
    let mut expanded = Vec::new();
    let mut start = 0;
    for &count in degrees {
        for m in 0..count {
            let axis = &axes[3 * m..3 * m + 3];
            for n in m..count {
                let vector = vectors.iter().position(|&first| first <= m && n < first + 3);
                let mut pair: Vec<S> = rotated(axis, derivative(start + n)).collect();
                if let Some(vector) = vector {
                    let first = vectors[vector];
                    let row = m - first;
                    let term = 6 * vector + row * 3 - row * row.saturating_sub(1) / 2 + n - m;
                    for (k, share) in shares[3 * term..3 * term + 3].iter().enumerate() {
                        for (entry, slope) in pair.iter_mut().zip(derivative(start + first + k)) {
                            *entry = entry.clone() + share.clone() * slope.clone();
                        }
                    }
                }
                expanded.extend(pair);
            }
        }
        start += count;
    }
    expanded
}

/// Upper triangle of a mass matrix, row by row: `a_ij = n_i · L_j` or `n_i · P_j`, with L_j taken about the point of i.
fn mass_matrix<S: Scalar>(points: &[ConcurrentAxes], slots: &[S]) -> Vec<S> {
    let rotate: Vec<bool> =
        points.iter().flat_map(|point| std::iter::repeat_n(point.rotate, point.coordinates)).collect();
    let n = rotate.len();
    let vector = |kind: usize, j: usize| -> [S; 3] { std::array::from_fn(|k| slots[3 * (kind * n + j) + k].clone()) };
    let mut angular: Vec<[S; 3]> = (0..n).map(|j| vector(2, j)).collect();
    let mut rows = Vec::new();
    for i in (0..n).rev() {
        let (axis, offset) = (vector(0, i), vector(3, i));
        for (j, angular) in angular.iter_mut().enumerate().skip(i + 1) {
            let linear = vector(1, j);
            let moved = |k: usize| {
                let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                offset[a].clone() * linear[b].clone() + (angular[k].clone() - offset[b].clone() * linear[a].clone())
            };
            *angular = [moved(0), moved(1), moved(2)];
        }
        let entry = |j: usize| {
            let momentum = if rotate[i] { angular[j].clone() } else { vector(1, j) };
            let [x, y, z] = [0, 1, 2].map(|k| axis[k].clone() * momentum[k].clone());
            x + (y + z)
        };
        rows.push((i..n).map(entry).collect::<Vec<S>>());
    }
    rows.into_iter().rev().flatten().collect()
}

/// Upper triangle of a tangent stiffness, row by row: `ω_i · M + υ_i · F` in segments, and entries.
fn tangent<S: Scalar>(n: usize, segments: &[[usize; 3]], entries: &[[usize; 2]], slots: &[S]) -> Vec<S> {
    let mut upper = vec![S::from_f64(0.0); n * (n + 1) / 2];
    let place = |i: usize, j: usize| i * n + j - i * (i + 1) / 2;
    let (axes, rest) = slots.split_at(6 * n);
    let (wrenches, numbers) = rest.split_at(6 * segments.len());
    for ([j, first, end], wrench) in segments.iter().zip(wrenches.chunks_exact(6)) {
        for i in *first..*end {
            let product = |k: usize| axes[3 * (k / 3 * n + i) + k % 3].clone() * wrench[k].clone();
            // From the last one on, as the loop does.
            upper[place(i, *j)] = (0..5).rev().fold(product(5), |sum, k| product(k) + sum);
        }
    }
    for ([i, j], number) in entries.iter().zip(numbers) {
        let index = place(*i, *j);
        upper[index] = upper[index].clone() + number.clone();
    }
    upper
}

/// `ω × column` of the four columns of a 3×4 matrix stored row by row.
fn rotated<S: Scalar>(axis: &[S], rows: &[S]) -> impl Iterator<Item = S> {
    let at = |row: usize, column: usize| rows[4 * row + column].clone();
    let entry = move |row: usize, column: usize| {
        let (a, b) = ((row + 1) % 3, (row + 2) % 3);
        axis[a].clone() * at(b, column) - axis[b].clone() * at(a, column)
    };
    (0..12).map(move |slot| entry(slot / 4, slot % 4))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `K_ij = ω_i · M + υ_i · F` for one force on two coordinates, and a number beside it.
    #[test]
    fn a_tangent_is_the_work_of_wrenches_along_axes() {
        let shape = Shape::Tangent { n: 2, segments: vec![[1, 0, 2]], entries: vec![[0, 0]] };
        // ω_0, ω_1, υ_0, υ_1, M and F, the number.
        let slots = [
            [1.0, 2.0, 3.0],
            [4.0, 5.0, 6.0],
            [7.0, 8.0, 9.0],
            [10.0, 11.0, 12.0],
            [1.0, 10.0, 100.0],
            [2.0, 0.0, 1.0],
        ];
        let upper = shape.expand([slots.as_flattened(), &[0.5]].concat());
        assert_eq!(upper, [0.5, 321.0 + 23.0, 654.0 + 32.0]);
    }
}
