//! The classical Runge–Kutta method of order 4 with a constant step.
//!
//! ```text
//!   0  |
//!  1/2 | 1/2
//!  1/2 |  0   1/2
//!   1  |  0    0    1
//! -----+--------------------
//!      | 1/6  1/3  1/3  1/6
//! ```
//!
//! W. Kutta, Z. Math. Phys. 46 (1901) 435; used by [Urbaś 2016, section 3] with h = 1e-4 s.
//!
//! Stable where every eigenvalue λ of the linearised motion fulfils `|1 + z + z²/2 + z³/6 + z⁴/24| ≤ 1`, z = hλ.
//! As a rule of thumb for modes of frequency ω (rad/s), damped by β (s) times stiffness:
//! `h < min(2.83/ω, 2.785/(βω²))`. The first is the region's end on the imaginary axis, 2√2; the second that on the real one.

use core::ops::{Add, Mul};

use nalgebra::SVector;

use super::state::acceleration;
pub use super::state::{NotFinite, State};
use crate::{CraneModel, rt::lanes::f64x8};

/// End of the stability region on the imaginary axis, 2√2.
pub const IMAGINARY_LIMIT: f64 = 2.0 * core::f64::consts::SQRT_2;
/// End of the stability region on the negative real axis.
pub const REAL_LIMIT: f64 = 2.785_293_563_405_282;
/// Stages.
pub const STAGES: usize = 4;
/// Coefficients of `R(z) = 1 + z + z²/2 + z³/6 + z⁴/24`.
pub const STABILITY: [f64; 5] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0];

/// Moves `state` from `t` to `t + h`. No allocation.
///
/// # Errors
/// An acceleration is not finite; `state` is unchanged.
pub fn step<const N: usize, C: CraneModel<N>>(
    crane: &C,
    t: f64,
    h: f64,
    state: &mut State<N>,
) -> Result<(), NotFinite> {
    step_with(crane, t, h, state, |_, _, _| SVector::<f64, 0>::zeros()).map(|_| ())
}

/// Like [`step`], and returns the increments `∫ₜᵗ⁺ʰ integrand dt` of `M` integrals along the motion, to the same order: they
/// are treated as further components of the state, with the method's own stages and weights.
///
/// # Errors
/// An acceleration is not finite; `state` is unchanged.
pub fn step_with<const N: usize, const M: usize, C: CraneModel<N>>(
    crane: &C,
    t: f64,
    h: f64,
    state: &mut State<N>,
    integrand: impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
) -> Result<SVector<f64, M>, NotFinite> {
    let mut integrands = [SVector::<f64, M>::zeros(); STAGES];
    let mut room = [[0.0; N]; ROOM];
    let State { q, v } = &mut *state;
    advance(t, h, [q.as_mut_slice(), v.as_mut_slice()], room.as_flattened_mut(), |stage, t, q, v, out| {
        let [q, v] = [q, v].map(SVector::from_column_slice);
        integrands[stage] = integrand(t, &q, &v);
        acceleration(crane, t, &q, &v).map(|a| out.copy_from_slice(a.as_slice()))
    })?;
    crane.prescribe(t + h, &mut state.q, &mut state.v);
    Ok(increments(&integrands, h))
}

/// The type of the numbers in a step: one crane's, or those of eight cranes in lanes.
pub(super) trait Number: Copy + Add<Output = Self> + Mul<f64, Output = Self> {}

impl Number for f64 {}
impl Number for f64x8 {}

/// A time within a step by a few rounding errors: what functions of time do at its ends may be what they do before or after it. With a jump of
/// the accelerations by Δa on the wrong side, a stage would change the rates by h Δa/6.
pub(super) fn just_within(t: f64, [begin, end]: [f64; 2]) -> f64 {
    let shift = 16.0 * f64::EPSILON * begin.abs().max(end.abs());
    if end - begin > 2.0 * shift { t.max(begin + shift).min(end - shift) } else { t }
}

/// Number of slices, each as long as a pose, that a step needs as workspace.
pub(super) const ROOM: usize = 8;

/// `x + ẋ h`
#[inline]
fn moved<T: Number>(out: &mut [T], x: &[T], rate: &[T], h: f64) {
    for ((out, x), rate) in out.iter_mut().zip(x).zip(rate) {
        *out = *x + *rate * h;
    }
}

/// Increments of integrals over a step, from their integrands at the stages.
#[inline]
pub(super) fn increments<const M: usize>([i1, i2, i3, i4]: &[SVector<f64, M>; STAGES], h: f64) -> SVector<f64, M> {
    (i1 + (i2 + i3) * 2.0 + i4) * (h / 6.0)
}

/// Moves pose and rates from `t` to `t + h`. The first and the last stage are evaluated [just within](just_within) the step.
/// `room` is the workspace, [`ROOM`] slices as long as the pose; afterwards it begins with the
/// accelerations of stage 0. `accelerate` writes the accelerations of a stage, 0 to 3.
///
/// Each number of a pose is updated by the same operations in the same order, independently of its neighbours.
///
/// # Errors
/// Those of `accelerate`; pose and rates are unchanged.
#[inline]
pub(super) fn advance<T: Number, E>(
    t: f64,
    h: f64,
    [q, v]: [&mut [T]; 2],
    room: &mut [T],
    mut accelerate: impl FnMut(usize, f64, &[T], &[T], &mut [T]) -> Result<(), E>,
) -> Result<(), E> {
    let mut rest = room;
    let mut take = || -> &mut [T] {
        let (first, others) = core::mem::take(&mut rest).split_at_mut(q.len());
        rest = others;
        first
    };
    let [a1, a2, a3, a4, v2, v3, v4, place]: [&mut [T]; ROOM] = core::array::from_fn(|_| take());
    let (begin, middle, end) = (just_within(t, [t, t + h]), t + 0.5 * h, just_within(t + h, [t, t + h]));

    accelerate(0, begin, q, v, a1)?;

    moved(v2, v, a1, 0.5 * h);
    moved(place, q, v, 0.5 * h);
    accelerate(1, middle, place, v2, a2)?;

    moved(v3, v, a2, 0.5 * h);
    moved(place, q, v2, 0.5 * h);
    accelerate(2, middle, place, v3, a3)?;

    moved(v4, v, a3, h);
    moved(place, q, v3, h);
    accelerate(3, end, place, v4, a4)?;

    for i in 0..q.len() {
        q[i] = q[i] + (v[i] + (v2[i] + v3[i]) * 2.0 + v4[i]) * (h / 6.0);
        v[i] = v[i] + (a1[i] + (a2[i] + a3[i]) * 2.0 + a4[i]) * (h / 6.0);
    }
    Ok(())
}
