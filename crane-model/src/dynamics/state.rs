//! Pose and rates, and the acceleration that belongs to them.

use nalgebra::SVector;

#[cfg(feature = "std")]
use crate::StateAt;
use crate::{CraneModel, Part};

/// An acceleration is not finite: a body has no inertia, or the pose contains NaN. Or forces have states of their own, or
/// joints close loops, which single steps do not support: an `Integration` does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

/// Pose and rates of a crane with `N` coordinates.
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
pub fn acceleration<const N: usize, C: CraneModel<N>>(
    crane: &C,
    t: f64,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
) -> Result<SVector<f64, N>, NotFinite> {
    const { Part::Dynamics.require(C::PARTS) }
    if crane.description().has_hidden_forces() || !crane.loop_joints().is_empty() {
        return Err(NotFinite);
    }
    let a = crane.forward_dynamics(t, q, v);
    finite(a.as_slice()).map(|()| a)
}

/// Whether all numbers are finite.
#[inline]
pub(super) fn finite(numbers: &[f64]) -> Result<(), NotFinite> {
    if numbers.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(NotFinite) }
}

/// Pose and rates from which a run starts, of a crane of any size.
#[cfg(feature = "std")]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InitialState {
    /// Generalized coordinates, m and rad.
    pub q: Vec<f64>,
    /// Their rates, m/s and rad/s.
    pub v: Vec<f64>,
    /// States of forces: of the oil of cylinders with a valve, in the order of [`hydraulics`](crate::hydraulics), Pa and shares; then
    /// deflections of bristles, m and rad. If empty, the states that hold the pose at rest.
    pub x: Vec<f64>,
}

#[cfg(feature = "std")]
impl From<StateAt<'_>> for InitialState {
    fn from(StateAt { q, v, x, .. }: StateAt<'_>) -> Self {
        Self { q: q.to_vec(), v: v.to_vec(), x: x.to_vec() }
    }
}

#[cfg(feature = "std")]
impl InitialState {
    /// Pose `q` at rest.
    pub fn at_rest(q: Vec<f64>) -> Self {
        let v = vec![0.0; q.len()];
        Self { q, v, x: Vec::new() }
    }

    /// The state at a time, s.
    pub fn at_time(&self, t: f64) -> StateAt<'_> {
        StateAt { t, q: &self.q, v: &self.v, x: &self.x }
    }
}

#[cfg(feature = "std")]
impl<const N: usize> From<State<N>> for InitialState {
    fn from(state: State<N>) -> Self {
        Self::from(&state)
    }
}

#[cfg(feature = "std")]
impl From<&Self> for InitialState {
    fn from(state: &Self) -> Self {
        state.clone()
    }
}

#[cfg(feature = "std")]
impl<const N: usize> From<&State<N>> for InitialState {
    fn from(state: &State<N>) -> Self {
        Self { q: state.q.as_slice().to_vec(), v: state.v.as_slice().to_vec(), x: Vec::new() }
    }
}
