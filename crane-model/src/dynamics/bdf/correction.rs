//! Newton's iteration for the next state.

use super::{GAMMAS, ORDER, SAME, history::History};
use crate::{
    StateAt,
    dyn_crane::Functions,
    dynamics::{equations::Equations, motion::add, state::NotFinite, system::System},
    memory::{Visit, visit_numbers},
};

/// Distance of a coordinate from the pose of factors up to which they serve again, m or rad: the mass matrix changes by about as large a share, which
/// is how much of an error an iteration leaves.
const NEAR: f64 = 0.015;

/// Newton's iteration for the next state.
pub(super) struct Correction<'a> {
    crane: &'a dyn Functions,
    pub system: System<'a>,
    /// Where the system was factorised.
    factors: FactorisedState,
    /// Time of the next state, s.
    t: f64,
    /// c, s.
    c: f64,
    /// ψ/c.
    past: Vec<f64>,
    /// The current iterate `y⁰ + d`.
    pub end: Vec<f64>,
    /// d.
    pub d: Vec<f64>,
    /// The last increment of the iteration.
    pub improvement: Vec<f64>,
    rate: Vec<f64>,
    rhs: Vec<f64>,
}

/// A motion, given in full, and the c of a step.
struct FactorisedState {
    t: f64,
    motion: Vec<f64>,
    /// NaN if nothing was factorised.
    c: f64,
    /// Whether it was read from a memory: the factors are those of another place.
    is_restored: bool,
}

impl<'a> Correction<'a> {
    /// Storage for motions of this many numbers.
    pub fn new(crane: &'a dyn Functions, len: usize) -> Self {
        let zeros = || vec![0.0; len];
        Self {
            crane,
            system: System::new(crane),
            factors: FactorisedState { t: 0.0, motion: zeros(), c: f64::NAN, is_restored: false },
            t: 0.0,
            c: f64::NAN,
            past: zeros(),
            end: zeros(),
            d: zeros(),
            improvement: zeros(),
            rate: zeros(),
            rhs: zeros(),
        }
    }

    /// Starts with the prediction; returns whether it takes the factors of another state.
    pub fn predict(&mut self, equations: &mut Equations<'_>, history: &History) -> bool {
        history.sum(&[1.0; ORDER + 1], &mut self.end);
        history.sum(&GAMMAS.map(|gamma| gamma / history.h), &mut self.past);
        self.d.fill(0.0);
        self.t = history.t + history.h;
        self.c = history.h / GAMMAS[history.order];
        equations.references.step_within(history.t, self.t);
        let n = equations.n;
        let state = equations.state(self.t, &self.end);
        if std::mem::take(&mut self.factors.is_restored) {
            self.factors.factorise(&mut self.system, n);
        }
        let reuses_factors = self.factors.serve(state.q, self.c) && !self.system.switched(&state);
        if !reuses_factors {
            let FactorisedState { t, motion, c, .. } = &mut self.factors;
            (*t, *c) = (self.t, self.c);
            motion[..n].copy_from_slice(state.q);
            motion[n..2 * n].copy_from_slice(state.v);
            motion[2 * n..].copy_from_slice(state.x);
            self.factors.factorise(&mut self.system, n);
        }
        reuses_factors
    }

    /// Motions and commands change, or the factors are too far away: the next step needs new ones.
    pub fn forget(&mut self) {
        self.system.forget();
        self.factors.c = f64::NAN;
    }

    /// Visits what further steps depend on.
    pub fn visit(&mut self, visit: Visit<'_>) {
        self.system.visit(visit);
        let FactorisedState { t, motion, c, is_restored } = &mut self.factors;
        [t, c].into_iter().for_each(&mut *visit);
        visit_numbers(motion, visit);
        *is_restored = c.is_finite();
    }

    /// One step of the iteration.
    pub fn improve(&mut self, equations: &mut Equations<'_>) -> Result<(), NotFinite> {
        let Self { crane, system, past, end, d, rate, rhs, improvement, .. } = self;
        // (ψ + d)/c
        rate.copy_from_slice(past);
        add(rate, self.c.recip(), d);
        if equations.has_loops() {
            equations.slope(self.t, end, rhs)?;
            add(rhs, -1.0, rate);
            system.solve(rhs, improvement);
        } else {
            equations.shortfall(*crane, self.t, end, rate, rhs)?;
            system.solve_forces(rhs, improvement);
        }
        add(end, 1.0, improvement);
        add(d, 1.0, improvement);
        Ok(())
    }
}

impl FactorisedState {
    /// Whether factors of this place serve for a step with this c that ends at about this pose.
    fn serve(&self, q: &[f64], c: f64) -> bool {
        let is_near = |(q, at): (&f64, &f64)| (q - at).abs() <= NEAR;
        (c - self.c).abs() <= SAME * c && q.iter().zip(&self.motion).all(is_near)
    }

    /// Factorises the system of a crane with n coordinates.
    fn factorise(&self, system: &mut System<'_>, n: usize) {
        system.factorise(&StateAt::from_motion(self.t, n, &self.motion), self.c);
    }
}
