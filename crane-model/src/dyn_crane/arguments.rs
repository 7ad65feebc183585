//! Arguments of functions on slices.

use crate::rt::derivatives::Constant;

/// What functions of the table of quantities take, by their names there. Those that a function does not take may be empty.
#[derive(Clone, Copy, Debug)]
pub struct Arguments<'a, T = f64> {
    /// Time, s.
    pub t: T,
    /// Coordinates, m and rad.
    pub q: &'a [T],
    /// Their rates, m/s and rad/s.
    pub v: &'a [T],
    /// Accelerations, m/s² and rad/s².
    pub a: &'a [T],
    /// Right-hand side of a linear system, N and N m.
    pub r: &'a [T],
    /// Positions at which drives are held, by coordinate, m and rad.
    pub positions: &'a [T],
}

impl<T: Constant> Arguments<'_, T> {
    /// None, at t = 0.
    #[must_use]
    pub fn none() -> Self {
        Self { t: T::constant(0.0), q: &[], v: &[], a: &[], r: &[], positions: &[] }
    }
}
