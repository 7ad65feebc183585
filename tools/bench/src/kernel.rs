//! A function of a state, to be timed and to be compared.

use std::hint::black_box;
use std::time::{Duration, Instant};

use crane_model::nalgebra::{Dim, Matrix, Matrix4, RawStorage, SMatrix, SVector};
use crane_model::rt::lanes::f64x8;

/// A function of a state, with the states that it is called on, one after the other: the compiler knows none of them,
/// and no call can reuse results of the previous one.
pub struct Kernel {
    /// What it computes.
    pub name: &'static str,
    /// How many cranes one call serves.
    pub lanes: usize,
    calls: usize,
    work: Box<dyn Work>,
    /// What is compared with other libraries, if they compute something else.
    compared: Option<Box<dyn Work>>,
}

impl Kernel {
    /// `function` writes what it computes at a state into `result`, which is as large as it needs.
    pub fn new<S: Clone + 'static, R: Numbers + 'static>(
        name: &'static str,
        lanes: usize,
        states: &[S],
        result: R,
        function: impl Fn(&S, &mut R) + 'static,
    ) -> Self {
        let work = OnStates { states: states.to_vec(), result, function };
        Self { name, lanes, calls: states.len(), work: Box::new(work), compared: None }
    }

    /// Values of another function are compared with those of other libraries, which do not compute the same.
    #[must_use]
    pub fn compared_by(self, other: Kernel) -> Self {
        Self { compared: Some(other.work), ..self }
    }

    /// What it computes at all states, one after the other.
    pub fn values(&mut self) -> Vec<f64> {
        self.compared.as_mut().unwrap_or(&mut self.work).values()
    }

    /// Time that this many calls take.
    pub fn time(&mut self, calls: u64) -> Duration {
        let passes = calls.div_ceil(self.calls as u64);
        let start = Instant::now();
        for _ in 0..passes {
            self.work.pass();
        }
        start.elapsed().mul_f64(calls as f64 / (passes * self.calls as u64) as f64)
    }

    /// Nanoseconds per call: the median of batches of about a millisecond, as many as fit into `budget`.
    pub fn nanoseconds(&mut self, budget: Duration) -> f64 {
        const BATCH: f64 = 1e-3;
        // Warm-up, and the length of a batch.
        let calls = self.calls as u64;
        let pass = (0..3).map(|_| self.time(calls)).min().unwrap_or_default().as_secs_f64();
        let mut per_batch = calls;
        while pass * (per_batch as f64) < BATCH * calls as f64 && per_batch < u64::MAX / 2 {
            per_batch *= 2;
        }
        let start = Instant::now();
        let mut batches = Vec::new();
        while batches.is_empty() || start.elapsed() < budget {
            batches.push(self.time(per_batch).as_secs_f64() * 1e9 / per_batch as f64);
        }
        batches.sort_by(f64::total_cmp);
        batches[batches.len() / 2]
    }
}

trait Work {
    fn pass(&mut self);
    fn values(&mut self) -> Vec<f64>;
}

struct OnStates<S, R, F> {
    states: Vec<S>,
    result: R,
    function: F,
}

impl<S, R: Numbers, F: Fn(&S, &mut R)> Work for OnStates<S, R, F> {
    fn pass(&mut self) {
        for state in &self.states {
            (self.function)(black_box(state), black_box(&mut self.result));
        }
    }

    fn values(&mut self) -> Vec<f64> {
        let mut numbers = Vec::new();
        for state in &self.states {
            (self.function)(state, &mut self.result);
            self.result.append_to(&mut numbers);
        }
        numbers
    }
}

/// Results of a kernel as plain numbers.
pub trait Numbers {
    /// Appends them; matrices column by column.
    fn append_to(&self, numbers: &mut Vec<f64>);
}

impl<R: Dim, C: Dim, S: RawStorage<f64, R, C>> Numbers for Matrix<f64, R, C, S> {
    fn append_to(&self, numbers: &mut Vec<f64>) {
        numbers.extend(self.iter());
    }
}

/// A symmetric matrix of which only the lower triangle is written.
pub struct Lower<const N: usize>(pub SMatrix<f64, N, N>);

impl<const N: usize> Numbers for Lower<N> {
    fn append_to(&self, numbers: &mut Vec<f64>) {
        let pairs = (0..N).flat_map(|i| (0..N).map(move |j| (i.max(j), i.min(j))));
        numbers.extend(pairs.map(|entry| self.0[entry]));
    }
}

/// Rows of square matrices, one after the other.
#[derive(Clone, Debug)]
pub struct Rows<const N: usize>(pub Vec<[f64; N]>);

impl<const N: usize> Numbers for Rows<N> {
    /// Row by row.
    fn append_to(&self, numbers: &mut Vec<f64>) {
        numbers.extend(self.0.iter().flatten());
    }
}

impl<const N: usize> Numbers for SVector<f64x8, N> {
    /// Crane by crane.
    fn append_to(&self, numbers: &mut Vec<f64>) {
        numbers.extend((0..8).flat_map(|lane| self.iter().map(move |entry| entry.as_array()[lane])));
    }
}

impl Numbers for Vec<Matrix4<f64>> {
    fn append_to(&self, numbers: &mut Vec<f64>) {
        numbers.extend(self.iter().flatten());
    }
}

impl<A: Numbers, B: Numbers> Numbers for (A, B) {
    fn append_to(&self, numbers: &mut Vec<f64>) {
        self.0.append_to(numbers);
        self.1.append_to(numbers);
    }
}
