//! Steps as long as a tolerance allows.

use nalgebra::SVector;

use super::{
    Method, Settings, Statistics, Stopped, dormand_prince,
    motion::{Motion, slope},
    rk4::NotFinite,
    rosenbrock,
};
use crate::{Dynamics, Implicit};

/// First step tried, s: a crane starts gently, and steps may grow threefold.
const FIRST: f64 = 1e-4;
/// Part of the step at which the error would just be the tolerance.
const SAFETY: f64 = 0.9;
/// Least and greatest ratio of a step to the one before.
const RATIO: (f64, f64) = (0.2, 3.0);
/// A step as short as this, of the time simulated, goes nowhere.
const LEAST: f64 = 1e-13;

/// A motion that proceeds in steps of its own length.
pub(super) struct Adaptive<const N: usize, const M: usize> {
    method: Method,
    tolerance: f64,
    /// Step to try next, s.
    step: f64,
    /// A step that ends beyond the last result, its beginning, s.
    beyond: Option<(f64, dormand_prince::Step<N, M>)>,
    /// Slope at the end of the last step.
    slope: Option<Motion<N, M>>,
}

impl<const N: usize, const M: usize> Adaptive<N, M> {
    /// With the method and tolerance of the settings.
    pub fn new(settings: &Settings) -> Self {
        let Settings { method, tolerance, .. } = *settings;
        Self { method, tolerance, step: FIRST, beyond: None, slope: None }
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
        let stopped = |t, h, motion: &Motion<N, M>| {
            Stopped::tolerance(t, h, motion.q.as_slice(), &crane.mass_matrix(&motion.q), crane.description())
        };
        match self.method {
            Method::DormandPrince => self.explicit(crane, integrand, [begin, end], motion, statistics, stopped),
            _ => self.implicit(crane, integrand, [begin, end], motion, statistics, stopped),
        }
    }

    /// Steps that end at `end`.
    fn implicit<C: Implicit<N>>(
        &mut self,
        crane: &C,
        integrand: &impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
        [begin, end]: [f64; 2],
        motion: &mut Motion<N, M>,
        statistics: &mut Statistics,
        stopped: impl Fn(f64, f64, &Motion<N, M>) -> Stopped,
    ) -> Result<(), Stopped> {
        let mut t = begin;
        while t < end {
            // As many equal steps as it takes to the end.
            let left = ((end - t) / self.step * (1.0 - LEAST)).ceil().max(1.0);
            let h = (end - t) / left;
            let tried = rosenbrock::advance(crane, t, h, motion, integrand);
            statistics.evaluations += rosenbrock::STAGES;
            statistics.factorisations += 1;
            if let Some(next) = self.judge(h, tried, statistics) {
                *motion = next;
                t = if left == 1.0 { end } else { t + h };
            } else if self.step < LEAST * end {
                return Err(stopped(t, h, motion));
            }
        }
        Ok(())
    }

    /// Steps that go beyond `end`, and the motion there by interpolation.
    fn explicit<C: Dynamics<N>>(
        &mut self,
        crane: &C,
        integrand: &impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
        [begin, end]: [f64; 2],
        motion: &mut Motion<N, M>,
        statistics: &mut Statistics,
        stopped: impl Fn(f64, f64, &Motion<N, M>) -> Stopped,
    ) -> Result<(), Stopped> {
        loop {
            let (t, start) = match &self.beyond {
                Some((from, step)) if from + step.length >= end => {
                    *motion = step.at((end - from) / step.length);
                    return Ok(());
                }
                Some((from, step)) => (from + step.length, step.end),
                None => (begin, *motion),
            };
            let mut h = self.step;
            let step = loop {
                let first = match self.slope {
                    Some(first) => Ok(first),
                    None => slope(crane, integrand, t, &start),
                };
                let tried = first.and_then(|first| {
                    self.slope = Some(first);
                    let step = dormand_prince::advance(crane, t, h, &start, &first, integrand)?;
                    Ok((step, step.end, step.error))
                });
                statistics.evaluations += dormand_prince::EVALUATIONS;
                let whole = tried.as_ref().ok().map(|(step, ..)| *step);
                let judged = self.judge(h, tried.map(|(_, end, error)| (end, error)), statistics);
                if let (Some(step), Some(_)) = (whole, judged) {
                    break step;
                }
                h = self.step;
                if h < LEAST * end {
                    return Err(stopped(t, h, &start));
                }
            };
            self.slope = Some(step.last_slope());
            self.beyond = Some((t, step));
        }
    }

    /// The end of a step, where it meets the tolerance; the step to try next in any case.
    fn judge(
        &mut self,
        h: f64,
        tried: Result<(Motion<N, M>, Motion<N, M>), NotFinite>,
        statistics: &mut Statistics,
    ) -> Option<Motion<N, M>> {
        let error = tried.as_ref().map_or(f64::INFINITY, |(end, error)| end.size(error, self.tolerance));
        let ideal = SAFETY * error.powf(-1.0 / self.method.order() as f64);
        if error <= 1.0 {
            // The step may have been cut to meet a result: the one that was meant must not be forgotten.
            self.step = (h * ideal.clamp(RATIO.0, RATIO.1)).max(self.step.min(h * ideal));
            statistics.steps += 1;
            tried.ok().map(|(end, _)| end)
        } else {
            self.step = h * ideal.clamp(RATIO.0, 1.0);
            statistics.rejections += 1;
            None
        }
    }
}
