//! An adaptive explicit pair of orders 5 and 4 with dense output.
//!
//! ```text
//!   0   |
//!  1/5  | 1/5
//!  3/10 | 3/40        9/40
//!  4/5  | 44/45       −56/15       32/9
//!  8/9  | 19372/6561  −25360/2187  64448/6561  −212/729
//!   1   | 9017/3168   −355/33      46732/5247  49/176    −5103/18656
//!   1   | 35/384      0            500/1113    125/192   −2187/6784     11/84
//! ------+-----------------------------------------------------------------------------
//!   y   | 35/384      0            500/1113    125/192   −2187/6784     11/84     0
//!  y−ŷ  | 71/57600    0            −71/16695   71/1920   −17253/339200  22/525   −1/40
//! ```
//!
//! J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19; the interpolation of order 4: E. Hairer, S. P. Nørsett,
//! G. Wanner, Solving Ordinary Differential Equations I, section II.6. The last stage is the first of the next step. On the
//! second-order form the stages of q are the rates of the stages, so that no slope of q is computed.

use nalgebra::SVector;

use super::{
    motion::{Motion, slope},
    rk4::{NotFinite, State},
};
use crate::Dynamics;

/// Stages.
const STAGES: usize = 7;
/// Stages that a step computes after another.
pub(super) const EVALUATIONS: usize = STAGES - 1;
/// Coefficients of R(z).
pub const STABILITY: [f64; 7] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 600.0];

const NODES: [f64; STAGES] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const A: [&[f64]; STAGES] = [
    &[],
    &[0.2],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19_372.0 / 6_561.0, -25_360.0 / 2_187.0, 64_448.0 / 6_561.0, -212.0 / 729.0],
    &[9_017.0 / 3_168.0, -355.0 / 33.0, 46_732.0 / 5_247.0, 49.0 / 176.0, -5_103.0 / 18_656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1_113.0, 125.0 / 192.0, -2_187.0 / 6_784.0, 11.0 / 84.0],
];
const ERROR: [f64; STAGES] =
    [71.0 / 57_600.0, 0.0, -71.0 / 16_695.0, 71.0 / 1_920.0, -17_253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
/// Weights of the last term of the interpolation.
const DENSE: [f64; STAGES] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// A step that was done.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<const N: usize, const M: usize> {
    start: Motion<N, M>,
    /// Motion at the end.
    pub end: Motion<N, M>,
    /// Difference to the embedded formula.
    pub error: Motion<N, M>,
    slopes: [Motion<N, M>; STAGES],
    /// Its length, s.
    pub length: f64,
}

impl<const N: usize, const M: usize> Step<N, M> {
    /// Slope at the end, the first of the next step.
    pub fn last_slope(&self) -> Motion<N, M> {
        self.slopes[STAGES - 1]
    }

    /// Motion at the part `theta` of the step, to order 4.
    pub fn at(&self, theta: f64) -> Motion<N, M> {
        let rest = 1.0 - theta;
        let difference = self.end.plus(&[-1.0], &[self.start], 1.0);
        let first = self.slopes[0];
        let last = self.last_slope();
        // θ (Δ + (1−θ) (h k₁ − Δ + θ (2Δ − h k₁ − h k₇ + (1−θ) h Σ dᵢ kᵢ)))
        let of_difference = theta * (1.0 - rest * (1.0 - 2.0 * theta));
        let of_first = theta * rest * (1.0 - theta) * self.length;
        let of_last = -theta * rest * theta * self.length;
        self.start.plus(&[of_difference, of_first, of_last], &[difference, first, last], 1.0).plus(
            &DENSE,
            &self.slopes,
            theta * theta * rest * rest * self.length,
        )
    }
}

/// A step from `t` to `t + h`: the state there, and the difference to the embedded formula. No allocation.
///
/// # Errors
/// An acceleration is not finite.
pub fn step<const N: usize, C: Dynamics<N>>(
    crane: &C,
    t: f64,
    h: f64,
    state: &State<N>,
) -> Result<(State<N>, State<N>), NotFinite> {
    let rest = |_: f64, _: &SVector<f64, N>, _: &SVector<f64, N>| SVector::<f64, 0>::zeros();
    let start = Motion::starting(state);
    let first = slope(crane, &rest, t, &start)?;
    let Step { end, error, .. } = advance(crane, t, h, &start, &first, &rest)?;
    Ok((State { q: end.q, v: end.v }, State { q: error.q, v: error.v }))
}

/// As [`step`], with integrals along the motion and the slope at the start given.
pub(super) fn advance<const N: usize, const M: usize, C: Dynamics<N>>(
    crane: &C,
    t: f64,
    h: f64,
    start: &Motion<N, M>,
    first: &Motion<N, M>,
    integrand: &impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
) -> Result<Step<N, M>, NotFinite> {
    let mut slopes = [*first; STAGES];
    let mut place = *start;
    for i in 1..STAGES {
        place = start.plus(A[i], &slopes, h);
        slopes[i] = slope(crane, integrand, t + NODES[i] * h, &place)?;
    }
    Ok(Step { start: *start, end: place, error: Motion::zeros().plus(&ERROR, &slopes, h), slopes, length: h })
}
