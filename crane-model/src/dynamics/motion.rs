//! Pose, rates and integrals in one vector, and their slopes.

use nalgebra::SVector;

use super::rk4::{NotFinite, State, acceleration};
use crate::Dynamics;

/// Pose q, rates v and `M` integrals along the motion; or their slopes v, q̈ and the integrands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Motion<const N: usize, const M: usize> {
    /// Coordinates, or rates.
    pub q: SVector<f64, N>,
    /// Rates, or accelerations.
    pub v: SVector<f64, N>,
    /// Integrals, or integrands.
    pub sum: SVector<f64, M>,
}

impl<const N: usize, const M: usize> Motion<N, M> {
    /// A state with integrals at zero.
    pub fn starting(state: &State<N>) -> Self {
        Self { q: state.q, v: state.v, sum: SVector::zeros() }
    }

    /// Nothing.
    pub fn zeros() -> Self {
        Self { q: SVector::zeros(), v: SVector::zeros(), sum: SVector::zeros() }
    }

    /// `self + scale Σ factor · term`.
    #[inline]
    pub fn plus(mut self, factors: &[f64], terms: &[Self], scale: f64) -> Self {
        for (factor, term) in factors.iter().zip(terms) {
            let factor = factor * scale;
            if factor != 0.0 {
                self.add(factor, term);
            }
        }
        self
    }

    /// `self += factor · term`
    #[inline]
    pub fn add(&mut self, factor: f64, term: &Self) {
        add(&mut self.q, factor, &term.q);
        add(&mut self.v, factor, &term.v);
        add(&mut self.sum, factor, &term.sum);
    }

    /// Error of a step that ends here, in units of the tolerance: the greatest of `|δq|/tolerance`, in m and rad, and
    /// `|δv|/(1 + |v|)` times [`RATE`] over the tolerance; infinite where one is no number.
    pub fn size(&self, error: &Self, tolerance: f64) -> f64 {
        /// Comparisons at once, so that they become vector instructions.
        const LANES: usize = 8;
        let mut greatest = [0.0_f64; LANES];
        let mut finite = [true; LANES];
        let mut note = |lane: usize, size: f64| {
            greatest[lane] = if size > greatest[lane] { size } else { greatest[lane] };
            finite[lane] &= size < f64::INFINITY;
        };
        let columns = |x: &SVector<f64, N>| x.data.0[0];
        let (q, v, rates) = (columns(&error.q), columns(&error.v), columns(&self.v));
        for i in 0..N {
            note(i % LANES, q[i].abs());
        }
        for i in 0..N {
            note(i % LANES, v[i].abs() * RATE / (1.0 + rates[i].abs()));
        }
        let greatest = greatest.into_iter().fold(0.0, f64::max);
        if finite.into_iter().all(|finite| finite) { greatest / tolerance } else { f64::INFINITY }
    }
}

/// What an error of a rate counts against one of its coordinate, s: 1/ω of the slow swinging of a load, about 5 rad/s.
const RATE: f64 = 0.2;

/// Slopes of a motion by the crane's equations and of the integrals.
pub(super) fn slope<const N: usize, const M: usize, C: Dynamics<N>>(
    crane: &C,
    integrand: &impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
    t: f64,
    motion: &Motion<N, M>,
) -> Result<Motion<N, M>, NotFinite> {
    let Motion { q, v, .. } = motion;
    Ok(Motion { q: *v, v: acceleration(crane, t, q, v)?, sum: integrand(t, q, v) })
}

/// `y += a x`, in a plain loop that becomes vector instructions.
#[inline]
fn add<const N: usize>(y: &mut SVector<f64, N>, a: f64, x: &SVector<f64, N>) {
    for (y, x) in y.data.0[0].iter_mut().zip(&x.data.0[0]) {
        *y += a * x;
    }
}
