//! How long a run with constant steps will take.

use std::{fmt, ops::ControlFlow};

use super::{Start, recorded::clock};
use crate::{
    dyn_crane::DynCrane,
    dynamics::{Sample, Settings},
};

/// How many steps are tried to measure their time.
const TRIED: f64 = 32.0;

/// Steps of a run, and the time that they will take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Number of steps.
    pub steps: f64,
    /// Length of each, s.
    pub step: f64,
    /// Wall time of all, s; `None` where there is no clock.
    pub seconds: Option<f64>,
}

impl fmt::Display for Effort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// Longer times are given in the larger unit, from twice of it on.
        const UNITS: [(f64, &str); 4] = [(86400.0, "days"), (3600.0, "hours"), (60.0, "minutes"), (1.0, "seconds")];
        let Self { steps, step, seconds } = *self;
        write!(f, "{steps:.1e} steps of {step:.1e} s")?;
        let Some(seconds) = seconds else { return Ok(()) };
        let (length, unit) = UNITS.into_iter().find(|(length, _)| seconds >= 2.0 * length).unwrap_or(UNITS[3]);
        write!(f, ", about {:.0} {unit}", seconds / length)
    }
}

/// The effort of a run with constant steps from `start`, if it has more than [`Settings::MANY_STEPS`]; the time is that of some first steps.
pub fn large_effort(crane: &dyn DynCrane, start: &Start, settings: &Settings) -> Option<Effort> {
    let (step, steps) = (settings.step_taken(), settings.duration / settings.step_taken());
    if settings.method.is_adaptive() || steps <= Settings::MANY_STEPS {
        return None;
    }
    let begin = clock();
    let duration = TRIED * step;
    let some = Settings { duration, output: duration, ..*settings };
    // Whether they succeed is seen when the run is taken.
    let _ = crane.simulate(&start.state, &some, &mut |_: &Sample<'_>| ControlFlow::Continue(()));
    let seconds = begin.map(|begin| begin.elapsed().as_secs_f64() / TRIED * steps);
    Some(Effort { steps, step, seconds })
}
