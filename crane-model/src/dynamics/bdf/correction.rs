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

    /// One step of the iteration.
    pub fn improve(&mut self, equations: &mut Equations<'_>) -> Result<(), NotFinite> {
        let Self { past, end, d, rhs, improvement, .. } = self;
        equations.slope(self.t, end, rhs)?;
        // f − (ψ + d)/c
        add(rhs, -1.0, past);
        add(rhs, -self.c.recip(), d);
        self.system.solve(rhs, improvement);
        add(end, 1.0, improvement);
        add(d, 1.0, improvement);
        Ok(())
    }
}
