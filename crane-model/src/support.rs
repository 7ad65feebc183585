//! What generated code calls besides nalgebra.

use nalgebra::SMatrix;

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

/// A symmetric matrix from its upper triangle: `upper[column][row]` with row ≤ column; what stands below is ignored.
#[inline]
pub fn symmetric<const N: usize>(mut upper: [[f64; N]; N]) -> SMatrix<f64, N, N> {
    for column in 0..N {
        for row in column + 1..N {
            upper[column][row] = upper[row][column];
        }
    }
    SMatrix::from(upper)
}

/// Copies results into the caller's place for them, as many as it has room for.
#[inline]
pub fn fill<T: Copy>(out: &mut [T], results: &[T]) {
    for (place, result) in out.iter_mut().zip(results) {
        *place = *result;
    }
}
