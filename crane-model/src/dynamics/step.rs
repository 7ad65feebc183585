//! A completed step, and the motion within it.

use super::motion::add;
use crate::memory::{Visit, visit_numbers};

/// A step of an adaptive one-step method.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// Its start, s.
    pub t: f64,
    /// Its length, s.
    pub length: f64,
    /// Motion at the start.
    pub start: Vec<f64>,
    /// Motion at the end.
    pub end: Vec<f64>,
    /// Difference from the embedded formula.
    pub error: Vec<f64>,
    /// Slopes at the start and at the end; the latter is the first of the next step, unless functions of time are not smooth there.
    pub slopes: [Vec<f64>; 2],
    /// The term that a method adds to Hermite's cubic, `θ²(1−θ)² quartic_term`.
    pub quartic_term: Vec<f64>,
}

impl Step {
    /// Storage for motions of this many numbers.
    pub fn new(len: usize) -> Self {
        let zeros = || vec![0.0; len];
        let slopes = [zeros(), zeros()];
        Self { t: 0.0, length: 0.0, start: zeros(), end: zeros(), error: zeros(), slopes, quartic_term: zeros() }
    }

    /// Visits what further steps depend on.
    pub fn visit(&mut self, visit: Visit<'_>) {
        let Self { t, length, start, end, error, slopes: [first, last], quartic_term } = self;
        [t, length].into_iter().for_each(&mut *visit);
        for numbers in [start, end, error, first, last, quartic_term] {
            visit_numbers(numbers, visit);
        }
    }

    /// Time at the end, s.
    pub fn reached(&self) -> f64 {
        self.t + self.length
    }

    /// The end of this step is the start of the next.
    pub fn proceed(&mut self) {
        self.t = self.reached();
        std::mem::swap(&mut self.start, &mut self.end);
        let [first, last] = &mut self.slopes;
        std::mem::swap(first, last);
    }

    /// Motion at a time within the step: Hermite's cubic through values and slopes at both ends, and the quartic term.
    ///
    /// The error of the cubic is at most `h⁴/384` times the fourth derivative: sufficient for methods of order 4.
    pub fn at(&self, t: f64, motion: &mut [f64]) {
        let theta = if self.length > 0.0 { (t - self.t) / self.length } else { 1.0 };
        let rest = 1.0 - theta;
        let [first, last] = &self.slopes;
        let of_end = theta * theta * (1.0 + 2.0 * rest);
        motion.copy_from_slice(&self.start);
        add(motion, -of_end, &self.start);
        add(motion, of_end, &self.end);
        add(motion, theta * rest * rest * self.length, first);
        add(motion, -theta * theta * rest * self.length, last);
        add(motion, theta * theta * rest * rest, &self.quartic_term);
    }

    /// Rate of one of `n` coordinates at a time within the step, as the slope of its cubic.
    ///
    /// The acceleration of a stiff spring is not used: its damper would magnify the error at the ends.
    pub fn rate_at(&self, t: f64, n: usize, coordinate: usize) -> f64 {
        let [start, end] = [&self.start, &self.end].map(|motion| motion[coordinate]);
        let rates = [&self.start, &self.end].map(|motion| motion[n + coordinate]);
        if self.length <= 0.0 {
            return rates[1];
        }
        let theta = (t - self.t) / self.length;
        6.0 * theta * (1.0 - theta) * (end - start) / self.length
            + (1.0 - 4.0 * theta + 3.0 * theta * theta) * rates[0]
            + (3.0 * theta * theta - 2.0 * theta) * rates[1]
    }

    /// The transpose of [`at`](Self::at), for methods without a quartic term: adds the weights of the start and the end, and of the slopes there.
    pub fn pull_back(&self, t: f64, weights: &[f64], [start, end]: [&mut [f64]; 2], [first, last]: [&mut [f64]; 2]) {
        let theta = if self.length > 0.0 { (t - self.t) / self.length } else { 1.0 };
        let rest = 1.0 - theta;
        let of_end = theta * theta * (1.0 + 2.0 * rest);
        add(start, 1.0 - of_end, weights);
        add(end, of_end, weights);
        add(first, theta * rest * rest * self.length, weights);
        add(last, -theta * theta * rest * self.length, weights);
    }

    /// The transpose of [`rate_at`](Self::rate_at).
    pub fn pull_back_rate(&self, t: f64, n: usize, coordinate: usize, weight: f64, [start, end]: [&mut [f64]; 2]) {
        if self.length <= 0.0 {
            end[n + coordinate] += weight;
            return;
        }
        let theta = (t - self.t) / self.length;
        let of_change = 6.0 * theta * (1.0 - theta) / self.length * weight;
        start[coordinate] -= of_change;
        end[coordinate] += of_change;
        start[n + coordinate] += (1.0 - 4.0 * theta + 3.0 * theta * theta) * weight;
        end[n + coordinate] += (3.0 * theta * theta - 2.0 * theta) * weight;
    }
}
