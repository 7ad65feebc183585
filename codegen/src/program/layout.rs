//! Where the slots of a result are in it, in full.

use super::shape::Shape;
use crate::symbolic::Scalar;

/// A number of a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Entry {
    /// A slot of the function's shape.
    Slot(usize),
    /// A constant.
    Number(f64),
}

/// How the matrices of a result are written. Symmetric ones are written in full, one result after the other; factors remain factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Row by row, homogeneous matrices by their upper three rows: C.
    UpperRows,
    /// Row by row.
    Rows,
    /// Column by column: nalgebra.
    Columns,
}

impl Shape {
    /// The result, number by number.
    #[must_use]
    pub fn entries(&self, layout: Layout) -> Vec<Entry> {
        let mut entries = Vec::new();
        self.append(0, layout, &mut entries);
        entries
    }

    /// The positions of each slot in the result: two off the diagonal of a symmetric matrix, none or one elsewhere.
    #[must_use]
    pub fn positions(&self, layout: Layout) -> Vec<Vec<usize>> {
        let mut positions = vec![Vec::new(); self.len()];
        for (position, entry) in self.entries(layout).into_iter().enumerate() {
            if let Entry::Slot(slot) = entry {
                positions[slot].push(position);
            }
        }
        positions
    }

    /// The result in full from its slots as [`expand`](Self::expand) has them.
    pub fn fill<S: Scalar>(&self, layout: Layout, expanded: &[S]) -> Vec<S> {
        let number = |entry: Entry| match entry {
            Entry::Slot(slot) => expanded[slot].clone(),
            Entry::Number(number) => S::from_f64(number),
        };
        self.expanded().entries(layout).into_iter().map(number).collect()
    }

    /// Appends the entries of a shape whose slots begin at `first`.
    fn append(&self, mut first: usize, layout: Layout, entries: &mut Vec<Entry>) {
        match self {
            Shape::Symmetric(n) => entries.extend(symmetric(*n, first)),
            Shape::Base => entries.extend(symmetric(6, first)),
            Shape::MassAndBias(n) => {
                entries.extend(symmetric(*n, first));
                let bias = first + n * (n + 1) / 2;
                entries.extend((bias..bias + n).map(Entry::Slot));
            }
            Shape::Transforms { counts, corner } => {
                let matrices = 0..counts.iter().sum::<usize>();
                entries.extend(matrices.flat_map(|matrix| homogeneous(first + 12 * matrix, *corner, layout)));
            }
            Shape::Record(_, fields) => {
                for (_, field) in fields {
                    field.append(first, layout, entries);
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
            | Shape::Factors(_) => entries.extend((first..first + self.len()).map(Entry::Slot)),
        }
    }
}

/// A full matrix of the slots of its upper triangle, row by row.
fn symmetric(n: usize, first: usize) -> impl Iterator<Item = Entry> {
    let slot = move |row: usize, column: usize| first + row * n + column - row * (row + 1) / 2;
    (0..n * n).map(move |index| {
        let (i, j) = (index % n, index / n);
        Entry::Slot(slot(i.min(j), i.max(j)))
    })
}

/// A 4×4 matrix of the slots of its upper three rows.
fn homogeneous(first: usize, corner: u8, layout: Layout) -> impl Iterator<Item = Entry> {
    let numbers = if layout == Layout::UpperRows { 12 } else { 16 };
    (0..numbers).map(move |index| {
        let (major, minor) = (index / 4, index % 4);
        match if layout == Layout::Columns { (minor, major) } else { (major, minor) } {
            (3, 3) => Entry::Number(f64::from(corner)),
            (3, _) => Entry::Number(0.0),
            (row, column) => Entry::Slot(first + 4 * row + column),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A transform by columns has its translation last; a symmetric matrix has its lower triangle.
    #[test]
    fn results_are_written_in_full() {
        let slots: Vec<f64> = (0..12).map(f64::from).collect();
        let transform = Shape::Transforms { counts: vec![1], corner: 1 };
        let columns = [0.0, 4.0, 8.0, 0.0, 1.0, 5.0, 9.0, 0.0, 2.0, 6.0, 10.0, 0.0, 3.0, 7.0, 11.0, 1.0];
        assert_eq!(transform.fill(Layout::Columns, &slots), columns);
        assert_eq!(transform.fill(Layout::Rows, &slots)[12..], [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(transform.fill(Layout::UpperRows, &slots), slots);
        let record = Shape::Record("", vec![("one", Shape::Symmetric(2)), ("other", Shape::MassAndBias(2))]);
        assert_eq!(record.fill(Layout::Rows, &slots[..8]), [0.0, 1.0, 1.0, 2.0, 3.0, 4.0, 4.0, 5.0, 6.0, 7.0]);
        assert_eq!(record.positions(Layout::UpperRows)[1], [1, 2]);
    }
}
