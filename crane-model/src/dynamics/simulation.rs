//! A run over time, with results at their own interval.

use std::ops::ControlFlow;

use nalgebra::{Cholesky, SVector, Vector2};

use super::{
    Method, Stopped, adaptive::Adaptive, bdf::Backward, dormand_prince, motion::Motion, rk4, rosenbrock,
    roughness::Roughness,
};
use crate::{Description, Dynamics, Implicit};

/// No crane is 1 km long and no joint of one turns 160 times: beyond this, m or rad, a run has blown up.
const BOUND: f64 = 1e3;
/// Whole numbers of steps are recognised to this relative accuracy: 0.01/1e-4 is not 100 in binary.
const WHOLE: f64 = 1e-9;
/// What keeps the load path of the reference crane within 1e-4 of its size, which engineers do not see: a tenth of a millimetre a
/// metre. Measured: docs/error-vs-runtime.md.
const TOLERANCE: f64 = 5e-5;

/// How to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Simulated time, s.
    pub duration: f64,
    /// Method of integration.
    pub method: Method,
    /// Greatest step of a method with constant step, s. The step is the next smaller one that fits the interval of results a
    /// whole number of times.
    pub step: f64,
    /// Error that a one-step adaptive method allows a step, m and rad; `bdf` allows a tenth of it, as its errors add up over more
    /// steps. That of a run on the reference crane's coordinates is ten times as large, on a path of 10 m.
    pub tolerance: f64,
    /// Interval between results, s.
    pub output: f64,
    /// Whether to integrate the work of the drives and of the dampers along with the motion.
    pub audit: bool,
    /// Greatest size of a coordinate, m or rad, before the run counts as blown up.
    pub bound: f64,
}

impl Settings {
    /// The run that the crane's spec asks for, by the classical Runge–Kutta method, without audit.
    pub fn of(description: &Description) -> Self {
        let Description { duration, step, output, .. } = *description;
        Self { duration, method: Method::Rk4, step, tolerance: TOLERANCE, output, audit: false, bound: BOUND }
    }

    /// Number and length, s, of the intervals between results.
    pub fn intervals(&self) -> (usize, f64) {
        let count = divided(self.duration, self.output).0;
        (count, self.duration / count as f64)
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

/// What a run did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Steps done.
    pub steps: usize,
    /// Steps tried in vain: their error was above the tolerance.
    pub rejections: usize,
    /// Evaluations of the accelerations.
    pub evaluations: usize,
    /// Factorisations of the system of an implicit step.
    pub factorisations: usize,
}

impl Statistics {
    /// Counts what an adaptive method spends on a step, done or in vain.
    pub(super) fn count(&mut self, method: Method) {
        let (evaluations, factorisations) = match method {
            Method::DormandPrince => (dormand_prince::EVALUATIONS, 0),
            _ => (rosenbrock::STAGES, 1),
        };
        self.evaluations += evaluations;
        self.factorisations += factorisations;
    }
}

/// What a run took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// What it did.
    pub statistics: Statistics,
    /// Step, s; the mean of an adaptive method.
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
/// [`Stopped`] where the motion grows from step to step or beyond the bound, where no step meets the tolerance, or where the
/// mass matrix is not positive definite.
pub fn simulate<const N: usize, C: Implicit<N>>(
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

fn integrate<const N: usize, const M: usize, C: Implicit<N>>(
    crane: &C,
    start: rk4::State<N>,
    settings: &Settings,
    integrand: impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
    audit: impl Fn(&SVector<f64, M>) -> [f64; 2],
    mut observe: impl FnMut(&Sample<'_>) -> ControlFlow<()>,
) -> Result<Run, Stopped> {
    let mut motion = Motion::<N, M>::starting(&start);
    let mass = crane.mass_matrix(&motion.q);
    // The recursion of O(n) divides by inertias one by one and would go on with negative ones.
    if N > 0 && Cholesky::new(mass).is_none() {
        return Err(Stopped::mass_matrix(0.0, settings.step, motion.q.as_slice(), &mass, crane.description()));
    }
    let mut roughness = Roughness::new(&mass);
    let mut adaptive = Adaptive::new(settings);
    let mut backward = Backward::new(settings);
    let mut statistics = Statistics::default();
    let mut time = 0.0;
    let intervals = divided(settings.duration, settings.output).0;

    for interval in 0..=intervals {
        let [work, dissipated] = audit(&motion.sum);
        let sample = Sample { t: time, q: motion.q.as_slice(), v: motion.v.as_slice(), work, dissipated };
        if observe(&sample).is_break() || interval == intervals {
            break;
        }
        let end = (settings.output * (interval + 1) as f64).min(settings.duration);
        if settings.method.is_adaptive() {
            match settings.method {
                Method::Bdf => backward.advance(crane, &integrand, [time, end], &mut motion, &mut statistics)?,
                _ => adaptive.advance(crane, &integrand, [time, end], &mut motion, &mut statistics)?,
            }
            if !bounded(&motion, settings) {
                return Err(Stopped::growth(end, settings.output, motion.q.as_slice(), crane.description()));
            }
        } else {
            let (steps, h) = divided(end - time, settings.step);
            for k in 0..steps {
                let t = time + h * k as f64;
                constant(crane, &integrand, [t, h], &mut motion, &mut roughness, settings)?;
            }
            statistics.steps += steps;
            statistics.evaluations += rk4::STAGES * steps;
        }
        time = end;
    }
    let step = match (settings.method.is_adaptive(), statistics.steps) {
        (true, 1..) => time / statistics.steps as f64,
        _ => settings.step_taken(),
    };
    Ok(Run { statistics, step, time })
}

/// A step of the classical Runge–Kutta method from `t` to `t + h`.
fn constant<const N: usize, const M: usize, C: Dynamics<N>>(
    crane: &C,
    integrand: &impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
    [t, h]: [f64; 2],
    motion: &mut Motion<N, M>,
    roughness: &mut Roughness<N>,
    settings: &Settings,
) -> Result<(), Stopped> {
    let mut state = rk4::State { q: motion.q, v: motion.v };
    let step = rk4::advance(crane, t, h, &mut state, integrand);
    let rough = |roughness: &Roughness<N>| {
        let stopped = |coordinate| Stopped::rough(coordinate, t, h, state.q.as_slice(), crane.description());
        roughness.roughest().map(stopped)
    };
    let (acceleration, increments) = step.map_err(|rk4::NotFinite| {
        let mass = || Stopped::mass_matrix(t, h, state.q.as_slice(), &crane.mass_matrix(&state.q), crane.description());
        rough(roughness).unwrap_or_else(mass)
    })?;
    let grows = roughness.grows(&(motion.v + acceleration * h), &state.v);
    *motion = Motion { q: state.q, v: state.v, sum: motion.sum + increments };
    if grows || !bounded(motion, settings) {
        let growth = || Stopped::growth(t, h, state.q.as_slice(), crane.description());
        return Err(rough(roughness).unwrap_or_else(growth));
    }
    Ok(())
}

/// Whether all coordinates are within bounds, and numbers.
fn bounded<const N: usize, const M: usize>(motion: &Motion<N, M>, settings: &Settings) -> bool {
    motion.q.iter().all(|x| x.abs() <= settings.bound)
}

/// The least whole number of parts of `length`, none longer than `part`, and their length.
pub(super) fn divided(length: f64, part: f64) -> (usize, f64) {
    let count = (length / part * (1.0 - WHOLE)).ceil().max(1.0);
    // Saturates where the ratio is no number.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = count as usize;
    (whole, length / count)
}
