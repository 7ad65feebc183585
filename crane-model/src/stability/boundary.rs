//! The boundary of a region of stability, for plots.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::StabilityFunction;

/// Points per turn of R: one per degree.
const POINTS: usize = 360;
/// Newton steps from one point to the next, a degree of R away: two reach the last bit, more cost nothing.
const NEWTON: usize = 6;

impl StabilityFunction {
    /// The closed curve `|R(z)| = 1` through the origin, by following `R(z) = e^{iφ}` until it is back.
    pub fn boundary(&self) -> Vec<Complex<f64>> {
        let mut z = Complex::new(0.0, 0.0);
        // R takes every value as many times as its degree: after that many turns of R the curve is closed.
        let turns = self.degree();
        let follow = |step: usize| {
            let target = Complex::from_polar(1.0, TAU * step as f64 / POINTS as f64);
            for _ in 0..NEWTON {
                z -= (self.value(z) - target) / self.derivative(z);
            }
            z
        };
        (0..=turns * POINTS).map(follow).take_while(|z| z.re.is_finite() && z.im.is_finite()).collect()
    }
}
