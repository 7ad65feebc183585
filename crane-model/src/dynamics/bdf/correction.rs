//! Newton's iteration for the next state.

use super::{GAMMAS, ORDER, history::History};
use crate::{
    dyn_crane::DynImplicit,
    dynamics::{equations::Equations, motion::add, state::NotFinite, system::System},
};

/// Newton's iteration for the next state.
pub(super) struct Correction<'a> {
    pub system: System<'a>,
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
    rhs: Vec<f64>,
}

impl<'a> Correction<'a> {
    /// Storage for motions of this many numbers.
    pub fn new(crane: &'a dyn DynImplicit, len: usize) -> Self {
        let zeros = || vec![0.0; len];
        Self {
            system: System::new(crane),
            t: 0.0,
            c: f64::NAN,
            past: zeros(),
            end: zeros(),
            d: zeros(),
            improvement: zeros(),
            rhs: zeros(),
        }
    }

    /// Starts with the prediction.
    pub fn predict(&mut self, equations: &mut Equations<'_>, history: &History) {
        history.sum(&[1.0; ORDER + 1], &mut self.end);
        history.sum(&GAMMAS.map(|gamma| gamma / history.h), &mut self.past);
        self.d.fill(0.0);
        self.t = history.t + history.h;
        self.c = history.h / GAMMAS[history.order];
        equations.references.step_within(history.t, self.t);
        let x = equations.force_states(&self.end);
        self.system.factorise(self.t, equations.state(self.t, &self.end), x, self.c);
    }

    /// One step of the iteration, without the integrals: [`integrate`](Self::integrate) follows at its end.
    pub fn improve(&mut self, equations: &mut Equations<'_>) -> Result<(), NotFinite> {
        let Self { past, end, d, rhs, improvement, .. } = self;
        let integrals = equations.integrals();
        equations.derivative(self.t, end, rhs)?;
        // f − (ψ + d)/c; zero for integrals.
        add(&mut rhs[..integrals], -1.0, past);
        add(&mut rhs[..integrals], -self.c.recip(), d);
        rhs[integrals..].fill(0.0);
        self.system.solve(rhs, improvement);
        add(end, 1.0, improvement);
        add(d, 1.0, improvement);
        Ok(())
    }

    /// Computes the integrals over the step from the converged state: at the prediction, stiff springs are far from equilibrium.
    pub fn integrate(&mut self, equations: &mut Equations<'_>) {
        equations.powers(self.t, &self.end, &mut self.rhs);
        for i in equations.integrals()..self.end.len() {
            self.d[i] = (self.rhs[i] - self.past[i]) * self.c;
            self.end[i] += self.d[i];
        }
    }
}
