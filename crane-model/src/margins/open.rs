//! The open loop: the plant behind its controller.

use nalgebra::Complex;

use super::{Loop, Plant};

/// `L = C G`.
pub(super) struct Open<'a> {
    pub plant: &'a Plant,
    pub of: &'a Loop,
}

impl Open<'_> {
    /// L without the dead time.
    pub fn rational(&self, s: Complex<f64>) -> Complex<f64> {
        self.of.rational(s) * self.plant.response(s)
    }

    /// L, with its dead time.
    pub fn response(&self, s: Complex<f64>) -> Complex<f64> {
        self.of.response(s) * self.plant.response(s)
    }

    /// Poles of the controller, and of an input that follows with a negative power of s, 1/s.
    fn other_poles(&self) -> impl Iterator<Item = f64> {
        self.of.poles().chain(self.plant.integrals().then_some(0.0))
    }

    /// The step of Newton's method towards a zero of `(1 + L) Π(s − pole)`, which has no poles, and the zeros of 1 + L besides motions that the
    /// loop does not reach.
    pub fn newton_step(&self, s: Complex<f64>) -> Complex<f64> {
        let [g, slope_of_g] = self.plant.response_and_slope(s);
        let delay = (-s * self.of.delay).exp();
        let c = self.of.rational(s) * delay;
        let slope_of_c = self.of.slope(s) * delay - c * self.of.delay;
        let of_loop = (slope_of_c * g + c * slope_of_g) / (c * g + 1.0);
        let of_pole = |pole: Complex<f64>| (s - pole).inv();
        let plant = self
            .plant
            .poles()
            .iter()
            .map(|pole| if pole.im > 0.0 { of_pole(*pole) + of_pole(pole.conj()) } else { of_pole(*pole) });
        let others = self.other_poles().map(|pole| of_pole(pole.into()));
        (plant.chain(others).sum::<Complex<f64>>() + of_loop).inv()
    }
}
