//! Which equations of loop joints are independent.
//!
//! A planar four-bar described in space has five equations, of which two are independent. The rows of J, those of a joint's forces over
//! the length of the longest of them, are eliminated with the largest remaining row as pivot; a pivot is the square of the distance of a row from
//! the space of those before. A row is not divided by its own length: near a dead centre along an axis, it vanishes instead of
//! becoming parallel to others. Neither units nor masses matter, nor how the crane lies in the world.

use std::ops::Range;

use crate::memory::{visit_flag, visit_indices};

/// A row whose pivot is below this is zero or depends on others: a sine of 1e-5.
const DEPENDENT: f64 = 1e-10;
/// The choice is made again if the smallest pivot falls below this fraction of that at the last choice.
const WORSE: f64 = 0.1;
/// The choice is made again if a row left out has a pivot above this.
const APPEARED: f64 = 1e-8;

/// The choice of independent equations.
pub(super) struct Independence {
    /// Whether each equation transmits a moment, joint by joint.
    groups: Vec<Vec<bool>>,
    /// The coordinates for which each row has entries.
    spans: Vec<Range<usize>>,
    /// Chosen equations, in the order of their pivots.
    kept: Vec<usize>,
    is_kept: Vec<bool>,
    /// The smallest pivot, and that when the choice was made; NaN before.
    least: f64,
    chosen: f64,
    /// `J Jᵀ` of rows over their units, eliminated step by step.
    gram: Vec<f64>,
    units: Vec<f64>,
    remaining: Vec<bool>,
    /// The coordinates of a row's entries, or the rows with a part of the one that is eliminated.
    touched: Vec<usize>,
}

impl Independence {
    pub fn new(groups: Vec<Vec<bool>>, spans: Vec<Range<usize>>) -> Self {
        let count = spans.len();
        Self {
            groups,
            spans,
            kept: Vec::with_capacity(count),
            is_kept: vec![false; count],
            least: f64::NAN,
            chosen: f64::NAN,
            gram: vec![0.0; count * count],
            units: vec![0.0; count],
            remaining: vec![false; count],
            touched: Vec::with_capacity(count),
        }
    }

    /// For a choice from the beginning.
    pub fn begin_again(&self) -> Self {
        Self::new(self.groups.clone(), self.spans.clone())
    }

    /// Visits what the next choice depends on.
    pub fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let count = self.len();
        visit_indices(&mut self.kept, count, visit);
        self.is_kept.iter_mut().for_each(|kept| visit_flag(kept, visit));
        visit(&mut self.least);
        visit(&mut self.chosen);
    }

    /// Number of equations.
    pub fn len(&self) -> usize {
        self.units.len()
    }

    /// Whether no choice was made so far.
    pub fn is_unknown(&self) -> bool {
        self.chosen.is_nan()
    }

    pub fn kept(&self) -> &[usize] {
        &self.kept
    }

    pub fn is_kept(&self, equation: usize) -> bool {
        self.is_kept[equation]
    }

    /// Chooses equations at a state; `prescribed` coordinates do not count. Those chosen before remain if they are still good.
    pub fn choose(&mut self, jacobian: &[f64], n: usize, prescribed: &[usize]) {
        self.measure(jacobian, n, prescribed);
        if !self.is_unknown() && self.are_good() {
            return;
        }
        self.measure(jacobian, n, prescribed);
        self.kept.clear();
        self.is_kept.fill(false);
        self.least = 1.0;
        while let Some(next) = self.largest().filter(|&next| self.pivot(next) > DEPENDENT) {
            self.least = self.least.min(self.pivot(next));
            self.eliminate(next);
            self.kept.push(next);
            self.is_kept[next] = true;
        }
        self.chosen = self.least;
    }

    /// Whether the equations chosen are as independent as before, and those left out still depend on them.
    fn are_good(&mut self) -> bool {
        self.least = 1.0;
        for index in 0..self.kept.len() {
            let next = self.kept[index];
            let pivot = self.pivot(next);
            self.least = self.least.min(pivot);
            if pivot.is_nan() || pivot < DEPENDENT || !self.remaining[next] {
                return false;
            }
            self.eliminate(next);
        }
        self.least >= WORSE * self.chosen && self.largest().is_none_or(|next| self.pivot(next) < APPEARED)
    }

    fn pivot(&self, row: usize) -> f64 {
        self.gram[row * self.len() + row]
    }

    /// The remaining row with the largest pivot; of equal ones the first.
    fn largest(&self) -> Option<usize> {
        let rows = (0..self.len()).filter(|&row| self.remaining[row]);
        rows.reduce(|one, other| if self.pivot(other) > self.pivot(one) * (1.0 + 1e-9) { other } else { one })
    }

    /// Removes a row, and its part from those that remain.
    fn eliminate(&mut self, row: usize) {
        let (size, pivot) = (self.len(), self.pivot(row));
        let Self { remaining, touched, gram, .. } = self;
        remaining[row] = false;
        touched.clear();
        let is_touched = |j: &usize| gram[row * size + j] != 0.0 || gram[j * size + row] != 0.0;
        touched.extend((0..size).filter(|j| remaining[*j] && is_touched(j)));
        for &i in &*touched {
            let factor = gram[i * size + row] / pivot;
            for &j in &*touched {
                gram[i * size + j] -= factor * gram[row * size + j];
            }
        }
    }

    /// The products of all rows over their units; rows that are zero do not remain.
    fn measure(&mut self, jacobian: &[f64], n: usize, prescribed: &[usize]) {
        let size = self.len();
        let Self { groups, spans, gram, units, remaining, touched, .. } = self;
        for (i, span) in spans.iter().enumerate() {
            let one = &jacobian[i * n..][..n];
            touched.clear();
            touched.extend(span.clone().filter(|k| one[*k] != 0.0));
            for j in 0..=i {
                let other = &jacobian[j * n..][..n];
                let whole: f64 = touched.iter().map(|&k| one[k] * other[k]).sum();
                gram[i * size + j] = whole - prescribed.iter().map(|&k| one[k] * other[k]).sum::<f64>();
            }
        }
        let mut first = 0;
        for group in groups {
            let range = first..first + group.len();
            let lengths = range.clone().zip(&*group).filter(|(_, is_moment)| !**is_moment);
            let greatest = lengths.map(|(row, _)| gram[row * size + row].max(0.0).sqrt()).fold(0.0, f64::max);
            for (row, is_moment) in range.clone().zip(group) {
                units[row] = if *is_moment { 1.0 } else { greatest };
            }
            first = range.end;
        }
        for i in 0..size {
            remaining[i] = units[i] > 0.0;
            for j in 0..=i {
                let both = remaining[i] && remaining[j];
                let entry = if both { gram[i * size + j] / (units[i] * units[j]) } else { 0.0 };
                (gram[i * size + j], gram[j * size + i]) = (entry, entry);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three rows in two dimensions, one zero row, and one that depends only on a prescribed coordinate.
    #[test]
    fn dependent_rows_are_left_out_and_good_choices_remain() {
        let mut independence = Independence::new(vec![vec![false; 4], vec![true]], vec![0..3; 5]);
        let rows = |angle: f64| -> Vec<f64> {
            let (sin, cos) = angle.sin_cos();
            [[1.0, 0.0, 0.0], [cos, sin, 0.0], [2.0 * cos, -sin, 0.0], [0.0, 1e-17, 0.0], [0.0, 0.0, 1.0]].concat()
        };
        independence.choose(&rows(1.0), 3, &[2]);
        assert_eq!(independence.kept().len(), 2);
        let before = independence.kept().to_vec();
        independence.choose(&rows(1.1), 3, &[2]);
        assert_eq!(independence.kept(), before);
        // Rows 0 and 1 nearly coincide at a small angle, and what is left of row 2 is short.
        independence.choose(&rows(1e-3), 3, &[2]);
        assert!(independence.kept().len() == 2 && independence.least < 1e-5);
        independence.choose(&rows(0.0), 3, &[2]);
        assert_eq!(independence.kept().len(), 1);
    }
}
