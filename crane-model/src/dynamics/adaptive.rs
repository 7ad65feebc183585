//! Steps as long as a tolerance allows.

use nalgebra::SVector;

use super::{
    Method, Settings, Statistics, Stopped, dormand_prince,
    motion::{Motion, slope},
    rk4::NotFinite,
    rosenbrock,
    step::Step,
};
use crate::Implicit;

/// First step tried, s: a crane starts gently, and steps may grow threefold.
pub(super) const FIRST: f64 = 1e-4;
/// Longest step, s: an implicit method at rest would step over a motion of its drives. So a stage falls into each that takes
/// 25 ms, and a load that swings once a second has ten steps for it anyway.
pub(super) const LONGEST: f64 = 0.1;
/// Part of the step at which the error would just be the tolerance.
pub(super) const SAFETY: f64 = 0.9;
/// Least and greatest ratio of a step to the one before.
const RATIO: (f64, f64) = (0.2, 3.0);
/// A step as short as this, of the time simulated, goes nowhere.
pub(super) const LEAST: f64 = 1e-13;

/// A motion that proceeds in steps of its own length: they go beyond the results, which are interpolated.
pub(super) struct Adaptive<const N: usize, const M: usize> {
    method: Method,
    tolerance: f64,
    /// Step to try next, s.
    next: f64,
    /// The last step, and its beginning, s.
    last: Option<(f64, Step<N, M>)>,
}

impl<const N: usize, const M: usize> Adaptive<N, M> {
    /// With the method and tolerance of the settings.
    pub fn new(settings: &Settings) -> Self {
        let Settings { method, tolerance, .. } = *settings;
        Self { method, tolerance, next: FIRST, last: None }
    }

    /// Moves `motion` from `begin` to `end`, s.
    pub fn advance<C: Implicit<N>>(
        &mut self,
        crane: &C,
        integrand: &impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
        [begin, end]: [f64; 2],
        motion: &mut Motion<N, M>,
        statistics: &mut Statistics,
    ) -> Result<(), Stopped> {
        loop {
            let (t, start, first) = match &self.last {
                Some((from, step)) if from + step.length >= end => {
                    *motion = step.at((end - from) / step.length);
                    return Ok(());
                }
                Some((from, step)) => (from + step.length, step.end, Ok(step.slopes[1])),
                None => {
                    statistics.evaluations += 1;
                    (begin, *motion, slope(crane, integrand, begin, motion))
                }
            };
            let step = loop {
                let h = self.next;
                if h < LEAST * end {
                    let mass = crane.mass_matrix(&start.q);
                    return Err(Stopped::tolerance(t, h, start.q.as_slice(), &mass, crane.description()));
                }
                let tried = first.and_then(|first| match self.method {
                    Method::DormandPrince => dormand_prince::advance(crane, t, h, &start, &first, integrand),
                    _ => rosenbrock::advance(crane, t, h, &start, &first, integrand),
                });
                statistics.count(self.method);
                match self.judge(h, tried) {
                    Some(step) => break step,
                    None => statistics.rejections += 1,
                }
            };
            statistics.steps += 1;
            self.last = Some((t, step));
        }
    }

    /// A step of length `h`, where it meets the tolerance; the length to try next in any case.
    fn judge(&mut self, h: f64, tried: Result<Step<N, M>, NotFinite>) -> Option<Step<N, M>> {
        let error = tried.as_ref().map_or(f64::INFINITY, |step| step.end.size(&step.error, self.tolerance));
        let ideal = SAFETY * error.powf(-1.0 / self.method.order() as f64);
        let meets = error <= 1.0;
        self.next = (h * ideal.clamp(RATIO.0, if meets { RATIO.1 } else { 1.0 })).min(LONGEST);
        tried.ok().filter(|_| meets)
    }
}
