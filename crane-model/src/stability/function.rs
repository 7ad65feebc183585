//! The stability function of a method.

use nalgebra::Complex;

/// `|R|` counts as 1 up to this: it is 1 up to a high order of z on the imaginary axis, where rounding must not decide.
const ABOVE_ONE: f64 = 1.0 + 1e-12;
/// Step of the search along a ray: no region of a method offered has a hole narrower than this.
const SCAN: f64 = 0.01;
/// The search goes on linearly up to here, beyond every bounded region of a method offered, then by ratio.
const LINEAR: f64 = 50.0;
/// Where a region counts as without end.
const FAR: f64 = 1e12;
/// Halvings of [`SCAN`], or of a ratio, to the last bit.
const HALVINGS: usize = 60;

/// `R(z)`, the factor of a step for `ẏ = λy`, z = hλ: a ratio of polynomials, constant terms first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityFunction {
    /// Coefficients of the numerator.
    pub numerator: &'static [f64],
    /// Coefficients of the denominator; `[1]` for an explicit method.
    pub denominator: &'static [f64],
}

impl StabilityFunction {
    /// R(z).
    pub fn value(&self, z: Complex<f64>) -> Complex<f64> {
        horner(self.numerator, z) / horner(self.denominator, z)
    }

    /// `dR/dz`.
    pub fn derivative(&self, z: Complex<f64>) -> Complex<f64> {
        let denominator = horner(self.denominator, z);
        (slope(self.numerator, z) - self.value(z) * slope(self.denominator, z)) / denominator
    }

    /// Largest stable step for an eigenvalue λ of the linearised motion, 1/s: where `|R(hλ)| = 1` first, s.
    ///
    /// A growing mode (Re λ > 0) counts as undamped: its growth is the crane's, not the method's. `None` where nothing
    /// limits the step: λ = 0, or the ray along λ stays in the region.
    pub fn largest_step(&self, eigenvalue: Complex<f64>) -> Option<f64> {
        let eigenvalue = Complex::new(eigenvalue.re.min(0.0), eigenvalue.im);
        let size = eigenvalue.norm();
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let direction = eigenvalue / size;
        let stable = |radius: f64| self.value(direction * radius).norm() <= ABOVE_ONE;
        let further = |radius: f64| if radius < LINEAR { radius + SCAN } else { radius * (1.0 + SCAN) };
        let mut inside = 0.0;
        while stable(further(inside)) {
            inside = further(inside);
            if inside > FAR {
                return None;
            }
        }
        let mut outside = further(inside);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            *(if stable(middle) { &mut inside } else { &mut outside }) = middle;
        }
        Some(inside / size)
    }
}

/// A polynomial, constant term first.
fn horner(coefficients: &[f64], z: Complex<f64>) -> Complex<f64> {
    coefficients.iter().rev().fold(Complex::new(0.0, 0.0), |sum, &coefficient| sum * z + coefficient)
}

/// Its derivative.
fn slope(coefficients: &[f64], z: Complex<f64>) -> Complex<f64> {
    let terms = coefficients.iter().enumerate().skip(1).rev();
    terms.fold(Complex::new(0.0, 0.0), |sum, (power, &coefficient)| sum * z + power as f64 * coefficient)
}
