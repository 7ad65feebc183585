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

use nalgebra::SVector;

use crate::Dynamics;

/// End of the stability region on the imaginary axis, 2√2.
pub const IMAGINARY_LIMIT: f64 = 2.0 * core::f64::consts::SQRT_2;
/// End of the stability region on the negative real axis.
pub const REAL_LIMIT: f64 = 2.785_293_563_405_282;
/// Stages.
pub const STAGES: usize = 4;
/// Coefficients of `R(z) = 1 + z + z²/2 + z³/6 + z⁴/24`.
pub const STABILITY: [f64; 5] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0];

/// An acceleration is not finite: a body without inertia, or a pose that is no number any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

/// Pose and velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const N: usize> {
    /// Generalized coordinates, m and rad.
    pub q: SVector<f64, N>,
    /// Their rates, m/s and rad/s.
    pub v: SVector<f64, N>,
}

impl<const N: usize> State<N> {
    /// Pose `q` at rest.
    pub fn at_rest(q: SVector<f64, N>) -> Self {
        Self { q, v: SVector::zeros() }
    }
}

/// Acceleration `q̈ = A⁻¹(e + f)`, Eq. (23), m/s² and rad/s².
///
/// # Errors
/// It is not finite.
#[inline]
pub fn acceleration<const N: usize, C: Dynamics<N>>(
    crane: &C,
    t: f64,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
) -> Result<SVector<f64, N>, NotFinite> {
    let a = crane.forward_dynamics(t, q, v);
    if a.iter().all(|x| x.is_finite()) { Ok(a) } else { Err(NotFinite) }
}

/// Moves `state` from `t` to `t + h`. No allocation.
///
/// # Errors
/// An acceleration is not finite; `state` is unchanged.
pub fn step<const N: usize, C: Dynamics<N>>(crane: &C, t: f64, h: f64, state: &mut State<N>) -> Result<(), NotFinite> {
    step_with(crane, t, h, state, |_, _, _| SVector::<f64, 0>::zeros()).map(|_| ())
}

/// As [`step`], and returns the increments `∫ₜᵗ⁺ʰ integrand dt` of `M` integrals along the motion, to the same order: the
/// method's own stages and weights serve them as further components of the state.
///
/// # Errors
/// An acceleration is not finite; `state` is unchanged.
pub fn step_with<const N: usize, const M: usize, C: Dynamics<N>>(
    crane: &C,
    t: f64,
    h: f64,
    state: &mut State<N>,
    integrand: impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
) -> Result<SVector<f64, M>, NotFinite> {
    advance(crane, t, h, state, integrand).map(|(_, increments)| increments)
}

/// As [`step_with`]; also the acceleration at the beginning.
pub(super) fn advance<const N: usize, const M: usize, C: Dynamics<N>>(
    crane: &C,
    t: f64,
    h: f64,
    state: &mut State<N>,
    integrand: impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
) -> Result<(SVector<f64, N>, SVector<f64, M>), NotFinite> {
    let State { q, v } = &*state;
    let middle = t + 0.5 * h;
    let end = t + h;

    let a1 = acceleration(crane, t, q, v)?;
    let i1 = integrand(t, q, v);

    let v2 = v + a1 * (0.5 * h);
    let q2 = q + v * (0.5 * h);
    let a2 = acceleration(crane, middle, &q2, &v2)?;
    let i2 = integrand(middle, &q2, &v2);

    let v3 = v + a2 * (0.5 * h);
    let q3 = q + v2 * (0.5 * h);
    let a3 = acceleration(crane, middle, &q3, &v3)?;
    let i3 = integrand(middle, &q3, &v3);

    let v4 = v + a3 * h;
    let q4 = q + v3 * h;
    let a4 = acceleration(crane, end, &q4, &v4)?;
    let i4 = integrand(end, &q4, &v4);

    state.q += (v + (v2 + v3) * 2.0 + v4) * (h / 6.0);
    state.v += (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0);
    Ok((a1, (i1 + (i2 + i3) * 2.0 + i4) * (h / 6.0)))
}
