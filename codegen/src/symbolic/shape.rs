//! Shapes of results, and the completion of results that are left as factors.

use super::count::OperationCount;
use super::interpret::Scalar;

/// Consecutive coordinates that act at one point: at most three, and either all rotate or all translate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Point {
    /// Their number.
    pub coordinates: usize,
    /// Whether they rotate.
    pub turns: bool,
}

/// A type of the runtime whose fields are numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Struct {
    /// Force x, y, z, then moment x, y, z.
    Wrench,
    /// Area, moduli of bending about y and z and of torsion, shear areas along y and z, weight of corners, allowable stress.
    SectionModuli,
}

impl Struct {
    /// Number of its slots.
    #[must_use]
    #[allow(clippy::len_without_is_empty)] // none is
    pub fn len(self) -> usize {
        match self {
            Struct::Wrench => 6,
            Struct::SectionModuli => 8,
        }
    }
}

/// Shape of a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One number.
    Scalar,
    /// A column of numbers.
    Vector(usize),
    /// Symmetric matrix; slots are the upper triangle, row by row.
    Symmetric(usize),
    /// Several 3-vectors.
    Vectors(usize),
    /// Several pairs.
    Pairs(usize),
    /// Several of one type of the runtime.
    Structs(Struct, usize),
    /// Homogeneous transformations or their derivatives, grouped by body; slots are the upper three rows of each, row
    /// by row. `corner` is the corner of the constant fourth row: 1 for a transformation, 0 for a derivative.
    Transforms {
        /// The number of matrices per body.
        counts: Vec<usize>,
        /// Lower right corner.
        corner: u8,
    },
    /// Second derivatives of transformations, left as factors because there are too many to write out: slots are
    /// the axes ω_m of all coordinates (zero for a translation), then the columns of the first derivatives T_n, body by
    /// body, each as in [`Shape::Transforms`]. The result is `T_mn = ω_m × T_n` for m ≤ n. Three coordinates of one rotation
    /// vector have an additional `Σ_k share_k T_k`, with k over the three; the shares come last, six times three per vector, row by
    /// row of a triangle.
    Turned {
        /// The number of coordinates that move each body.
        degrees: Vec<usize>,
        /// Whether each coordinate is a rotation.
        rotations: Vec<bool>,
        /// First coordinates of rotation vectors.
        vectors: Vec<usize>,
    },
    /// A mass matrix by its factors: axes, linear and angular momenta and offsets to the next point of all coordinates, three
    /// slots each; then, with `bias`, a vector. The result is the upper triangle, row by row, and the vector.
    Columns {
        /// The number of coordinates.
        n: usize,
        /// The points at which the coordinates act, in order.
        points: Vec<Point>,
        /// Whether the bias is included.
        bias: bool,
    },
    /// The upper triangle of a symmetric matrix, row by row, and a vector.
    MassAndBias(usize),
    /// A symmetric 6×6 matrix over the base's coordinates, slots as in [`Shape::Symmetric`].
    Base,
    /// Numbers for another function, in an unspecified order.
    Factors(usize),
    /// Named results.
    Record(&'static str, Vec<(&'static str, Shape)>),
}

impl Shape {
    /// Number of slots.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Shape::Scalar => 1,
            Shape::Vector(n) | Shape::Factors(n) => *n,
            Shape::Base => 21,
            Shape::MassAndBias(n) => n * (n + 1) / 2 + n,
            Shape::Columns { n, bias, .. } => 12 * n + if *bias { *n } else { 0 },
            Shape::Symmetric(n) => n * (n + 1) / 2,
            Shape::Vectors(n) => 3 * n,
            Shape::Pairs(n) => 2 * n,
            Shape::Structs(of, n) => of.len() * n,
            Shape::Transforms { counts, .. } => 12 * counts.iter().sum::<usize>(),
            Shape::Turned { degrees, rotations, vectors } => {
                3 * rotations.len() + 12 * degrees.iter().sum::<usize>() + 18 * vectors.len()
            }
            Shape::Record(_, fields) => fields.iter().map(|(_, shape)| shape.len()).sum(),
        }
    }

    /// The number of homogeneous matrices in the result.
    #[must_use]
    pub fn matrices(&self) -> usize {
        match self {
            Shape::Transforms { counts, .. } => counts.iter().sum(),
            Shape::Turned { degrees, .. } => degrees.iter().map(|n| n * (n + 1) / 2).sum(),
            _ => 0,
        }
    }

    /// The result from its slots: the slots themselves, unless they are factors.
    pub fn close<S: Scalar>(&self, slots: Vec<S>) -> Vec<S> {
        match self {
            Shape::Turned { degrees, rotations, vectors } => turned_pairs(degrees, rotations.len(), vectors, &slots),
            Shape::Columns { n, points, .. } => {
                let (columns, bias) = slots.split_at(12 * n);
                let mut closed = mass_matrix(points, columns);
                closed.extend_from_slice(bias);
                closed
            }
            _ => slots,
        }
    }

    /// Operations of [`Shape::close`]; translations cost none.
    #[must_use]
    pub fn closing_count(&self) -> OperationCount {
        match self {
            Shape::Turned { degrees, rotations, vectors } => {
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
                let after = |left: &mut usize, point: &Point| {
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
            _ => OperationCount::default(),
        }
    }

    /// Whether it has no slots.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Pairs of second derivatives, body by body, from axes and first derivatives.
fn turned_pairs<S: Scalar>(degrees: &[usize], coordinates: usize, vectors: &[usize], slots: &[S]) -> Vec<S> {
    let (axes, derivatives) = slots.split_at(3 * coordinates);
    let (derivatives, shares) = derivatives.split_at(derivatives.len() - 18 * vectors.len());
    let derivative = |at: usize| &derivatives[12 * at..12 * at + 12];
    let mut closed = Vec::new();
    let mut start = 0;
    for &count in degrees {
        for m in 0..count {
            let axis = &axes[3 * m..3 * m + 3];
            for n in m..count {
                let vector = vectors.iter().position(|&first| first <= m && n < first + 3);
                let mut pair: Vec<S> = turned(axis, derivative(start + n)).collect();
                if let Some(vector) = vector {
                    let first = vectors[vector];
                    let row = m - first;
                    let place = 6 * vector + row * 3 - row * row.saturating_sub(1) / 2 + n - m;
                    for (k, share) in shares[3 * place..3 * place + 3].iter().enumerate() {
                        for (entry, own) in pair.iter_mut().zip(derivative(start + first + k)) {
                            *entry = entry.clone() + share.clone() * own.clone();
                        }
                    }
                }
                closed.extend(pair);
            }
        }
        start += count;
    }
    closed
}

/// Upper triangle of a mass matrix, row by row: `a_ij = n_i · L_j` or `n_i · P_j`, with L_j taken about the point of i.
fn mass_matrix<S: Scalar>(points: &[Point], slots: &[S]) -> Vec<S> {
    let turns: Vec<bool> =
        points.iter().flat_map(|point| std::iter::repeat_n(point.turns, point.coordinates)).collect();
    let n = turns.len();
    let vector = |kind: usize, j: usize| -> [S; 3] { std::array::from_fn(|k| slots[3 * (kind * n + j) + k].clone()) };
    let mut angular: Vec<[S; 3]> = (0..n).map(|j| vector(2, j)).collect();
    let mut rows = Vec::new();
    for i in (0..n).rev() {
        let (axis, way) = (vector(0, i), vector(3, i));
        for (j, angular) in angular.iter_mut().enumerate().skip(i + 1) {
            let linear = vector(1, j);
            let moved = |k: usize| {
                let (a, b) = ((k + 1) % 3, (k + 2) % 3);
                way[a].clone() * linear[b].clone() + (angular[k].clone() - way[b].clone() * linear[a].clone())
            };
            *angular = [moved(0), moved(1), moved(2)];
        }
        let entry = |j: usize| {
            let momentum = if turns[i] { angular[j].clone() } else { vector(1, j) };
            let [x, y, z] = [0, 1, 2].map(|k| axis[k].clone() * momentum[k].clone());
            x + (y + z)
        };
        rows.push((i..n).map(entry).collect::<Vec<S>>());
    }
    rows.into_iter().rev().flatten().collect()
}

/// `ω × column` of the four columns of a 3×4 matrix stored row by row.
fn turned<S: Scalar>(axis: &[S], rows: &[S]) -> impl Iterator<Item = S> {
    let at = |row: usize, column: usize| rows[4 * row + column].clone();
    let entry = move |row: usize, column: usize| {
        let (a, b) = ((row + 1) % 3, (row + 2) % 3);
        axis[a].clone() * at(b, column) - axis[b].clone() * at(a, column)
    };
    (0..12).map(move |slot| entry(slot / 4, slot % 4))
}
