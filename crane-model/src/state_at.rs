//! The state of a crane at a time.

use std::ops::Range;

/// The state of a crane at a time: its pose, its rates, and the states of its forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateAt<'a> {
    /// Time, s.
    pub t: f64,
    /// Generalized coordinates, m and rad.
    pub q: &'a [f64],
    /// Their rates, m/s and rad/s.
    pub v: &'a [f64],
    /// States of forces: of the oil of cylinders with a valve, in the order of [`hydraulics`](crate::hydraulics), Pa and shares; then
    /// deflections of bristles, m and rad. Empty where they do not matter.
    pub x: &'a [f64],
}

impl<'a> StateAt<'a> {
    /// That of a motion `[q, v, x]` of a crane with `n` coordinates.
    ///
    /// # Panics
    /// If there are fewer than 2 n numbers.
    pub fn from_motion(t: f64, n: usize, motion: &'a [f64]) -> Self {
        let (q, rest) = motion.split_at(n);
        let (v, x) = rest.split_at(n);
        Self { t, q, v, x }
    }

    /// The same with only some states of forces.
    pub(crate) fn with_states(&self, range: Range<usize>) -> Self {
        Self { x: &self.x[range], ..*self }
    }
}
