//! A run that came to an early end.

use std::{error::Error, fmt};

use crate::Description;

/// Why a run stopped before its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A coordinate left the bound of the settings, or is no number any more.
    Growth,
    /// The mass matrix is not positive definite.
    MassMatrix,
}

/// A run that stopped before its time, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopped {
    /// Why.
    pub cause: Cause,
    /// When, s.
    pub time: f64,
    /// Coordinate that is furthest out.
    pub coordinate: &'static str,
    /// Its value.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// Step of the integrator, s.
    pub step: f64,
}

impl Stopped {
    /// Names the coordinate of `q` that is furthest out: the first that is not finite, else the greatest.
    pub(super) fn new(cause: Cause, time: f64, step: f64, q: &[f64], description: &Description) -> Self {
        let size = |x: f64| if x.is_finite() { x.abs() } else { f64::INFINITY };
        let worst = (0..q.len()).rev().max_by(|&i, &j| size(q[i]).total_cmp(&size(q[j]))).unwrap_or(0);
        let (coordinate, unit) =
            description.coordinates.get(worst).map_or(("", ""), |info| (info.name, info.kind.unit()));
        let value = q.get(worst).copied().unwrap_or(f64::NAN);
        Self { cause, time, coordinate, value, unit, step }
    }

    /// What to do about it.
    pub fn advice(&self) -> String {
        format!(
            "try a smaller step than {:.2e} s; RK4 is stable for h < min(2.83/ω, 2.785/(βω²)) of the fastest mode \
             (ω in rad/s, damping β in s)",
            self.step
        )
    }
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, coordinate, value, unit, .. } = self;
        match self.cause {
            Cause::Growth => {
                write!(f, "the run grew without bound: at t = {time:.6} s {coordinate} is {value:.3e} {unit}")
            }
            Cause::MassMatrix => write!(
                f,
                "the mass matrix is not positive definite at t = {time:.6} s; furthest out is {coordinate}, \
                 {value:.3e} {unit}"
            ),
        }
    }
}

impl Error for Stopped {}
