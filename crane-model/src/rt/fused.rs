//! Fused multiply-adds.

use wide::f64x8;

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

/// `a b + c`, rounded once if the target supports it.
#[inline]
pub fn fma<T: Fused>(a: T, b: T, c: T) -> T {
    T::fma(a, b, c)
}
