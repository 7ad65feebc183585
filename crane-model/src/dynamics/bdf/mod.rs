//! Backward differentiation formulas of variable order and step, for stiff motions.
//!
//! With `∇yₙ = yₙ − yₙ₋₁` and `∇ᵐ = ∇∇ᵐ⁻¹` the formula of order k for `ẏ = f(t, y)` is `Σ ∇ᵐyₙ₊₁/m = h f(tₙ₊₁, yₙ₊₁)`, m = 1 … k.
//! From the prediction `y⁰ = Σ ∇ᵐyₙ`, m = 0 … k, by the polynomial through the previous states, the unknown is `d = yₙ₊₁ − y⁰ = ∇ᵏ⁺¹yₙ₊₁`:
//!
//! ```text
//! c f(tₙ₊₁, y⁰ + d) = ψ + d,     c = h/γₖ,     γₖ = Σ 1/j  (j = 1 … k),     γₖ ψ = Σ γₘ ∇ᵐyₙ  (m = 1 … k)
//! ```
//!
//! Newton's iteration uses stiffness and damping of springs and dampers as its Jacobian: one structured system of half the size, of which the
//! right-hand side needs the forces that a motion lacks instead of its accelerations. The neglected terms are `c²` times the square of the
//! load's swing frequency, so usually the first iterate suffices and a step costs one evaluation. The error of a step is `d/(k+1)`; those of the neighbouring orders are available as well, and the order with
//! the longest step is chosen; where it is hardly longer, the length stays. As long as the length and the pose stay about the same, so do the
//! factors of the system. Orders 1 and 2 are L-stable, order 3 is A(α)-stable with α = 86.0°, order 4 with 73.4°: for modes
//! with little damping that are not resolved, the error estimate selects the lower orders.
//!
//! E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, sections III.1 and V.1; steps of equal length between
//! changes, and how differences change with it: L. F. Shampine, M. W. Reichelt, The MATLAB ODE Suite, SIAM J. Sci. Comput. 18 (1997) 1.

mod change;
mod correction;
mod history;

use super::{
    Ahead, Cause, EffortAccuracy, Method, Settings, Statistics, Steered, Stepper, Stopped,
    adaptive::{FIRST, LEAST, LONGEST, SLIVER},
    equations::Equations,
    norm::Norm,
    references::References,
    state::{NotFinite, State},
    stopped::StepContext,
    switches::{Switches, Watched},
    typed::{motion_of, state_of},
};
use crate::memory::{visit_count, visit_flag, visit_numbers, visit_optional};
use crate::{
    CraneModel, Part,
    dyn_crane::{Functions, Instance},
    loop_joints::Open,
};
use correction::Correction;
use history::History;

/// Highest order.
pub const ORDER: usize = Method::Bdf.order();
/// γₖ.
const GAMMAS: [f64; ORDER + 1] = [0.0, 1.0, 1.5, 11.0 / 6.0, 25.0 / 12.0];
/// Allowed error of a step relative to the tolerance: errors add up over many steps, which are shorter than those of one-step methods.
const SHARE: f64 = 0.1;
/// Maximum number of Newton steps.
const MAX_NEWTON_STEPS: usize = 4;
/// Error that Newton's iteration may leave, relative to the allowed error of a step.
const NEWTON_ERROR: f64 = 0.1;
/// Safety factor on the step at which the error would equal the tolerance: with 0.9 three times as many steps fail, which cost more than they gain.
const SAFETY: f64 = 0.8;
/// Smallest and largest ratio of a step to the previous one.
const RATIO: (f64, f64) = (0.2, 3.0);
/// Smallest ratio by which a step is lengthened: steps of the same length share factors.
const WORTHWHILE: f64 = 1.3;
/// Largest ratio of a step to the previous one after repeated failure.
const RATIO_AFTER_FAILURE: f64 = 0.5;
/// Relative change of the length of a step below which the differences of higher order stay valid.
const SAME: f64 = 1e-9;
/// After this many consecutive failures, the history is discarded: it does not predict the motion, for example because a drive jumped.
const PATIENCE: usize = 3;

/// A step of order `past.len()` from `t` to `t + h`, from the states at `t`, `t − h`, …: the state at `t + h`, by Newton's iteration to
/// rounding accuracy.
///
/// Of more states than the highest order, only the most recent are used.
///
/// # Errors
/// An acceleration is not finite, or the iteration does not converge.
pub fn step<const N: usize, C: CraneModel<N>>(
    crane: &C,
    t: f64,
    h: f64,
    past: &[State<N>],
) -> Result<State<N>, NotFinite> {
    /// Maximum number of Newton steps: even with a poor Jacobian, each one gains a digit.
    const MANY: usize = 30;
    /// Allowed last increment, relative to 1 m or rad plus the size of the new state.
    const EXACT: f64 = 1e-14;
    const { Part::Dynamics.require(C::PARTS) }
    let crane = Instance::<N, _>(crane.clone());
    let mut equations = Equations::new(&crane, References::new(&crane));
    if equations.states() > 0 || equations.has_loops() {
        return Err(NotFinite);
    }
    let mut history = History::new(2 * N);
    let mut past: Vec<_> = past.iter().map(motion_of).collect();
    for (k, motion) in past.iter_mut().enumerate() {
        equations.make_relative(t - h * k as f64, motion);
    }
    history.through(&past, t, h);
    let mut correction = Correction::new(&crane, 2 * N);
    correction.predict(&mut equations, &history);
    let norm = Norm::new(N, EXACT);
    let origin = vec![0.0; 2 * N];
    for _ in 0..MANY {
        correction.improve(&mut equations)?;
        let scale = 1.0 + EXACT * norm.size(&origin, &correction.end);
        if norm.size(&correction.end, &correction.improvement) < scale {
            equations.make_absolute(t + h, &mut correction.end);
            return Ok(state_of(&correction.end));
        }
    }
    Err(NotFinite)
}

/// Convergence rate of Newton's iteration, measured whenever there was a second step.
#[derive(Clone, Copy, Debug)]
struct Contraction {
    /// Ratio of two successive increments.
    ratio: f64,
    /// Length of the time step of the measurement, s.
    h: f64,
    /// Time steps since then.
    age: usize,
}

impl Contraction {
    /// Number of time steps for which a measurement is valid.
    const LIFETIME: usize = 30;
    /// Assumed ratio without a measurement.
    const UNKNOWN: f64 = 0.3;
    /// A measured ratio may be wrong by this factor.
    const CAUTION: f64 = 3.0;
    /// Lower limit of ratios.
    const LEAST: f64 = 1e-3;

    /// The expected ratio for a time step of length `h`: the terms neglected in the Jacobian are proportional to its square.
    fn expected(&self, h: f64) -> f64 {
        if self.age < Self::LIFETIME {
            (Self::CAUTION * self.ratio * (h / self.h).powi(2)).max(Self::LEAST)
        } else {
            Self::UNKNOWN
        }
    }
}

/// A motion by backward differences; steps may pass the times of results, which are interpolated.
pub struct Bdf<'a> {
    equations: Equations<'a>,
    crane: &'a dyn Functions,
    history: History,
    correction: Correction<'a>,
    control: Control,
    slope: Vec<f64>,
    switches: Switches,
    /// Length of the next step, s, if the last one ended where a law changes its branch: the history does not predict the motion beyond.
    restart: Option<f64>,
    /// A loop that the last step left open.
    open: Option<Open>,
    /// Whether what follows is changed between steps, which then end where it changes: their lengths differ only by rounding.
    is_steered: bool,
    /// Motion at the time reached.
    motion: Vec<f64>,
    steps: usize,
    rejections: usize,
}

/// Outcome of a tried step.
enum Attempt {
    /// It is accepted: it meets the tolerance, and no contact changes in it.
    Accepted,
    /// It does not, or a contact changes in it; `change`: the time at which a law changes its branch, s, if one was found.
    Repeated { change: Option<f64> },
}

/// Choice of order and length.
struct Control {
    /// The measure of errors.
    norm: Norm,
    /// Steps since order or length changed.
    steps_since_change: usize,
    contraction: Contraction,
}

impl<'a> Bdf<'a> {
    /// Creates the motion, with the tolerance of the settings.
    pub fn new(crane: &'a dyn Functions, settings: &Settings) -> Self {
        let equations = Equations::new(crane, References::new(crane));
        let norm = Norm::with_efforts(crane, &equations.references, SHARE * settings.tolerance);
        let len = equations.len();
        let contraction = Contraction { ratio: 1.0, h: 1.0, age: Contraction::LIFETIME };
        Self {
            equations,
            crane,
            history: History::new(len),
            correction: Correction::new(crane, len),
            control: Control { norm, steps_since_change: 0, contraction },
            slope: vec![0.0; len],
            switches: Switches::new(crane, len),
            restart: None,
            open: None,
            is_steered: false,
            motion: vec![0.0; len],
            steps: 0,
            rejections: 0,
        }
    }

    /// The error that no further step is possible from the last state.
    fn stuck(&self) -> Stopped {
        self.context().failed(Cause::Tolerance, self.crane)
    }

    fn context(&self) -> StepContext<'_> {
        let History { t, h, .. } = &self.history;
        let q = &self.motion[..self.equations.n];
        StepContext { method: Method::Bdf, t: *t, h: *h, q, description: self.crane.description() }
    }

    /// Shortens the interval of the states so that a whole number of steps ends at `stop`, if it is close.
    fn fit_to_stop(&mut self, stop: f64) {
        let History { t, h, .. } = self.history;
        let left = (stop - t) / h;
        if left <= 2.0 {
            let steps = if left <= 1.0 + SLIVER { 1.0 } else { 2.0 };
            if left != steps {
                self.history.rescale(left / steps);
                if !self.is_steered || (left - steps).abs() > SAME * steps {
                    self.control.steps_since_change = 0;
                }
            }
        }
    }

    /// Moves to the new state.
    fn accept(&mut self) {
        let n = self.equations.n;
        self.motion.copy_from_slice(&self.history.differences[0]);
        self.equations.make_absolute(self.history.t, &mut self.motion);
        let (q, v) = self.motion[..2 * n].split_at(n);
        self.control.norm.note_state(self.crane, self.history.t, q, v);
    }

    /// Continues from the last state as if there was nothing before it.
    fn begin_again(&mut self) -> Result<(), Stopped> {
        let History { t, h, differences: [last, ..], .. } = &self.history;
        self.equations.references.step_within(*t, t + h);
        let slope = self.equations.slope(*t, last, &mut self.slope);
        slope.map_err(|NotFinite| self.stuck())?;
        self.history.begin_again(&self.slope);
        self.control.steps_since_change = 0;
        Ok(())
    }

    /// Tries a step, and chooses order and length of the next, unless the step only has to end where a contact changes. `again`: the step
    /// has been shortened already; `repeats`: how often it was repeated to end where a law changes.
    fn attempt(&mut self, again: bool, repeats: usize) -> Attempt {
        let Self { equations, history, correction, control, switches, slope, open, .. } = self;
        let order = history.order;
        let reuses_factors = correction.predict(equations, history);
        let mut error = control.solve(equations, history, correction);
        if error.is_infinite() && reuses_factors {
            correction.forget();
            correction.predict(equations, history);
            error = control.solve(equations, history, correction);
        }
        let watched = if error > 1.0 { Watched::All } else { Watched::Contacts };
        let span = [history.t, history.t + history.h];
        let mut find = || switches.find_change(equations, watched, span, &|t, motion| history.at(t, motion));
        let change = if repeats < Switches::REPEATS { find() } else { None };
        let ratio = if error > 1.0 {
            ideal(error, order).clamp(RATIO.0, if again { RATIO_AFTER_FAILURE } else { 1.0 })
        } else if change.is_some() {
            return Attempt::Repeated { change };
        } else {
            let reached = history.t + history.h;
            match equations.project_end(reached, &mut correction.end, slope) {
                Ok(true) => correction.d.iter_mut().zip(&*slope).for_each(|(d, moved)| *d += *moved),
                Ok(false) => {}
                Err(gap) => *open = Some(gap),
            }
            history.push(&correction.d);
            control.norm.note(&correction.end, &correction.d);
            control.steps_since_change += 1;
            control.contraction.age += 1;
            if control.steps_since_change <= order {
                return Attempt::Accepted;
            }
            let orders = (order.max(2) - 1..=(order + 1).min(ORDER)).map(|order| {
                let error = match order {
                    _ if order == history.order => error,
                    _ => control.error(&correction.end, &history.differences[order + 1], order),
                };
                (ideal(error, order), order)
            });
            let ratio;
            (ratio, history.order) = orders.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((1.0, order));
            if history.order == order && (1.0..WORTHWHILE).contains(&ratio) {
                return Attempt::Accepted;
            }
            ratio.min(RATIO.1).min(LONGEST / history.h)
        };
        history.rescale(ratio);
        control.steps_since_change = 0;
        if error <= 1.0 { Attempt::Accepted } else { Attempt::Repeated { change } }
    }
}

impl Stepper for Bdf<'_> {
    fn start(&mut self, t: f64, motion: &[f64]) -> Result<(), Stopped> {
        self.motion.copy_from_slice(motion);
        self.switches.start();
        let mut start = motion.to_vec();
        self.equations.make_relative(t, &mut start);
        self.control.norm.start(&mut self.equations, t, &start);
        self.equations.references.step_within(t, t + FIRST);
        let slope = self.equations.slope(t, &start, &mut self.slope);
        self.history.begin(t, &start, &self.slope, FIRST);
        (self.control.steps_since_change, self.restart) = (0, None);
        slope.map_err(|NotFinite| self.stuck())
    }

    fn step(&mut self, ahead: &Ahead) -> Result<f64, Stopped> {
        let (mut failures, mut repeats) = (0, 0);
        if let Some(h) = self.restart.take() {
            self.history.rescale(h / self.history.h);
            self.begin_again()?;
        }
        self.fit_to_stop(ahead.stop);
        while let Attempt::Repeated { change } = self.attempt(failures > 0, repeats) {
            self.rejections += 1;
            failures += 1;
            if self.history.h < LEAST * ahead.result {
                return Err(self.stuck());
            }
            if failures % PATIENCE == 0 {
                self.begin_again()?;
            }
            let History { t, h, .. } = self.history;
            self.restart = change.map(|_| h);
            repeats += usize::from(change.is_some());
            match change {
                Some(change) => {
                    self.history.rescale((change - t) / h);
                    self.control.steps_since_change = 0;
                }
                None => self.fit_to_stop(ahead.stop),
            }
        }
        self.steps += 1;
        if (ahead.stop - self.history.t).abs() < 10.0 * LEAST * ahead.stop {
            self.history.t = ahead.stop;
        }
        self.accept();
        match self.open.take() {
            Some(open) => Err(self.context().opened(self.crane, open)),
            None => Ok(self.history.t),
        }
    }

    fn motion(&self) -> &[f64] {
        &self.motion
    }

    fn interpolate(&mut self, t: f64, motion: &mut [f64]) {
        self.history.at(t, motion);
        self.equations.make_absolute(t, motion);
    }

    fn statistics(&self) -> Statistics {
        Statistics {
            steps: self.steps,
            rejections: self.rejections,
            evaluations: self.equations.evaluations,
            factorisations: self.correction.system.factorisations,
        }
    }

    fn efforts(&self) -> Vec<EffortAccuracy> {
        self.control.norm.efforts().collect()
    }
}

impl Steered for Bdf<'_> {
    fn change(&mut self, t: f64, change: &mut dyn FnMut()) -> Result<(), Stopped> {
        self.go_on_after(t, change)
    }

    fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.equations.visit(visit);
        self.history.visit(visit);
        self.correction.visit(visit);
        let Control { norm, steps_since_change, contraction } = &mut self.control;
        norm.visit(visit);
        [&mut contraction.ratio, &mut contraction.h].into_iter().for_each(&mut *visit);
        self.switches.visit(visit);
        visit_optional(&mut self.restart, visit);
        visit_flag(&mut self.is_steered, visit);
        visit_numbers(&mut self.motion, visit);
        for count in [steps_since_change, &mut contraction.age, &mut self.steps, &mut self.rejections] {
            visit_count(count, visit);
        }
    }
}

impl Control {
    /// Newton's iteration for the end of the next step: the error of this step, infinite if the iteration does not converge. It ends early if the
    /// error is too large whatever else it finds.
    fn solve(&mut self, equations: &mut Equations<'_>, history: &History, correction: &mut Correction<'_>) -> f64 {
        let History { h, order, .. } = *history;
        let mut before = None;
        for _ in 0..MAX_NEWTON_STEPS {
            let Ok(()) = correction.improve(equations) else { return f64::INFINITY };
            let size = self.norm.size(&correction.end, &correction.improvement);
            let ratio = before.map_or(self.contraction.expected(h), |before| size / before);
            if before.is_some() {
                self.contraction = Contraction { ratio, h, age: 0 };
            }
            let error = match before {
                // d is the first increment.
                None => size / (order + 1) as f64,
                Some(_) => self.error(&correction.end, &correction.d, order),
            };
            if ratio * size < NEWTON_ERROR || error > 1.0 + ratio * size / (order + 1) as f64 {
                return error;
            }
            if !size.is_finite() || before.is_some() && ratio >= 1.0 {
                return f64::INFINITY;
            }
            before = Some(size);
        }
        f64::INFINITY
    }

    /// Error of a step of order k that ends at `end`, with `∇ᵏ⁺¹y` in `next`, in units of the allowed error.
    fn error(&self, end: &[f64], next: &[f64], order: usize) -> f64 {
        self.norm.size(end, next) / (order + 1) as f64
    }
}

/// Ratio of the step that would just meet the tolerance to the current one, with a safety margin.
fn ideal(error: f64, order: usize) -> f64 {
    SAFETY * error.powf(-1.0 / (order + 1) as f64)
}
