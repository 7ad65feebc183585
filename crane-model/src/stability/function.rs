//! The stability function of a method.

use nalgebra::Complex;

/// Up to this `|R|` counts as 1: on the imaginary axis it is 1 up to a high order of z, and rounding must not decide there.
const ABOVE_ONE: f64 = 1.0 + 1e-12;
/// Step of the search along a ray: the regions of the available methods have no hole narrower than this.
const SCAN: f64 = 0.01;
/// Up to here, beyond every bounded region of the available methods, the steps of the search are constant; then they grow geometrically.
const LINEAR: f64 = 50.0;
/// Distance at which a region counts as unbounded.
const FAR: f64 = 1e12;
/// Halvings of [`SCAN`], or of a ratio, to the last bit.
const HALVINGS: usize = 60;

/// `R(z)`, the factor of a step for `ẏ = λy`, z = hλ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StabilityFunction {
    /// Of a one-step method: a ratio of polynomials, constant terms first.
    Rational {
        /// Coefficients of the numerator.
        numerator: &'static [f64],
        /// Coefficients of the denominator; `[1]` for an explicit method.
        denominator: &'static [f64],
    },
    /// Of the backward differentiation formula of order 2: the greater root ζ of `(3/2 − z) ζ² − 2ζ + 1/2 = 0`.
    Bdf2,
}

impl StabilityFunction {
    /// R(z).
    pub fn value(&self, z: Complex<f64>) -> Complex<f64> {
        match self {
            Self::Rational { numerator, denominator } => horner(numerator, z) / horner(denominator, z),
            Self::Bdf2 => {
                let root = (z * 2.0 + 1.0).sqrt();
                let greater = if root.re < 0.0 { -root } else { root };
                (greater + 2.0) / (-z * 2.0 + 3.0)
            }
        }
    }

    /// `dR/dz`.
    pub fn derivative(&self, z: Complex<f64>) -> Complex<f64> {
        let value = self.value(z);
        match self {
            Self::Rational { numerator, denominator } => {
                (slope(numerator, z) - value * slope(denominator, z)) / horner(denominator, z)
            }
            Self::Bdf2 => value * value / ((-z * 2.0 + 3.0) * value - 2.0),
        }
    }

    /// How many times R takes each value.
    pub(super) fn degree(&self) -> usize {
        match self {
            Self::Rational { numerator, denominator } => numerator.len().max(denominator.len()) - 1,
            Self::Bdf2 => 1,
        }
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
