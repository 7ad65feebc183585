//! What generated code calls besides nalgebra.

/// Sine and cosine of `x`, rad.
///
/// The standard library's with feature `std`, the portable `libm`'s without.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    #[cfg(feature = "std")]
    {
        x.sin_cos()
    }
    #[cfg(not(feature = "std"))]
    {
        nalgebra::ComplexField::sin_cos(x)
    }
}
