//! Operations of generated code on one number, or on eight numbers of different cranes.

use nalgebra::ComplexField;
pub use wide::f64x8;

pub use super::fused::{Fused, fma};
pub use super::sin_cos::sin_cos_lanes as sin_cos;
pub use super::stumpff::stumpff_lanes as stumpff;

/// A number in all lanes.
#[inline]
pub const fn splat(x: f64) -> f64x8 {
    f64x8::splat(x)
}

/// Functions of one number, or of eight: each number separately, so that a lane is bit-identical to a single number.
pub trait Function: Copy {
    /// √x, x ≥ 0
    #[must_use]
    fn sqrt(self) -> Self;
    /// eˣ
    #[must_use]
    fn exp(self) -> Self;
    /// `positive` if x > 0, otherwise `other`.
    #[must_use]
    fn select(self, positive: Self, other: Self) -> Self;
}

impl Function for f64 {
    #[inline]
    fn sqrt(self) -> f64 {
        ComplexField::sqrt(self)
    }

    #[inline]
    fn exp(self) -> f64 {
        ComplexField::exp(self)
    }

    #[inline]
    fn select(self, positive: f64, other: f64) -> f64 {
        if self > 0.0 { positive } else { other }
    }
}

impl Function for f64x8 {
    #[inline]
    fn sqrt(self) -> f64x8 {
        f64x8::sqrt(self)
    }

    #[inline]
    fn exp(self) -> f64x8 {
        let mut numbers = self.to_array();
        for number in &mut numbers {
            *number = exp(*number);
        }
        f64x8::new(numbers)
    }

    #[inline]
    fn select(self, positive: f64x8, other: f64x8) -> f64x8 {
        self.simd_gt(splat(0.0)).select(positive, other)
    }
}

/// √x, x ≥ 0
#[inline]
pub fn sqrt<T: Function>(x: T) -> T {
    Function::sqrt(x)
}

/// eˣ
#[inline]
pub fn exp<T: Function>(x: T) -> T {
    Function::exp(x)
}

/// `positive` if x > 0, otherwise `other`.
#[inline]
pub fn select<T: Function>(x: T, positive: T, other: T) -> T {
    Function::select(x, positive, other)
}
