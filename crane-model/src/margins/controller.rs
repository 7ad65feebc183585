//! The controller of a loop, with its dead time and its lag.

use nalgebra::Complex;

/// Longest time of a loop, s: one beyond it was meant in another unit.
const LONGEST: f64 = 1e6;

/// A controller with its dead time and its lag. All zeros: no loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loop {
    /// Proportional gain, unit of the input per unit of the output.
    pub p: f64,
    /// Integral gain, the same per s.
    pub i: f64,
    /// Derivative gain, the same times s.
    pub d: f64,
    /// Time constant of the filter of the derivative, s.
    pub filter: f64,
    /// Time constants of numerator and denominator of a lead, or of a lag if the second is larger, s.
    pub lead: [f64; 2],
    /// Dead time, s.
    pub delay: f64,
    /// Time constant of a first-order lag, s.
    pub lag: f64,
}

impl Loop {
    /// Its times with their names, s.
    pub fn times(&self) -> [(&'static str, f64); 5] {
        let [above, below] = self.lead;
        [("filter", self.filter), ("lead", above), ("lead", below), ("delay", self.delay), ("lag", self.lag)]
    }

    /// The first number that no controller has, with its name and what it should be: gains are finite, times from 0 to 1e6 s.
    pub fn mistake(&self) -> Option<(&'static str, f64, &'static str)> {
        let gains = [("p", self.p), ("i", self.i), ("d", self.d)].into_iter().filter(|(_, gain)| !gain.is_finite());
        let times = self.times().into_iter().filter(|(_, time)| !(0.0..=LONGEST).contains(time));
        let gains = gains.map(|(name, gain)| (name, gain, "a finite number"));
        gains.chain(times.map(|(name, time)| (name, time, "a time in s, at least 0 and at most 1e6"))).next()
    }

    /// C(s).
    pub fn response(&self, s: Complex<f64>) -> Complex<f64> {
        self.rational(s) * (-s * self.delay).exp()
    }

    /// C(s) without the dead time.
    pub(super) fn rational(&self, s: Complex<f64>) -> Complex<f64> {
        let one = Complex::from(1.0);
        let [above, below] = self.lead;
        self.gains(s)[0] * (one + s * above) / (one + s * below) / (one + s * self.lag)
    }

    /// The derivative of C without the dead time.
    pub(super) fn slope(&self, s: Complex<f64>) -> Complex<f64> {
        let one = Complex::from(1.0);
        let [gains, by_s] = self.gains(s);
        let [above, below] = self.lead;
        let lead = one + s * above;
        let [below, lag] = [below, self.lag].map(|time| (time, one + s * time));
        let falls = below.1.inv() * below.0 + lag.1.inv() * lag.0;
        (by_s * lead + gains * above - gains * lead * falls) / (below.1 * lag.1)
    }

    /// `p + i/s + d s/(1 + T_f s)` and its derivative.
    fn gains(&self, s: Complex<f64>) -> [Complex<f64>; 2] {
        let filter = s * self.filter + 1.0;
        let integral = if self.i == 0.0 { [Complex::from(0.0); 2] } else { [self.i / s, -self.i / (s * s)] };
        [s * self.d / filter + self.p + integral[0], self.d / (filter * filter) + integral[1]]
    }

    /// Its poles, 1/s, all real.
    pub(super) fn poles(&self) -> impl Iterator<Item = f64> {
        let times = [if self.d == 0.0 { 0.0 } else { self.filter }, self.lead[1], self.lag];
        let lags = times.into_iter().filter(|time| *time > 0.0).map(|time| -1.0 / time);
        lags.chain((self.i != 0.0).then_some(0.0))
    }
}
