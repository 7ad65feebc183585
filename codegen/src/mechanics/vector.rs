//! Vectors and matrices of expressions in the world frame.

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

    /// `R · R_axis(angle)`: a plane rotation of two columns, the third stays.
    pub fn turned(self, axis: Axis, sin: Expr<'g>, cos: Expr<'g>) -> Self {
        let (first, second) = match axis {
            Axis::X => (1, 2),
            Axis::Y => (2, 0),
            Axis::Z => (0, 1),
        };
        let (a, b) = (self.0[first], self.0[second]);
        let mut columns = self.0;
        columns[first] = cos * a + sin * b;
        columns[second] = cos * b - sin * a;
        Rotation(columns)
    }
}

/// A symmetric 3×3 matrix: xx, yy, zz, xy, xz, yz.
#[derive(Clone, Copy, Debug)]
pub struct Symmetric3<'g>(pub [Expr<'g>; 6]);

impl<'g> Symmetric3<'g> {
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
        let entry = |i: usize, j: usize| u[i] * a[j] + v[i] * b[j] + w[i] * c[j];
        Symmetric3([entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)])
    }

    /// `u pᵀ + p uᵀ`
    pub fn outer(u: Vec3<'g>, p: Vec3<'g>) -> Self {
        let entry = |i: usize, j: usize| u[i] * p[j] + p[i] * u[j];
        Symmetric3([entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)])
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
        let slot = row * self.size - row * row.saturating_sub(1) / 2 + column - row;
        self.upper[slot] = self.upper[slot] + x;
    }

    /// The upper triangle, row by row.
    pub fn into_upper(self) -> Vec<Expr<'g>> {
        self.upper
    }
}
