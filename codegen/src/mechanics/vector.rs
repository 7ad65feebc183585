//! Vectors and 3×3 matrices of expressions.

use std::ops::{Add, Index, Mul, Neg, Sub};

use crate::chain::Axis;
use crate::symbolic::{Expr, Graph};

/// A 3-vector.
#[derive(Clone, Copy, Debug)]
pub struct Vec3<'g>(pub [Expr<'g>; 3]);

impl<'g> Vec3<'g> {
    pub fn zero(graph: &'g Graph) -> Self {
        Vec3([graph.constant(0.0); 3])
    }

    pub fn dot(self, other: Self) -> Expr<'g> {
        self[0] * other[0] + self[1] * other[1] + self[2] * other[2]
    }

    pub fn cross(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Vec3([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
    }

    /// `x` along an axis.
    pub fn along(axis: Axis, x: Expr<'g>) -> Self {
        let mut vector = Vec3::zero(x.graph());
        vector.0[axis.index()] = x;
        vector
    }

    /// `[d]× Mᵀ`: column j is d × (row j of M).
    pub fn cross_rows(self, matrix: &Matrix3<'g>) -> Matrix3<'g> {
        let columns = [0, 1, 2].map(|j| self.cross(matrix.row(j)));
        Matrix3([0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])))
    }

    /// Names the components `name_x`, `name_y`, `name_z` in generated code.
    pub fn named(self, name: &str) -> Self {
        for (component, axis) in self.0.iter().zip(["x", "y", "z"]) {
            component.graph().name(*component, format!("{name}_{axis}"));
        }
        self
    }
}

impl<'g> Index<usize> for Vec3<'g> {
    type Output = Expr<'g>;
    fn index(&self, i: usize) -> &Expr<'g> {
        &self.0[i]
    }
}

impl Add for Vec3<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Vec3([0, 1, 2].map(|i| self[i] + other[i]))
    }
}

impl Sub for Vec3<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Vec3([0, 1, 2].map(|i| self[i] - other[i]))
    }
}

impl Neg for Vec3<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        Vec3(self.0.map(|x| -x))
    }
}

impl<'g> Mul<Vec3<'g>> for Expr<'g> {
    type Output = Vec3<'g>;
    fn mul(self, vector: Vec3<'g>) -> Vec3<'g> {
        Vec3(vector.0.map(|x| self * x))
    }
}

/// A rotation matrix by its columns: the axes of a frame in the world.
#[derive(Clone, Copy, Debug)]
pub struct Rotation<'g>(pub [Vec3<'g>; 3]);

impl<'g> Rotation<'g> {
    pub fn identity(graph: &'g Graph) -> Self {
        let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
        Rotation([Vec3([one, zero, zero]), Vec3([zero, one, zero]), Vec3([zero, zero, one])])
    }

    pub fn axis(self, axis: Axis) -> Vec3<'g> {
        self.0[axis.index()]
    }

    /// `R x`
    pub fn apply(self, x: Vec3<'g>) -> Vec3<'g> {
        x[0] * self.0[0] + x[1] * self.0[1] + x[2] * self.0[2]
    }

    /// `Rᵀ x`
    pub fn apply_transposed(self, x: Vec3<'g>) -> Vec3<'g> {
        Vec3(self.0.map(|column| column.dot(x)))
    }

    /// `R S` for another rotation S.
    pub fn times(self, other: Self) -> Self {
        Rotation(other.0.map(|column| self.apply(column)))
    }

    /// `R · R_axis(angle)`: a plane rotation of two columns; the third is unchanged.
    pub fn rotated(self, axis: Axis, sin: Expr<'g>, cos: Expr<'g>) -> Self {
        let (first, second) = plane(axis);
        let (a, b) = (self.0[first], self.0[second]);
        let mut columns = self.0;
        columns[first] = cos * a + sin * b;
        columns[second] = cos * b - sin * a;
        Rotation(columns)
    }
}

/// The axes that a rotation about `axis` moves, the first towards the second.
pub fn plane(axis: Axis) -> (usize, usize) {
    match axis {
        Axis::X => (1, 2),
        Axis::Y => (2, 0),
        Axis::Z => (0, 1),
    }
}

/// A 3×3 matrix by its rows.
#[derive(Clone, Copy, Debug)]
pub struct Matrix3<'g>(pub [[Expr<'g>; 3]; 3]);

impl<'g> Matrix3<'g> {
    pub fn zero(graph: &'g Graph) -> Self {
        Matrix3([[graph.constant(0.0); 3]; 3])
    }

    /// `[x]×`, so that `[x]× y = x × y`.
    pub fn cross(x: Vec3<'g>) -> Self {
        let zero = x[0].graph().constant(0.0);
        Matrix3([[zero, -x[2], x[1]], [x[2], zero, -x[0]], [-x[1], x[0], zero]])
    }

    pub fn row(&self, i: usize) -> Vec3<'g> {
        Vec3(self.0[i])
    }

    pub fn column(&self, j: usize) -> Vec3<'g> {
        Vec3([0, 1, 2].map(|i| self.0[i][j]))
    }

    /// `M x`
    pub fn apply(&self, x: Vec3<'g>) -> Vec3<'g> {
        Vec3([0, 1, 2].map(|i| self.row(i).dot(x)))
    }

    /// `Mᵀ x`
    pub fn apply_transposed(&self, x: Vec3<'g>) -> Vec3<'g> {
        Vec3([0, 1, 2].map(|j| self.column(j).dot(x)))
    }

    /// The matrix with each column replaced.
    pub fn map_columns(&self, f: impl Fn(Vec3<'g>) -> Vec3<'g>) -> Self {
        let columns = [0, 1, 2].map(|j| f(self.column(j)));
        Matrix3([0, 1, 2].map(|i| [0, 1, 2].map(|j| columns[j][i])))
    }

    /// `R M Rᵀ`
    pub fn rotated(&self, rotation: Rotation<'g>) -> Self {
        let left = self.map_columns(|column| rotation.apply(column));
        Matrix3([0, 1, 2].map(|i| rotation.apply(left.row(i)).0))
    }

    /// Names the entries `name_xx`, `name_xy` … in generated code.
    pub fn named(self, name: &str) -> Self {
        for (row, a) in self.0.iter().zip(["x", "y", "z"]) {
            Vec3(*row).named(&format!("{name}_{a}"));
        }
        self
    }
}

impl Add for Matrix3<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Matrix3([0, 1, 2].map(|i| (self.row(i) + other.row(i)).0))
    }
}

/// A symmetric 3×3 matrix: xx, yy, zz, xy, xz, yz.
#[derive(Clone, Copy, Debug)]
pub struct Symmetric3<'g>(pub [Expr<'g>; 6]);

impl<'g> Symmetric3<'g> {
    pub fn zero(graph: &'g Graph) -> Self {
        Symmetric3([graph.constant(0.0); 6])
    }

    /// A symmetric matrix by its entries on and above the diagonal.
    pub fn from_entries(entry: impl Fn(usize, usize) -> Expr<'g>) -> Self {
        Symmetric3([entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)])
    }

    /// `x 1`
    pub fn scalar(x: Expr<'g>) -> Self {
        let zero = x.graph().constant(0.0);
        Symmetric3([x, x, x, zero, zero, zero])
    }

    /// The entry (i, j).
    pub fn at(&self, i: usize, j: usize) -> Expr<'g> {
        self.0[Self::slot(i, j)]
    }

    /// The entry (i, j), mutable.
    pub fn at_mut(&mut self, i: usize, j: usize) -> &mut Expr<'g> {
        &mut self.0[Self::slot(i, j)]
    }

    fn slot(i: usize, j: usize) -> usize {
        if i == j { i } else { i + j + 2 }
    }

    pub fn row(&self, i: usize) -> Vec3<'g> {
        Vec3([0, 1, 2].map(|j| self.at(i, j)))
    }

    /// All nine entries.
    pub fn full(&self) -> Matrix3<'g> {
        Matrix3([0, 1, 2].map(|i| self.row(i).0))
    }

    /// `S⁻¹ = Σ r C` as pairs of reciprocals r and cofactors C, one per block of coupled axes: expressions of C need
    /// not wait for the divisions.
    pub fn inverse(&self) -> Vec<(Expr<'g>, Self)> {
        let zero = || Self::zero(self.0[0].graph());
        let alone = |k: usize| {
            let mut cofactor = zero();
            *cofactor.at_mut(k, k) = self.0[0].graph().constant(1.0);
            (1.0 / self.at(k, k), cofactor)
        };
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            if self.at(k, a).is_zero() && self.at(k, b).is_zero() {
                if self.at(a, b).is_zero() {
                    return vec![alone(0), alone(1), alone(2)];
                }
                let mut cofactors = zero();
                *cofactors.at_mut(a, a) = self.at(b, b);
                *cofactors.at_mut(b, b) = self.at(a, a);
                *cofactors.at_mut(a, b) = -self.at(a, b);
                let determinant = self.at(a, a) * self.at(b, b) - self.at(a, b).squared();
                return vec![alone(k), (1.0 / determinant, cofactors)];
            }
        }
        let cofactors = Self::from_entries(|i, j| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            self.at(a, c) * self.at(b, d) - self.at(a, d) * self.at(b, c)
        });
        vec![(1.0 / self.row(0).dot(cofactors.row(0)), cofactors)]
    }

    /// `S x`
    pub fn apply(self, x: Vec3<'g>) -> Vec3<'g> {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        Vec3([xx * x[0] + xy * x[1] + xz * x[2], xy * x[0] + yy * x[1] + yz * x[2], xz * x[0] + yz * x[1] + zz * x[2]])
    }

    /// `R S Rᵀ`
    pub fn rotated(self, rotation: Rotation<'g>) -> Self {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        let [a, b, c] = rotation.0;
        // Columns of R S.
        let u = xx * a + xy * b + xz * c;
        let v = xy * a + yy * b + yz * c;
        let w = xz * a + yz * b + zz * c;
        Self::from_entries(|i, j| u[i] * a[j] + v[i] * b[j] + w[i] * c[j])
    }

    /// `u pᵀ + p uᵀ`
    pub fn outer(u: Vec3<'g>, p: Vec3<'g>) -> Self {
        Self::from_entries(|i, j| u[i] * p[j] + p[i] * u[j])
    }

    /// The inertia tensor `tr(Σ) 1 − Σ` of second moments Σ.
    pub fn tensor(self) -> Self {
        let [xx, yy, zz, xy, xz, yz] = self.0;
        Symmetric3([yy + zz, xx + zz, xx + yy, -xy, -xz, -yz])
    }

    /// Names the entries `name_xx` … in generated code.
    pub fn named(self, name: &str) -> Self {
        for (entry, axes) in self.0.iter().zip(["xx", "yy", "zz", "xy", "xz", "yz"]) {
            entry.graph().name(*entry, format!("{name}_{axes}"));
        }
        self
    }
}

impl Add for Symmetric3<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Symmetric3([0, 1, 2, 3, 4, 5].map(|i| self.0[i] + other.0[i]))
    }
}

/// A symmetric matrix of any size by its upper triangle, row by row.
#[derive(Clone, Debug)]
pub struct SymmetricMatrix<'g> {
    size: usize,
    upper: Vec<Expr<'g>>,
}

impl<'g> SymmetricMatrix<'g> {
    pub fn zero(graph: &'g Graph, size: usize) -> Self {
        SymmetricMatrix { size, upper: vec![graph.constant(0.0); size * (size + 1) / 2] }
    }

    /// Adds `x` to the entry (i, j) and its mirror image.
    pub fn add(&mut self, i: usize, j: usize, x: Expr<'g>) {
        let (row, column) = (i.min(j), i.max(j));
        let slot = self.slot(row, column);
        self.upper[slot] = self.upper[slot] + x;
    }

    /// Adds numbers to the diagonal, given by their rows.
    pub fn add_diagonal(&mut self, entries: impl IntoIterator<Item = (usize, Expr<'g>)>) {
        entries.into_iter().for_each(|(j, x)| self.add(j, j, x));
    }

    /// The entry (i, j).
    pub fn at(&self, i: usize, j: usize) -> Expr<'g> {
        let (row, column) = (i.min(j), i.max(j));
        self.upper[self.slot(row, column)]
    }

    /// The matrix with `x` on the diagonal of row and column j, and zeros elsewhere in them.
    pub fn without(mut self, j: usize, x: Expr<'g>) -> Self {
        for i in 0..self.size {
            let slot = self.slot(i.min(j), i.max(j));
            self.upper[slot] = if i == j { x } else { x.graph().constant(0.0) };
        }
        self
    }

    fn slot(&self, row: usize, column: usize) -> usize {
        row * self.size - row * row.saturating_sub(1) / 2 + column - row
    }

    /// Solves `S x = r` for a positive definite S, by `S = L D Lᵀ`.
    pub fn solve(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let n = self.size;
        let (mut rest, mut x) = (self.clone(), right.to_vec());
        let mut reciprocals = Vec::new();
        let mut lower: Vec<Vec<Expr<'g>>> = vec![vec![]; n];
        for k in 0..n {
            let reciprocal = 1.0 / rest.at(k, k);
            for i in k + 1..n {
                let factor = rest.at(i, k) * reciprocal;
                for j in k + 1..=i {
                    let slot = rest.slot(j, i);
                    rest.upper[slot] = rest.upper[slot] - factor * rest.at(j, k);
                }
                x[i] = x[i] - factor * x[k];
                lower[i].push(factor);
            }
            reciprocals.push(reciprocal);
        }
        for k in (0..n).rev() {
            x[k] = reciprocals[k] * x[k];
            for i in k + 1..n {
                x[k] = x[k] - lower[i][k] * x[i];
            }
        }
        x
    }

    /// The upper triangle, row by row.
    pub fn into_upper(self) -> Vec<Expr<'g>> {
        self.upper
    }
}
