//! Operations of generated code on one number, or on eight numbers of different cranes.

use nalgebra::ComplexField;
pub use wide::f64x8;

pub use super::sin_cos::sin_cos_lanes as sin_cos;
pub use super::stumpff::stumpff_lanes as stumpff;

/// A number in all lanes.
#[inline]
pub const fn splat(x: f64) -> f64x8 {
    f64x8::splat(x)
}

/// Numbers with a fused multiply-add if the target has one.
///
/// Without the target feature `fma`, `mul_add` would be a slow library call: a product and a sum are used instead.
pub trait Fused: Copy {
    /// `a b + c`
    #[must_use]
    fn fma(a: Self, b: Self, c: Self) -> Self;
}

impl Fused for f64 {
    #[inline]
    fn fma(a: f64, b: f64, c: f64) -> f64 {
        // Without `std` there is no intrinsic available in stable Rust.
        #[cfg(all(feature = "std", any(target_feature = "fma", target_arch = "aarch64")))]
        {
            a.mul_add(b, c)
        }
        #[cfg(not(all(feature = "std", any(target_feature = "fma", target_arch = "aarch64"))))]
        {
            a * b + c
        }
    }
}

impl Fused for f64x8 {
    #[inline]
    fn fma(a: f64x8, b: f64x8, c: f64x8) -> f64x8 {
        a.mul_add(b, c)
    }
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
        f64x8::new(self.to_array().map(Function::exp))
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

/// `a b + c`, rounded once if the target supports it.
#[inline]
pub fn fma<T: Fused>(a: T, b: T, c: T) -> T {
    T::fma(a, b, c)
}
