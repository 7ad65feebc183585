//! Positions of the slots of a shape in a result.

use crane_codegen::program::Shape;

/// A number of a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Entry {
    /// A slot of the function's shape.
    Slot(usize),
    /// A constant.
    Number(f64),
}

/// The result of a function, number by number. Symmetric matrices are written in full, homogeneous matrices with their fourth row,
/// both column by column, one after the other. Factors remain factors.
pub fn layout(shape: &Shape) -> Vec<Entry> {
    let mut entries = Vec::new();
    append(shape, 0, &mut entries);
    entries
}

/// Appends the entries of a shape whose slots begin at `first`.
fn append(shape: &Shape, first: usize, entries: &mut Vec<Entry>) {
    let slots = |count: usize| (first..first + count).map(Entry::Slot);
    match shape {
        Shape::Symmetric(n) => entries.extend(symmetric(*n, first)),
        Shape::Base => entries.extend(symmetric(6, first)),
        Shape::MassAndBias(n) => {
            entries.extend(symmetric(*n, first));
            let triangle = n * (n + 1) / 2;
            entries.extend((first + triangle..first + triangle + n).map(Entry::Slot));
        }
        Shape::Transforms { counts, corner } => {
            let matrices = counts.iter().sum();
            entries.extend((0..matrices).flat_map(|matrix| homogeneous(first + 12 * matrix, f64::from(*corner))));
        }
        Shape::Record(_, fields) => {
            let mut first = first;
            for (_, field) in fields {
                append(field, first, entries);
                first += field.len();
            }
        }
        Shape::Scalar
        | Shape::Vector(_)
        | Shape::Vectors(_)
        | Shape::Pairs(_)
        | Shape::Rows { .. }
        | Shape::Structs(..)
        | Shape::TransformFactors { .. }
        | Shape::Columns { .. }
        | Shape::Tangent { .. }
        | Shape::Factors(_) => entries.extend(slots(shape.len())),
    }
}

/// A full matrix, column by column, of the slots of its upper triangle, row by row.
fn symmetric(n: usize, first: usize) -> impl Iterator<Item = Entry> {
    let slot = move |row: usize, column: usize| first + row * n + column - row * (row + 1) / 2;
    (0..n * n).map(move |index| {
        let (i, j) = (index % n, index / n);
        Entry::Slot(slot(i.min(j), i.max(j)))
    })
}

/// A 4×4 matrix, column by column, of the slots of three rows.
fn homogeneous(first: usize, corner: f64) -> impl Iterator<Item = Entry> {
    (0..16).map(move |index| match (index % 4, index / 4) {
        (3, 3) => Entry::Number(corner),
        (3, _) => Entry::Number(0.0),
        (row, column) => Entry::Slot(first + 4 * row + column),
    })
}
