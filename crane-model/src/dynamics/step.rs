//! A step that was done, and the motion within it.

use nalgebra::SVector;

use super::{
    motion::{Motion, slope},
    rk4::{NotFinite, State},
};
use crate::Dynamics;

/// A step of an adaptive method.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<const N: usize, const M: usize> {
    /// Motion at the beginning.
    pub start: Motion<N, M>,
    /// Motion at the end.
    pub end: Motion<N, M>,
    /// Difference to the embedded formula.
    pub error: Motion<N, M>,
    /// Slopes at the beginning and at the end; the latter is the first of the next step.
    pub slopes: [Motion<N, M>; 2],
    /// What a method adds to Hermite's cubic, `θ²(1−θ)² bulge`.
    pub bulge: Motion<N, M>,
    /// Its length, s.
    pub length: f64,
}

impl<const N: usize, const M: usize> Step<N, M> {
    /// Motion at the part `theta` of the step: Hermite's cubic through values and slopes at both ends, and the bulge.
    ///
    /// The cubic is off by at most `h⁴/384` times the fourth derivative, an order that methods of order 4 have themselves.
    pub fn at(&self, theta: f64) -> Motion<N, M> {
        let rest = 1.0 - theta;
        let [first, last] = self.slopes;
        let of_end = theta * theta * (1.0 + 2.0 * rest);
        let slopes = [theta * rest * rest * self.length, -theta * theta * rest * self.length];
        let bulge = theta * theta * rest * rest;
        self.start.plus(
            &[-of_end, of_end, slopes[0], slopes[1], bulge],
            &[self.start, self.end, first, last, self.bulge],
            1.0,
        )
    }
}

/// No integrals along a motion.
pub(super) type Nothing<const N: usize> = fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, 0>;

/// State and estimated error after a step by `advance` from its start, the slope there and nothing to integrate.
pub(super) fn bare<const N: usize, C: Dynamics<N>>(
    crane: &C,
    t: f64,
    state: &State<N>,
    advance: impl FnOnce(&Motion<N, 0>, &Motion<N, 0>, &Nothing<N>) -> Result<Step<N, 0>, NotFinite>,
) -> Result<(State<N>, State<N>), NotFinite> {
    let nothing: Nothing<N> = |_, _, _| SVector::zeros();
    let start = Motion::starting(state);
    let Step { end, error, .. } = advance(&start, &slope(crane, &nothing, t, &start)?, &nothing)?;
    Ok((State { q: end.q, v: end.v }, State { q: error.q, v: error.v }))
}
