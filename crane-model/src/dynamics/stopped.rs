//! A run that ended early.

use std::{error::Error, fmt};

use nalgebra::DMatrix;

use super::Method;
use crate::{
    Description, Text,
    dyn_crane::Functions,
    loop_joints::{Gap, Open, drives_beyond_reach},
};

/// Why a run stopped early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A coordinate exceeded the bound of the settings, or is NaN.
    Growth,
    /// The motion grows from step to step against its own acceleration: the step is beyond the stability limit.
    Step,
    /// No step, however short, meets the tolerance of an adaptive method.
    Tolerance,
    /// The run took as many steps as the settings allow, or would take more at its pace.
    Steps,
    /// The mass matrix is not positive definite: a coordinate moves nothing that has inertia.
    MassMatrix,
    /// A loop does not close: [`Stopped::coordinate`] is its joint and the direction, [`Stopped::value`] the gap.
    OpenLoop,
    /// Rigid drives move a loop beyond its reach: [`Stopped::coordinate`] names them.
    BeyondReach,
    /// An event cannot happen: [`Stopped::coordinate`] says which, and why.
    Event,
}

/// A run that stopped early, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Stopped {
    /// Why.
    pub cause: Cause,
    /// The method.
    pub method: Method,
    /// When, s.
    pub time: f64,
    /// Coordinate with the largest value, or that moves no inertia; or the joint of a loop that is open.
    pub coordinate: Text,
    /// Its value.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// Step of the integrator, s.
    pub step: f64,
}

/// Where a run stopped.
#[derive(Clone, Copy)]
pub(super) struct StepContext<'a> {
    pub method: Method,
    /// Time and step, s.
    pub t: f64,
    pub h: f64,
    pub q: &'a [f64],
    pub description: &'a Description,
}

impl StepContext<'_> {
    /// A run that stopped because of a coordinate.
    pub fn stopped(&self, cause: Cause, coordinate: usize) -> Stopped {
        let info = self.description.coordinates.get(coordinate);
        let (name, unit) = info.map_or((Text::Static(""), ""), |info| (info.name.clone(), info.kind.unit()));
        let value = self.q.get(coordinate).copied().unwrap_or(f64::NAN);
        Stopped { cause, method: self.method, time: self.t, coordinate: name, value, unit, step: self.h }
    }

    /// A run that stopped because a loop does not close.
    pub fn open(&self, crane: &dyn Functions, open: Open) -> Stopped {
        let Gap { joint, direction, gap, unit, .. } = Gap::new(crane, open);
        let along = if direction.is_empty() { joint } else { format!("{joint} along {direction}") };
        Stopped { coordinate: along.into(), value: gap, unit, ..self.stopped(Cause::OpenLoop, 0) }
    }

    /// A run that stopped because a loop that was closed opened: because of its rigid drives, if it was about to be stretched out.
    pub fn opened(&self, crane: &dyn Functions, open: Open) -> Stopped {
        let stopped = self.open(crane, open);
        let drives = if crane.cranes() == 1 { drives_beyond_reach(crane, self.q) } else { Vec::new() };
        if drives.is_empty() {
            return stopped;
        }
        Stopped { cause: Cause::BeyondReach, coordinate: drives.join(" and ").into(), ..stopped }
    }

    /// Like [`stopped`](Self::stopped), for the coordinate with the largest value: the first that is not finite, otherwise the largest.
    pub fn furthest(&self, cause: Cause) -> Stopped {
        let size = |x: f64| if x.is_finite() { x.abs() } else { f64::INFINITY };
        let worst = (0..self.q.len()).rev().max_by(|&i, &j| size(self.q[i]).total_cmp(&size(self.q[j])));
        self.stopped(cause, worst.unwrap_or(0))
    }

    /// A run that stopped at a failed step: because of missing inertia if the mass matrix at its start is not positive definite,
    /// otherwise for the given cause.
    pub fn failed(&self, cause: Cause, crane: &dyn Functions) -> Stopped {
        match check_inertia(crane, self.q) {
            Ok(()) => self.furthest(cause),
            Err(index) => self.stopped(Cause::MassMatrix, index),
        }
    }
}

/// Checks that the mass matrix at a pose is positive definite: the O(n) recursion divides by inertias one by one and would
/// continue with negative ones. Otherwise returns the coordinate that is the cause.
///
/// The cranes of a fleet are checked one by one, before they are one.
pub(super) fn check_inertia(crane: &dyn Functions, q: &[f64]) -> Result<(), usize> {
    if crane.cranes() > 1 {
        return Ok(());
    }
    let mut mass = DMatrix::zeros(q.len(), q.len());
    crane.mass_matrix(q, mass.as_mut_slice());
    without_inertia(&mass).map_or(Ok(()), Err)
}

/// The first coordinate that moves nothing with inertia: all leading blocks before it are positive definite.
fn without_inertia(mass: &DMatrix<f64>) -> Option<usize> {
    let regular = |size: usize| size == 0 || mass.view((0, 0), (size, size)).into_owned().cholesky().is_some();
    if regular(mass.nrows()) { None } else { (0..mass.nrows()).find(|&index| !regular(index + 1)) }
}

impl Stopped {
    /// Advice on how to avoid it.
    pub fn advice(&self) -> String {
        match self.cause {
            Cause::Growth | Cause::Step if !self.method.is_adaptive() => format!(
                "try a smaller step than {:.2e} s; RK4 is stable for h < min(2.83/ω, 2.785/(βω²)) of the fastest mode \
                 (ω in rad/s, damping β in s)",
                self.step
            ),
            Cause::Growth | Cause::Step => format!(
                "nothing restrains {}: look for a load that is too large, a spring or damper that is missing or negative, \
                 and an initial state far from equilibrium; a smaller tolerance shows whether the motion is real",
                self.coordinate
            ),
            Cause::Tolerance => {
                "use a larger tolerance (1e-4 is typical) and check that motions, forces and the initial state are \
                                 finite"
                    .to_owned()
            }
            Cause::Steps if self.method.is_adaptive() => format!(
                "the steps are {:.1e} s here: look for a number in a wrong unit, such as a pressure in bar or a mass in t, and for what \
                 vibrates that fast; or use a larger tolerance (1e-4 is typical) or a shorter duration; the setting `most_steps` is \
                 the limit",
                self.step
            ),
            Cause::Steps => "use a longer step or a shorter duration; the setting `most_steps` is the limit".to_owned(),
            Cause::OpenLoop => format!(
                "check the points and axes of {} and the pose at which the run starts; a loop that closes in a plane but not in space has \
                 joints that are not parallel: hold it with a `ball` or a `slide` instead of a `pin`, or with fewer joints",
                self.coordinate
            ),
            Cause::BeyondReach => format!(
                "the loop is at a dead centre of its drives, and no pose lies beyond: end the motion of {} earlier, or change the lengths of the \
                 loop",
                self.coordinate
            ),
            Cause::Event => {
                "change the event; or leave it out, by `events: ~` in a spec that extends this one, or by a run that ends before it".to_owned()
            }
            Cause::MassMatrix => format!(
                "give the links that {} moves a `mass` above zero, in kg, and an `inertia`, in kg m², if it only rotates them, or \
                 write `joint: fixed`; a parameter may have been set to zero",
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
            Cause::Steps => {
                write!(f, "the run takes more than its maximum number of steps; it stopped at t = {time:.6} s")
            }
            Cause::OpenLoop => {
                let (size, unit) = if *unit == "m" { (value * 1e3, "mm") } else { (value.to_degrees(), "°") };
                write!(f, "a loop does not close at t = {time:.6} s: joint {coordinate} is open by {size:.3} {unit}")
            }
            Cause::BeyondReach => {
                write!(f, "at t = {time:.6} s the rigid drive of {coordinate} moves its loop beyond its reach")
            }
            Cause::Event => write!(f, "event {coordinate}, at t = {time:.6} s"),
            Cause::MassMatrix => write!(
                f,
                "the mass matrix is not positive definite at t = {time:.6} s: {coordinate} ({value:.3e} {unit}) moves nothing \
                 with a mass or inertia of its own"
            ),
        }
    }
}

impl Error for Stopped {}
