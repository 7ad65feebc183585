//! What is taken of a column of a run: one number.

/// A number that stands for a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// The largest magnitude.
    Peak,
    /// The largest value.
    Maximum,
    /// The smallest value.
    Minimum,
    /// The value at the end.
    Final,
    /// The integral over time, by the trapezoidal rule.
    Integral,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Peak, Self::Maximum, Self::Minimum, Self::Final, Self::Integral];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Peak => "peak",
            Self::Maximum => "maximum",
            Self::Minimum => "minimum",
            Self::Final => "final",
            Self::Integral => "integral",
        }
    }

    /// The result at which it is, the first of equal ones; an integral is not at one.
    #[must_use]
    pub fn row(self, values: &[f64]) -> Option<usize> {
        let of = |value: f64| match self {
            Self::Minimum => -value,
            Self::Peak => value.abs(),
            _ => value,
        };
        match self {
            Self::Integral => None,
            Self::Final => values.len().checked_sub(1),
            _ => (0..values.len()).rev().max_by(|&a, &b| of(values[a]).total_cmp(&of(values[b]))),
        }
    }

    /// The results of a column at times t on which it depends, and by how much it changes with each of them. To first order the time of an
    /// extreme does not matter.
    #[must_use]
    pub fn weights(self, t: &[f64], values: &[f64]) -> Vec<(usize, f64)> {
        if self == Self::Integral {
            let interval = |row: usize| t.get(row + 1).map_or(0.0, |next| next - t[row]);
            let before = |row: usize| row.checked_sub(1).map_or(0.0, interval);
            return (0..t.len()).map(|row| (row, 0.5 * (before(row) + interval(row)))).collect();
        }
        let sign = |row: usize| if self == Self::Peak { values[row].signum() } else { 1.0 };
        self.row(values).map(|row| (row, sign(row))).into_iter().collect()
    }

    /// Its value, of a column at times t; of the derivatives of this column, its derivative.
    #[must_use]
    pub fn take(self, t: &[f64], values: &[f64], column: &[f64]) -> f64 {
        self.weights(t, values).into_iter().map(|(row, weight)| weight * column[row]).sum()
    }
}
