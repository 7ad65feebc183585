//! One number, or eight of different cranes: what generated code does with either.

pub use wide::f64x8;

pub use super::sin_cos::sin_cos_lanes as sin_cos;
pub use super::stumpff::stumpff_lanes as stumpff;

/// A number in all lanes.
#[inline]
pub const fn splat(x: f64) -> f64x8 {
    f64x8::splat(x)
}

/// Numbers with a fused multiply-add where the target has one.
///
/// Without the target feature `fma`, `mul_add` is a slow call into a library: then it is a product and a sum.
pub trait Fused: Copy {
    /// `a b + c`
    #[must_use]
    fn fma(a: Self, b: Self, c: Self) -> Self;
}

impl Fused for f64 {
    #[inline]
    fn fma(a: f64, b: f64, c: f64) -> f64 {
        // Without `std` there is no intrinsic that stable Rust may call.
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

/// `a b + c`, rounded once where the target can.
#[inline]
pub fn fma<T: Fused>(a: T, b: T, c: T) -> T {
    T::fma(a, b, c)
}
