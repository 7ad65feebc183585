//! A run over time, with results at their own interval.

use std::ops::ControlFlow;

use nalgebra::{SVector, Vector2};

use super::{Stopped, rk4, roughness::Roughness};
use crate::{Description, Dynamics};

/// No crane is 1 km long and no joint of one turns 160 times: beyond this, m or rad, a run has blown up.
const BOUND: f64 = 1e3;
/// Whole numbers of steps are recognised to this relative accuracy: 0.01/1e-4 is not 100 in binary.
const WHOLE: f64 = 1e-9;

/// How to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Simulated time, s.
    pub duration: f64,
    /// Greatest step, s. The step is the next smaller one that fits the interval of results a whole number of times.
    pub step: f64,
    /// Interval between results, s.
    pub output: f64,
    /// Whether to integrate the work of the drives and of the dampers along with the motion.
    pub audit: bool,
    /// Greatest size of a coordinate, m or rad, before the run counts as blown up.
    pub bound: f64,
}

impl Settings {
    /// The run that the crane's spec asks for, without audit.
    pub fn of(description: &Description) -> Self {
        let Description { duration, step, output, .. } = *description;
        Self { duration, step, output, audit: false, bound: BOUND }
    }

    /// The step that a run takes, s: the longest that fits the interval of results a whole number of times.
    pub fn step_taken(&self) -> f64 {
        divided(self.output, self.step).1
    }
}

/// One moment of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<'a> {
    /// Time, s.
    pub t: f64,
    /// Generalized coordinates, m and rad.
    pub q: &'a [f64],
    /// Their rates, m/s and rad/s.
    pub v: &'a [f64],
    /// Work that the drives' motions put in since t = 0, J; 0 without audit.
    pub work: f64,
    /// Energy that the dampers took out since t = 0, J; 0 without audit.
    pub dissipated: f64,
}

/// What a run took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Steps done.
    pub steps: usize,
    /// Step, s.
    pub step: f64,
    /// Time reached, s.
    pub time: f64,
}

/// Integrates Eq. (23) from `start` at t = 0 and shows `observe` a sample at t = 0, at every interval and at the end.
/// `observe` may break off the run.
///
/// With `audit`, work W of the drives and dissipated energy D are integrated along with the motion, so that
/// `E(t) − E(0) − W + D`, zero for the exact motion, measures the error of the run.
///
/// # Errors
/// [`Stopped`] where the motion grows beyond the bound or the mass matrix is not positive definite.
pub fn simulate<const N: usize, C: Dynamics<N>>(
    crane: &C,
    start: rk4::State<N>,
    settings: &Settings,
    observe: impl FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    if settings.audit {
        let power = |t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>| {
            Vector2::new(crane.drive_power(t, q, v), crane.dissipation(t, q, v))
        };
        integrate(crane, start, settings, power, |sum| [sum.x, sum.y], observe)
    } else {
        integrate(crane, start, settings, |_, _, _| SVector::<f64, 0>::zeros(), |_| [0.0, 0.0], observe)
    }
}

fn integrate<const N: usize, const M: usize, C: Dynamics<N>>(
    crane: &C,
    start: rk4::State<N>,
    settings: &Settings,
    integrand: impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
    audit: impl Fn(&SVector<f64, M>) -> [f64; 2],
    mut observe: impl FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    let mut state = start;
    let mut roughness = Roughness::new(&crane.mass_matrix(&state.q));
    let mut sum = SVector::<f64, M>::zeros();
    let mut run = Run { steps: 0, step: settings.step_taken(), time: 0.0 };
    let intervals = divided(settings.duration, settings.output).0;

    for interval in 0..=intervals {
        let [work, dissipated] = audit(&sum);
        let sample = Sample { t: run.time, q: state.q.as_slice(), v: state.v.as_slice(), work, dissipated };
        if observe(&sample).is_break() || interval == intervals {
            break;
        }
        let begin = run.time;
        let end = (settings.output * (interval + 1) as f64).min(settings.duration);
        let (steps, h) = divided(end - begin, settings.step);
        for k in 0..steps {
            let t = begin + h * k as f64;
            let v = state.v;
            let step = rk4::advance(crane, t, h, &mut state, &integrand);
            let q = state.q.as_slice();
            let rough = |roughness: &Roughness<N>| {
                roughness.roughest().map(|coordinate| Stopped::rough(coordinate, t, h, q, crane.description()))
            };
            let (acceleration, increments) = step.map_err(|rk4::NotPositiveDefinite| {
                let mass = || Stopped::mass_matrix(t, h, q, &crane.mass_matrix(&state.q), crane.description());
                rough(&roughness).unwrap_or_else(mass)
            })?;
            sum += increments;
            let grows = roughness.grows(&(v + acceleration * h), &state.v);
            // Written so that NaN fails.
            let bounded = state.q.iter().all(|x| x.abs() <= settings.bound);
            if grows || !bounded {
                return Err(rough(&roughness).unwrap_or_else(|| Stopped::growth(t, h, q, crane.description())));
            }
        }
        run.steps += steps;
        run.time = end;
    }
    Ok(run)
}

/// The least whole number of parts of `length`, none longer than `part`, and their length.
pub(super) fn divided(length: f64, part: f64) -> (usize, f64) {
    let count = (length / part * (1.0 - WHOLE)).ceil().max(1.0);
    // Saturates where the ratio is no number.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = count as usize;
    (whole, length / count)
}
