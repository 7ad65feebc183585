//! Shapes of results.

/// Consecutive coordinates that act at one point: at most three, and either all rotate or all translate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConcurrentAxes {
    /// The number of these coordinates.
    pub coordinates: usize,
    /// Whether they rotate.
    pub rotate: bool,
}

/// A type of the runtime whose fields are numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Struct {
    /// Force x, y, z, then moment x, y, z.
    Wrench,
    /// Area, section moduli for bending about y and z and for torsion, shear areas along y and z, 1 for a section with corners and 0
    /// for a round one, allowable stress.
    SectionModuli,
    /// Force, and its derivatives with respect to length and rate.
    Tension,
}

impl Struct {
    /// Number of its slots.
    #[must_use]
    #[allow(clippy::len_without_is_empty)] // none is
    pub fn len(self) -> usize {
        match self {
            Struct::Wrench => 6,
            Struct::SectionModuli => 8,
            Struct::Tension => 3,
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
    /// Several rows with one number per coordinate.
    Rows {
        /// The number of rows.
        count: usize,
        /// The number of coordinates.
        n: usize,
    },
    /// Several values of one type of the runtime.
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
    TransformFactors {
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
        points: Vec<ConcurrentAxes>,
        /// Whether the bias is included.
        bias: bool,
    },
    /// A tangent stiffness by its factors: angular and linear velocities `ω_i` and `υ_i` at unit rates of all coordinates, three slots each, a moment M
    /// and a force F of each segment, and entries. The result is the upper triangle, row by row: `ω_i · M + υ_i · F` in a segment's column and rows, and
    /// the entries in addition.
    Tangent {
        /// The number of coordinates.
        n: usize,
        /// The column of each segment, its first row, and the one after its last.
        segments: Vec<[usize; 3]>,
        /// Row and column of each entry, the row not below the column's.
        entries: Vec<[usize; 2]>,
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
            Shape::Tangent { n, segments, entries } => 6 * n + 6 * segments.len() + entries.len(),
            Shape::Symmetric(n) => n * (n + 1) / 2,
            Shape::Vectors(n) => 3 * n,
            Shape::Pairs(n) => 2 * n,
            Shape::Rows { count, n } => count * n,
            Shape::Structs(of, n) => of.len() * n,
            Shape::Transforms { counts, .. } => 12 * counts.iter().sum::<usize>(),
            Shape::TransformFactors { degrees, rotations, vectors } => {
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
            Shape::TransformFactors { degrees, .. } => degrees.iter().map(|n| n * (n + 1) / 2).sum(),
            _ => 0,
        }
    }

    /// Whether it has no slots.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
