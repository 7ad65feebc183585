//! Numbers that expressions can be evaluated with.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::stumpff;

/// What the interpreter needs from a number: f64, a dual number, a number of higher precision.
pub trait Scalar:
    Clone + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The number of a constant.
    fn from_f64(value: f64) -> Self;
    /// Sine and cosine.
    fn sin_cos(&self) -> (Self, Self);
    /// Stumpff's function `c_k(x) = Σ (−x)^i/(2i + k)!`, 0 ≤ x ≤ 100; the default uses its series.
    #[must_use]
    fn stumpff(&self, k: u8) -> Self {
        stumpff::series(k, self)
    }
    /// The smaller of two.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The larger of two.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// Square root.
    #[must_use]
    fn sqrt(&self) -> Self;
    /// Exponential.
    #[must_use]
    fn exp(&self) -> Self;
    /// `positive` if the number is above zero, otherwise `other`.
    #[must_use]
    fn select(&self, positive: Self, other: Self) -> Self;
}

impl Scalar for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
    fn sin_cos(&self) -> (Self, Self) {
        f64::sin_cos(*self)
    }
    fn stumpff(&self, k: u8) -> Self {
        stumpff::evaluate(k, *self)
    }
    fn min(self, other: Self) -> Self {
        f64::min(self, other)
    }
    fn max(self, other: Self) -> Self {
        f64::max(self, other)
    }
    fn sqrt(&self) -> Self {
        f64::sqrt(*self)
    }
    fn exp(&self) -> Self {
        f64::exp(*self)
    }
    fn select(&self, positive: Self, other: Self) -> Self {
        if *self > 0.0 { positive } else { other }
    }
}
