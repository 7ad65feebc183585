//! Backward differentiation formulas of variable order and step, for stiff motions.
//!
//! With `∇yₙ = yₙ − yₙ₋₁` and `∇ᵐ = ∇∇ᵐ⁻¹` the formula of order k for `ẏ = f(t, y)` is `Σ ∇ᵐyₙ₊₁/m = h f(tₙ₊₁, yₙ₊₁)`, m = 1 … k.
//! From the prediction `y⁰ = Σ ∇ᵐyₙ`, m = 0 … k, by the polynomial through the states before, it leaves `d = yₙ₊₁ − y⁰ = ∇ᵏ⁺¹yₙ₊₁`
//! to find:
//!
//! ```text
//! c f(tₙ₊₁, y⁰ + d) = ψ + d,     c = h/γₖ,     γₖ = Σ 1/j  (j = 1 … k),     γₖ ψ = Σ γₘ ∇ᵐyₙ  (m = 1 … k)
//! ```
//!
//! Newton's iteration takes stiffness and damping of springs and dampers as Jacobian, one structured system of half the size. What
//! that leaves out is worth `c²` times the square of a load's swinging, so that as a rule the first iterate will do: a step then
//! costs one evaluation. The error of a step is `d/(k+1)`; those of the neighbouring orders are at hand as well, and the order is
//! taken that allows the longest step. Orders 1 and 2 are L-stable, order 3 is A(α)-stable with α = 86.0°, order 4 with 73.4°:
//! modes that are hardly damped and not resolved are left to the lower ones, by the estimate of the error.
//!
//! E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, sections III.1 and V.1; steps of equal length between
//! changes, and how differences change with it: L. F. Shampine, M. W. Reichelt, The MATLAB ODE Suite, SIAM J. Sci. Comput. 18 (1997) 1.

use nalgebra::SVector;

use super::{
    Settings, Statistics, Stopped,
    adaptive::{FIRST, LEAST, LONGEST, SAFETY},
    motion::{Motion, slope},
    rk4::{NotFinite, State, acceleration},
    system::System,
};
use crate::Implicit;

/// Highest order.
pub const ORDER: usize = 4;
/// γₖ.
const GAMMAS: [f64; ORDER + 1] = [0.0, 1.0, 1.5, 11.0 / 6.0, 25.0 / 12.0];
/// Part of the tolerance that a step may be off: errors add up over many steps, which are shorter than those of one-step methods.
const SHARE: f64 = 0.1;
/// Most of Newton's steps.
const NEWTON: usize = 4;
/// Part of a step's error that Newton's iteration may leave.
const LEFT: f64 = 0.05;
/// Least and greatest ratio of a step to the one before.
const RATIO: (f64, f64) = (0.2, 3.0);
/// Greatest ratio of a step to one that fell short of what it was chosen for.
const AGAIN: f64 = 0.5;
/// After so many failures in a row the past tells nothing of what comes: a drive that jumped, say.
const PATIENCE: usize = 3;

/// A step of order `past.len()` from `t` to `t + h`, from the states at `t`, `t − h`, …: the state at `t + h`, by Newton's iteration
/// to the last bits. No allocation.
///
/// Of more states than the highest order only the last count.
///
/// # Errors
/// An acceleration is not finite, or the iteration does not converge.
pub fn step<const N: usize, C: Implicit<N>>(
    crane: &C,
    t: f64,
    h: f64,
    past: &[State<N>],
) -> Result<State<N>, NotFinite> {
    /// Newton's steps: with a Jacobian that has little to do with the crane each still gains a digit.
    const MANY: usize = 30;
    /// What is left of a step, relative to 1 m and rad and to where it leads.
    const EXACT: f64 = 1e-14;
    let history = History::through(past, t, h);
    let mut correction = Correction::new(crane, &history);
    for _ in 0..MANY {
        let improvement = correction.improve(crane)?;
        let size = 1.0 + Motion::zeros().size(&correction.end, 1.0);
        if correction.end.size(&improvement, EXACT * size) < 1.0 {
            return Ok(State { q: correction.end.q, v: correction.end.v });
        }
    }
    Err(NotFinite)
}

/// The last states at equal distances, as backward differences.
#[derive(Clone, Copy, Debug)]
struct History<const N: usize, const M: usize> {
    /// `∇ᵐy`, m = 0 … k; beyond, what tells the error of the next higher order.
    differences: [Motion<N, M>; ORDER + 3],
    /// k.
    order: usize,
    /// Time of the last state, s.
    t: f64,
    /// Distance of the states, s.
    h: f64,
}

/// Weights of the differences up to the highest order.
type Weights = [f64; ORDER + 1];

impl<const N: usize, const M: usize> History<N, M> {
    /// A state alone, and its slope.
    fn starting(t: f64, start: Motion<N, M>, slope: &Motion<N, M>, h: f64) -> Self {
        let mut differences = [Motion::zeros(); ORDER + 3];
        differences[0] = start;
        differences[1].add(h, slope);
        Self { differences, order: 1, t, h }
    }

    /// `Σ weight ∇ᵐy`, m = 0 … k.
    fn sum(&self, weights: &Weights) -> Motion<N, M> {
        Motion::zeros().plus(&weights[..=self.order], &self.differences, 1.0)
    }

    /// Goes on to the next state, which is `d` from its prediction.
    fn push(&mut self, d: &Motion<N, M>) {
        let k = self.order;
        self.t += self.h;
        let [before, next] = &mut self.differences[k + 1..=k + 2] else { unreachable!("order {k}") };
        *next = *d;
        next.add(-1.0, before);
        *before = *d;
        for m in (0..=k).rev() {
            let (lower, higher) = self.differences.split_at_mut(m + 1);
            lower[m].add(1.0, &higher[0]);
        }
    }

    /// The state at `t`, by the polynomial through the last states.
    fn at(&self, t: f64) -> Motion<N, M> {
        self.sum(&newton_polynomials((t - self.t) / self.h))
    }

    /// Goes over to states at another distance, on the same polynomial.
    fn rescale(&mut self, factor: f64) {
        // The polynomial's values at the new distances, by the weights of the old differences, and differences of those.
        let mut weights: [Weights; ORDER + 1] = std::array::from_fn(|m| newton_polynomials(-factor * m as f64));
        difference(&mut weights[..=self.order], |before, at| std::array::from_fn(|m| before[m] - at[m]));
        let old = self.differences;
        for (m, weights) in weights[..=self.order].iter().enumerate().skip(1) {
            self.differences[m] = Motion::zeros().plus(&weights[m..=self.order], &old[m..], 1.0);
        }
        self.h *= factor;
    }
}

/// `Πⱼ (part + j)/(j + 1)`, j = 0 … m−1: what multiplies `∇ᵐy` at `t + part h`.
fn newton_polynomials(part: f64) -> Weights {
    let mut weights = [1.0; ORDER + 1];
    for m in 1..=ORDER {
        weights[m] = weights[m - 1] * (part + (m - 1) as f64) / m as f64;
    }
    weights
}

impl<const N: usize> History<N, 0> {
    /// Through some states, the last first.
    fn through(past: &[State<N>], t: f64, h: f64) -> Self {
        let mut differences = [Motion::zeros(); ORDER + 3];
        let order = past.len().clamp(1, ORDER);
        let values = &mut differences[..order];
        for (value, state) in values.iter_mut().zip(past) {
            *value = Motion::starting(state);
        }
        difference(values, |before, at| before.plus(&[-1.0], &[*at], 1.0));
        Self { differences, order, t, h }
    }
}

/// Turns values, the last first, into their backward differences; `minus` subtracts the second from the first.
fn difference<T>(values: &mut [T], minus: impl Fn(&T, &T) -> T) {
    for m in 1..values.len() {
        for place in (m..values.len()).rev() {
            values[place] = minus(&values[place - 1], &values[place]);
        }
    }
}

/// Newton's iteration for the next state.
struct Correction<const N: usize, const M: usize, C: Implicit<N>> {
    system: System<N, C>,
    /// Time of the next state, s.
    t: f64,
    /// c, s.
    c: f64,
    /// ψ/c.
    past: Motion<N, M>,
    /// `y⁰ + d` as far as the iteration is.
    end: Motion<N, M>,
    /// d.
    d: Motion<N, M>,
}

impl<const N: usize, const M: usize, C: Implicit<N>> Correction<N, M, C> {
    /// From the prediction on.
    fn new(crane: &C, history: &History<N, M>) -> Self {
        let end = history.sum(&[1.0; ORDER + 1]);
        let c = history.h / GAMMAS[history.order];
        let past = history.sum(&GAMMAS.map(|gamma| gamma / history.h));
        let system = System::new(crane, &end.q, c);
        Self { system, t: history.t + history.h, c, past, end, d: Motion::zeros() }
    }

    /// One step of the iteration, and what it adds. Integrals wait for its end.
    fn improve(&mut self, crane: &C) -> Result<Motion<N, M>, NotFinite> {
        let Motion { q, v, .. } = &self.end;
        // f − (ψ + d)/c
        let mut rhs = Motion { q: *v, v: acceleration(crane, self.t, q, v)?, sum: self.past.sum };
        rhs.add(-1.0, &self.past);
        rhs.add(-self.c.recip(), &self.d);
        let improvement = self.system.solve(crane, &rhs, &SVector::zeros());
        self.end.add(1.0, &improvement);
        self.d.add(1.0, &improvement);
        Ok(improvement)
    }

    /// Integrals over the step, of what the state found says: at its prediction stiff springs are far from balance.
    fn integrate(&mut self, integrand: &impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>) {
        self.d.sum = (integrand(self.t, &self.end.q, &self.end.v) - self.past.sum) * self.c;
        self.end.sum += self.d.sum;
    }
}

/// How fast Newton's iteration converges, as measured when there was a second step.
#[derive(Clone, Copy, Debug)]
struct Contraction {
    /// Ratio of two steps.
    ratio: f64,
    /// Length of the step of time that it holds for, s.
    h: f64,
    /// Steps of time since.
    age: usize,
}

impl Contraction {
    /// Steps of time for which a measurement holds.
    const LIFETIME: usize = 10;
    /// What is assumed without one.
    const UNKNOWN: f64 = 0.3;
    /// A measured ratio is trusted up to this factor.
    const CAUTION: f64 = 3.0;
    /// No ratio counts as less.
    const LEAST: f64 = 1e-3;

    /// What to expect of a step of time of length `h`: what the Jacobian leaves out counts with its square.
    fn expected(&self, h: f64) -> f64 {
        if self.age < Self::LIFETIME {
            (Self::CAUTION * self.ratio * (h / self.h).powi(2)).max(Self::LEAST)
        } else {
            Self::UNKNOWN
        }
    }
}

/// A motion that proceeds by backward differences; steps go beyond the results, which are interpolated.
pub(super) struct Backward<const N: usize, const M: usize> {
    /// The states up to the time reached.
    history: Option<History<N, M>>,
    control: Control,
}

/// Choice of order and length.
struct Control {
    /// What a step may be off.
    tolerance: f64,
    /// Steps since order or length changed.
    alike: usize,
    contraction: Contraction,
}

impl<const N: usize, const M: usize> Backward<N, M> {
    /// With the tolerance of the settings.
    pub fn new(settings: &Settings) -> Self {
        let contraction = Contraction { ratio: 1.0, h: 1.0, age: Contraction::LIFETIME };
        Self { history: None, control: Control { tolerance: SHARE * settings.tolerance, alike: 0, contraction } }
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
        let stopped = |t: f64, h: f64, start: &Motion<N, M>| {
            Stopped::tolerance(t, h, start.q.as_slice(), &crane.mass_matrix(&start.q), crane.description())
        };
        let start = |t: f64, start: &Motion<N, M>, h: f64, statistics: &mut Statistics| {
            statistics.evaluations += 1;
            let slope = slope(crane, integrand, t, start).map_err(|NotFinite| stopped(t, h, start))?;
            Ok(History::starting(t, *start, &slope, h))
        };
        if self.history.is_none() {
            self.history = Some(start(begin, motion, FIRST, statistics)?);
        }
        let Some(history) = &mut self.history else { return Ok(()) };
        while history.t < end {
            let mut failures = 0;
            while !self.control.step(crane, integrand, history, failures > 0, statistics) {
                statistics.rejections += 1;
                failures += 1;
                let History { t, h, differences: [last, ..], .. } = history;
                if *h < LEAST * end {
                    return Err(stopped(*t, *h, last));
                }
                if failures % PATIENCE == 0 {
                    *history = start(*t, last, *h, statistics)?;
                }
            }
            statistics.steps += 1;
        }
        *motion = history.at(end);
        Ok(())
    }
}

impl Control {
    /// Tries a step, and tells whether it meets the tolerance; chooses order and length of the next in any case. `again` is a step
    /// that was shortened already.
    fn step<const N: usize, const M: usize, C: Implicit<N>>(
        &mut self,
        crane: &C,
        integrand: &impl Fn(f64, &SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, M>,
        history: &mut History<N, M>,
        again: bool,
        statistics: &mut Statistics,
    ) -> bool {
        let order = history.order;
        let mut correction = Correction::new(crane, history);
        statistics.factorisations += 1;
        let error = if self.converges(crane, history.h, &mut correction, statistics) {
            correction.integrate(integrand);
            self.error(&correction.end, &correction.d, order)
        } else {
            f64::INFINITY
        };
        let ratio = if error > 1.0 {
            ideal(error, order).clamp(RATIO.0, if again { AGAIN } else { 1.0 })
        } else {
            history.push(&correction.d);
            self.alike += 1;
            self.contraction.age += 1;
            if self.alike <= order {
                return true;
            }
            let orders = (order.max(2) - 1..=(order + 1).min(ORDER)).map(|order| {
                let error = self.error(&correction.end, &history.differences[order + 1], order);
                (ideal(error, order), order)
            });
            let ratio;
            (ratio, history.order) = orders.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((1.0, order));
            ratio.min(RATIO.1).min(LONGEST / history.h)
        };
        history.rescale(ratio);
        self.alike = 0;
        error <= 1.0
    }

    /// Whether Newton's iteration finds the end of a step of length `h`.
    fn converges<const N: usize, const M: usize, C: Implicit<N>>(
        &mut self,
        crane: &C,
        h: f64,
        correction: &mut Correction<N, M, C>,
        statistics: &mut Statistics,
    ) -> bool {
        let mut before = None;
        for _ in 0..NEWTON {
            statistics.evaluations += 1;
            let Ok(improvement) = correction.improve(crane) else { return false };
            let size = correction.end.size(&improvement, self.tolerance);
            let ratio = before.map_or(self.contraction.expected(h), |before| size / before);
            if before.is_some() {
                self.contraction = Contraction { ratio, h, age: 0 };
            }
            if ratio * size < LEFT {
                return true;
            }
            if !size.is_finite() || before.is_some() && ratio >= 1.0 {
                return false;
            }
            before = Some(size);
        }
        false
    }

    /// Error of a step of some order to `end`, with `∇ᵏ⁺¹` of that order, in units of what a step is allowed.
    fn error<const N: usize, const M: usize>(&self, end: &Motion<N, M>, next: &Motion<N, M>, order: usize) -> f64 {
        end.size(next, self.tolerance) / (order + 1) as f64
    }
}

/// Ratio of steps that would just meet the tolerance, less a margin.
fn ideal(error: f64, order: usize) -> f64 {
    SAFETY * error.powf(-1.0 / (order + 1) as f64)
}
