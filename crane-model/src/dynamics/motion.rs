//! Sums of motions, and how large an error of one is.

/// `y += a x`, in a plain loop that becomes vector instructions.
#[inline]
pub(super) fn add(y: &mut [f64], a: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

/// `y += scale Σ factor · term`
#[inline]
pub(super) fn add_all<'a>(y: &mut [f64], scale: f64, factors: &[f64], terms: impl IntoIterator<Item = &'a Vec<f64>>) {
    for (factor, term) in factors.iter().zip(terms) {
        let factor = factor * scale;
        if factor != 0.0 {
            add(y, factor, term);
        }
    }
}

/// What an error of a rate counts against one of its coordinate, s: 1/ω of the slow swinging of a load, about 5 rad/s.
const RATE: f64 = 0.2;

/// Size of an error of a motion of `n` coordinates: the greatest of `|δq|`, in m and rad, and `|δv|/(1 + |v|)` times [`RATE`];
/// infinite where one is not a number.
pub(super) fn size(n: usize, motion: &[f64], error: &[f64]) -> f64 {
    let mut greatest = Greatest::default();
    for error in &error[..n] {
        greatest.note(error.abs());
    }
    for (error, rate) in error[n..2 * n].iter().zip(&motion[n..2 * n]) {
        greatest.note(error.abs() * RATE / (1.0 + rate.abs()));
    }
    greatest.value()
}

/// The greatest of some sizes; several comparisons at once become vector instructions.
#[derive(Clone, Copy, Debug)]
struct Greatest {
    lanes: [f64; Greatest::LANES],
    finite: [bool; Greatest::LANES],
    next: usize,
}

impl Default for Greatest {
    fn default() -> Self {
        Self { lanes: [0.0; Self::LANES], finite: [true; Self::LANES], next: 0 }
    }
}

impl Greatest {
    const LANES: usize = 8;

    #[inline]
    fn note(&mut self, size: f64) {
        let lane = self.next % Self::LANES;
        self.next += 1;
        self.lanes[lane] = if size > self.lanes[lane] { size } else { self.lanes[lane] };
        self.finite[lane] &= size < f64::INFINITY;
    }

    fn value(&self) -> f64 {
        let greatest = self.lanes.into_iter().fold(0.0, f64::max);
        if self.finite.into_iter().all(|finite| finite) { greatest } else { f64::INFINITY }
    }
}
