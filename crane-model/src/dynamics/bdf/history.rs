//! The last states at equal time intervals, as backward differences.

use super::ORDER;
use crate::{
    dynamics::motion::add,
    memory::{Visit, visit_count, visit_numbers},
};

const _: () = assert!(ORDER == 4, "one case for each order in `sum` and `push`");

/// Weights of the differences up to the highest order.
pub(super) type Weights = [f64; ORDER + 1];

/// The last states at equal time intervals, as backward differences.
pub(super) struct History {
    /// `∇ᵐy`, m = 0 … k; then `∇ᵏ⁺¹y` and `∇ᵏ⁺²y`, for the error estimates of orders k and k + 1.
    pub differences: [Vec<f64>; ORDER + 3],
    /// k.
    pub order: usize,
    /// Time of the last state, s.
    pub t: f64,
    /// Time interval of the states, s.
    pub h: f64,
    /// Storage for the differences before a change of the interval.
    old: [Vec<f64>; ORDER + 1],
}

impl History {
    /// Storage for motions of this many numbers.
    pub fn new(len: usize) -> Self {
        let differences = std::array::from_fn(|_| vec![0.0; len]);
        Self { differences, order: 1, t: 0.0, h: 0.0, old: std::array::from_fn(|_| vec![0.0; len]) }
    }

    /// Starts with a single state and its slope.
    pub fn begin(&mut self, t: f64, start: &[f64], slope: &[f64], h: f64) {
        (self.order, self.t, self.h) = (1, t, h);
        let [value, first, higher @ ..] = &mut self.differences;
        value.copy_from_slice(start);
        first.fill(0.0);
        add(first, h, slope);
        for difference in higher {
            difference.fill(0.0);
        }
    }

    /// Like [`begin`](Self::begin), with the last state.
    pub fn begin_again(&mut self, slope: &[f64]) {
        let start = std::mem::take(&mut self.differences[0]);
        let [_, first, higher @ ..] = &mut self.differences;
        first.fill(0.0);
        add(first, self.h, slope);
        for difference in higher {
            difference.fill(0.0);
        }
        self.differences[0] = start;
        self.order = 1;
    }

    /// Starts with several states, the most recent first.
    pub fn through(&mut self, past: &[Vec<f64>], t: f64, h: f64) {
        (self.order, self.t, self.h) = (past.len().clamp(1, ORDER), t, h);
        let values = &mut self.differences[..self.order];
        for (value, state) in values.iter_mut().zip(past) {
            value.copy_from_slice(state);
        }
        take_differences(values);
    }

    /// `Σ weight ∇ᵐy`, m = 0 … k.
    pub fn sum(&self, weights: &Weights, out: &mut [f64]) {
        match self.order {
            1 => self.sum_of::<2>(weights, out),
            2 => self.sum_of::<3>(weights, out),
            3 => self.sum_of::<4>(weights, out),
            _ => self.sum_of::<{ ORDER + 1 }>(weights, out),
        }
    }

    /// Of the first differences, in one pass that compiles to vector instructions.
    fn sum_of<const COUNT: usize>(&self, weights: &Weights, out: &mut [f64]) {
        let terms: [&[f64]; COUNT] = std::array::from_fn(|m| &self.differences[m][..out.len()]);
        for (i, out) in out.iter_mut().enumerate() {
            let mut sum = 0.0;
            for (weight, term) in weights.iter().zip(&terms) {
                sum += weight * term[i];
            }
            *out = sum;
        }
    }

    /// Moves to the next state, which differs from its prediction by `d`.
    pub fn push(&mut self, d: &[f64]) {
        self.t += self.h;
        match self.order {
            1 => self.push_to::<1>(d),
            2 => self.push_to::<2>(d),
            3 => self.push_to::<3>(d),
            _ => self.push_to::<ORDER>(d),
        }
    }

    /// Of order K, in one pass.
    fn push_to<const K: usize>(&mut self, d: &[f64]) {
        let (before, next) = self.differences.split_at_mut(K + 2);
        let Some((last, lower)) = before.split_last_mut() else { return };
        let [next, last] = [&mut next[0], last].map(|difference| &mut difference[..d.len()]);
        let mut lower = lower.iter_mut().map(|difference| &mut difference[..d.len()]);
        let mut lower: [&mut [f64]; ORDER + 1] = std::array::from_fn(|_| lower.next().unwrap_or_default());
        for (i, d) in d.iter().enumerate() {
            next[i] = d - last[i];
            last[i] = *d;
            let mut sum = *d;
            for difference in lower[..=K].iter_mut().rev() {
                sum += difference[i];
                difference[i] = sum;
            }
        }
    }

    /// The state at `t`, by the polynomial through the last states.
    pub fn at(&self, t: f64, out: &mut [f64]) {
        self.sum(&newton_polynomials((t - self.t) / self.h), out);
    }

    /// Adds to the last k + 3 states, the most recent first: to all that the differences describe.
    pub fn add_to_states(&mut self, mut additions: Vec<Vec<f64>>) {
        take_differences(&mut additions);
        for (difference, addition) in self.differences.iter_mut().zip(&additions) {
            add(difference, 1.0, addition);
        }
    }

    /// Goes back to a time within the last step: the polynomial stays the same, the states at its new times are new.
    pub fn go_back(&mut self, t: f64) {
        self.take_states((t - self.t) / self.h, 1.0);
        self.t = t;
    }

    /// Changes to another time interval: the states are new, the polynomial stays the same.
    pub fn rescale(&mut self, factor: f64) {
        self.take_states(0.0, factor);
        self.h *= factor;
    }

    /// Takes the polynomial's states at `part, part − factor, part − 2 factor, …` time intervals after the last one.
    fn take_states(&mut self, part: f64, factor: f64) {
        let k = self.order;
        // The polynomial's values at the new times, as weights of the old differences, and the differences of these values.
        let mut weights: [Weights; ORDER + 1] = std::array::from_fn(|m| newton_polynomials(part - factor * m as f64));
        for m in 1..=k {
            for index in (m..=k).rev() {
                weights[index] = std::array::from_fn(|i| weights[index - 1][i] - weights[index][i]);
            }
        }
        for m in 0..=k {
            self.old[m].copy_from_slice(&self.differences[m]);
        }
        for m in 0..=k {
            let difference = &mut self.differences[m];
            difference.fill(0.0);
            for (weight, old) in weights[m][m..=k].iter().zip(&self.old[m..]) {
                if *weight != 0.0 {
                    add(difference, *weight, old);
                }
            }
        }
    }

    /// Visits what further steps depend on.
    pub fn visit(&mut self, visit: Visit<'_>) {
        for difference in &mut self.differences {
            visit_numbers(difference, visit);
        }
        visit_count(&mut self.order, visit);
        self.order = self.order.clamp(1, ORDER);
        [&mut self.t, &mut self.h].into_iter().for_each(visit);
    }
}

/// Replaces states, the most recent first, by their backward differences.
fn take_differences(states: &mut [Vec<f64>]) {
    for m in 1..states.len() {
        for index in (m..states.len()).rev() {
            let (before, at) = states.split_at_mut(index);
            for (at, before) in at[0].iter_mut().zip(&before[index - 1]) {
                *at = before - *at;
            }
        }
    }
}

/// `Πⱼ (part + j)/(j + 1)`, j = 0 … m−1: the factor of `∇ᵐy` at `t + part h`.
fn newton_polynomials(part: f64) -> Weights {
    let mut weights = [1.0; ORDER + 1];
    for m in 1..=ORDER {
        weights[m] = weights[m - 1] * (part + (m - 1) as f64) / m as f64;
    }
    weights
}
