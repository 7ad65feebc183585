//! A run that came to an early end.

use std::{error::Error, fmt};

use nalgebra::SMatrix;

use crate::Description;

/// Why a run stopped before its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A coordinate left the bound of the settings, or is no number any more.
    Growth,
    /// The motion grows from step to step against its own acceleration: the step is beyond the limit of stability.
    Step,
    /// No step, however short, meets the tolerance of an adaptive method.
    Tolerance,
    /// The mass matrix is not positive definite: a coordinate moves nothing that has inertia.
    MassMatrix,
}

/// A run that stopped before its time, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stopped {
    /// Why.
    pub cause: Cause,
    /// When, s.
    pub time: f64,
    /// Coordinate that is furthest out, or that moves no inertia.
    pub coordinate: &'static str,
    /// Its value.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// Step of the integrator, s.
    pub step: f64,
}

impl Stopped {
    /// Growth, by the coordinate of `q` that is furthest out: the first that is not finite, else the greatest.
    pub(super) fn growth(time: f64, step: f64, q: &[f64], description: &Description) -> Self {
        let size = |x: f64| if x.is_finite() { x.abs() } else { f64::INFINITY };
        let worst = (0..q.len()).rev().max_by(|&i, &j| size(q[i]).total_cmp(&size(q[j]))).unwrap_or(0);
        Self::at(worst, Cause::Growth, time, step, q, description)
    }

    /// Growth from step to step, of the coordinate that is roughest.
    pub(super) fn rough(coordinate: usize, time: f64, step: f64, q: &[f64], description: &Description) -> Self {
        Self::at(coordinate, Cause::Step, time, step, q, description)
    }

    /// No step is short enough: for want of inertia at the beginning `q` of the step, or else of smoothness.
    pub(super) fn tolerance<const N: usize>(
        time: f64,
        step: f64,
        q: &[f64],
        mass: &SMatrix<f64, N, N>,
        description: &Description,
    ) -> Self {
        let stopped = Self::mass_matrix(time, step, q, mass, description);
        match stopped.cause {
            Cause::MassMatrix => stopped,
            _ => Self { cause: Cause::Tolerance, ..stopped },
        }
    }

    /// A step that met a mass matrix not positive definite: for want of inertia where `mass`, the matrix at its beginning
    /// `q`, is not either, else because the step leads out of all bounds.
    pub(super) fn mass_matrix<const N: usize>(
        time: f64,
        step: f64,
        q: &[f64],
        mass: &SMatrix<f64, N, N>,
        description: &Description,
    ) -> Self {
        // Positive definite as far as all leading blocks are; the first that is not has a pivot of zero at its end.
        let regular = |size: &usize| mass.view((0, 0), (*size, *size)).into_owned().cholesky().is_some();
        match (1..=N).find(|size| !regular(size)) {
            Some(size) => Self::at(size - 1, Cause::MassMatrix, time, step, q, description),
            None => Self::growth(time, step, q, description),
        }
    }

    fn at(index: usize, cause: Cause, time: f64, step: f64, q: &[f64], description: &Description) -> Self {
        let (coordinate, unit) =
            description.coordinates.get(index).map_or(("", ""), |info| (info.name, info.kind.unit()));
        let value = q.get(index).copied().unwrap_or(f64::NAN);
        Self { cause, time, coordinate, value, unit, step }
    }

    /// What to do about it.
    pub fn advice(&self) -> String {
        match self.cause {
            Cause::Growth | Cause::Step => format!(
                "try a smaller step than {:.2e} s; RK4 is stable for h < min(2.83/ω, 2.785/(βω²)) of the fastest mode \
                 (ω in rad/s, damping β in s)",
                self.step
            ),
            Cause::Tolerance => {
                "allow a greater tolerance, 1e-4 is usual; motions and forces must be bounded, and the \
                                 start must be no overflow"
                    .to_owned()
            }
            Cause::MassMatrix => format!(
                "give what {} moves a `mass` above zero, in kg, and where it only turns an `inertia`, in kg m², or hold \
                 it by `joint: fixed`; a parameter set to zero may have taken it away",
                self.coordinate
            ),
        }
    }
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, coordinate, value, unit, .. } = self;
        match self.cause {
            Cause::Growth => {
                write!(f, "the run grew without bound: at t = {time:.6} s {coordinate} is {value:.3e} {unit}")
            }
            Cause::Step => write!(f, "the run is unstable: at t = {time:.6} s {coordinate} grows from step to step"),
            Cause::Tolerance => {
                write!(f, "no step from t = {time:.6} s meets the tolerance; {coordinate} is {value:.3e} {unit}")
            }
            Cause::MassMatrix => write!(
                f,
                "the mass matrix is not positive definite at t = {time:.6} s: nothing that {coordinate} \
                 ({value:.3e} {unit}) moves has a mass or inertia of its own"
            ),
        }
    }
}

impl Error for Stopped {}
