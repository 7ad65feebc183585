//! Poses during a manoeuvre, and the largest stable step over them.

use super::{Failed, Reason, Start};
use crate::{
    dyn_crane::DynCrane,
    dynamics::Method,
    modes::{self, DampedMode},
    stability::{Limit, limit},
    statics::Problem,
};

/// Number of poses during the manoeuvre at which the step is checked: 2 ms each for 25 coordinates.
pub const POSES: u16 = 10;

/// Fraction of the largest stable step that is safe: swinging changes the limit by a few per cent.
pub const SAFE: f64 = 0.9;

/// Damped modes of a crane at a moment of its manoeuvre.
#[derive(Clone, Debug)]
pub struct Pose {
    /// Time, s.
    pub t: f64,
    /// Modes about the pose at rest, and bounds on the decay rates of oil and bristles.
    pub modes: Vec<DampedMode>,
}

/// The smallest of the largest stable steps during a manoeuvre.
#[derive(Clone, Debug)]
pub struct Bound {
    /// Its time, s.
    pub t: f64,
    /// The limit and its mode.
    pub limit: Limit,
}

impl Bound {
    /// The smallest over some poses; `None` if nothing limits the step.
    pub fn smallest(poses: &[Pose], method: Method) -> Option<Self> {
        let bounds =
            poses.iter().filter_map(|pose| Some(Self { t: pose.t, limit: limit(&pose.modes, &method.stability())? }));
        bounds.min_by(|a, b| a.limit.step.total_cmp(&b.limit.step))
    }
}

/// The start and `count` further poses evenly spaced in time, each the equilibrium with the drives stopped there. There is only the start
/// if it is not at rest, and the poses end early where the crane would fall.
///
/// # Errors
/// The modes cannot be computed.
pub fn manoeuvre(crane: &dyn DynCrane, start: &Start, count: u16) -> Result<Vec<Pose>, Failed> {
    let description = crane.description();
    let mut q = start.q.clone();
    let mut poses = vec![Pose { t: 0.0, modes: modes_at(crane, 0.0, &q)? }];
    if start.rests {
        for index in 1..=count {
            let t = description.duration * f64::from(index) / f64::from(count);
            let equilibrium = Problem::new(crane).at_time(t).from(&q).solve();
            if !equilibrium.is_stable() {
                break;
            }
            q = equilibrium.q;
            poses.push(Pose { t, modes: modes_at(crane, t, &q)? });
        }
    }
    Ok(poses)
}

fn modes_at(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Result<Vec<DampedMode>, Failed> {
    let modes = modes::damped(&crane.small_motions_at(q));
    let modes = modes.map_err(|no_modes| Reason::Modes(no_modes).for_crane(&crane.description().name))?;
    Ok(limiting_modes(crane, t, q, &modes))
}

/// Modes about a pose that may limit a step: the damped ones and, not among these, the decays of oil and of bristles that slide as fast as
/// the drives move at time `t`.
pub fn limiting_modes(crane: &dyn DynCrane, t: f64, q: &[f64], damped: &[DampedMode]) -> Vec<DampedMode> {
    [damped, &modes::decays(crane, t, q)].concat()
}

/// The limit of the step of [`Method::Rk4`] during the manoeuvre; `None` if there is none or there are no modes.
pub fn step_limit(crane: &dyn DynCrane, start: &Start) -> Option<Bound> {
    Bound::smallest(&manoeuvre(crane, start, POSES).ok()?, Method::Rk4)
}
