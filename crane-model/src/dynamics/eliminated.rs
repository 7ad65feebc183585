//! What forces with states of their own add to the linear system of an implicit step, once those states are eliminated.
//!
//! With `U` the rows ∂ℓ/∂q of the forces, c the length of the implicit part of the step, g the rates of the states x and
//! `W = (I/c − ∂g/∂x)⁻¹`:
//!
//! ```text
//! κ = F_ℓ + F_x W g_ℓ,     δ = F_ℓ̇ + F_x W g_ℓ̇,     S = −(c δ + c² κ)
//! (M + Uᵀ S U) z = … + c² Uᵀ (δ U G + κ U (c G + P) + F_x W R/c)
//! ```
//!
//! with the right-hand side R of the states. By Woodbury's identity it takes one solution of M for each force. Cylinders act on each other
//! through the pump.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::{
    dyn_crane::DynModel,
    own_states::{Moment, OwnStates, Pushed},
};

/// The forces of a crane with states at one of its states, and their part in the system there.
pub(crate) struct Eliminated {
    own: OwnStates,
    rates: Vec<f64>,
    by_states: DMatrix<f64>,
    /// W, as factors of its inverse.
    states: Option<LU<f64, Dyn, Dyn>>,
    kappa: DMatrix<f64>,
    delta: DMatrix<f64>,
    resistance: DMatrix<f64>,
    /// M⁻¹ Uᵀ, force by force.
    answers: Vec<Vec<f64>>,
    /// I + S U M⁻¹ Uᵀ.
    correction: Option<LU<f64, Dyn, Dyn>>,
    unit: Vec<f64>,
}

impl Eliminated {
    /// Storage for the forces of a crane.
    pub fn new(crane: &dyn DynModel) -> Self {
        let own = OwnStates::new(crane.description());
        let n = crane.description().coordinates.len();
        let (count, len) = (own.count(), own.len());
        let square = |size| DMatrix::zeros(size, size);
        Self {
            rates: vec![0.0; len],
            by_states: square(len),
            states: None,
            kappa: square(count),
            delta: square(count),
            resistance: square(count),
            answers: vec![vec![0.0; n]; count],
            correction: None,
            unit: vec![0.0; n],
            own,
        }
    }

    /// Takes the forces at a state, and prepares solutions; `solve` solves the system without them.
    pub fn factorise(
        &mut self,
        crane: &dyn DynModel,
        moment: &Moment<'_>,
        c: f64,
        solve: &mut dyn FnMut(&[f64], &mut [f64]),
    ) {
        let Self { own, rates, by_states, .. } = self;
        if own.is_empty() {
            return;
        }
        own.evaluate(crane, moment, rates, Some(by_states));
        let pushed = own.pushed();
        let len = rates.len();
        let states = (DMatrix::identity(len, len) / c - &*by_states).lu();
        let count = pushed.len();
        for (column, own) in pushed.iter().enumerate() {
            for (matrix, rates) in [(&mut self.kappa, own.rates_by_length), (&mut self.delta, own.rates_by_speed)] {
                let mut answer = DVector::zeros(len);
                answer.rows_mut(own.first, own.count).copy_from_slice(&rates[..own.count]);
                states.solve_mut(&mut answer);
                for (row, other) in pushed.iter().enumerate() {
                    matrix[(row, column)] = other.pull(answer.as_slice());
                }
            }
            self.kappa[(column, column)] += own.by_length;
            self.delta[(column, column)] += own.by_speed;
        }
        self.resistance = -(&self.delta * c + &self.kappa * (c * c));
        for (own, answer) in pushed.iter().zip(&mut self.answers) {
            self.unit.fill(0.0);
            self.unit[own.coordinate] = own.arm;
            solve(&self.unit, answer);
        }
        let along = DMatrix::from_fn(count, count, |row, column| pushed[row].along(&self.answers[column]));
        self.correction = Some((DMatrix::identity(count, count) + &self.resistance * along).lu());
        self.states = Some(states);
    }

    /// Adds `−δ U G − κ U (c G + P) − F_x W R/c`.
    pub fn add_to(&self, (g, p): (&[f64], &[f64]), r: &[f64], c: f64, right: &mut [f64]) {
        let Some(states) = &self.states else { return };
        let mut of_states = DVector::from_column_slice(r);
        states.solve_mut(&mut of_states);
        let of = |x: &[f64]| DVector::from_iterator(self.own.count(), self.own.pushed().iter().map(|own| own.along(x)));
        let (g, p) = (of(g), of(p));
        let forces = &self.delta * &g + &self.kappa * (g * c + p);
        for (own, force) in self.own.pushed().iter().zip(&forces) {
            let force = force + own.pull(of_states.as_slice()) / c;
            right[own.coordinate] -= own.arm * force;
        }
    }

    /// Turns the solution of the system without these forces into that of the system with them.
    pub fn correct(&self, solution: &mut [f64]) {
        let Some(correction) = &self.correction else { return };
        let along = DVector::from_iterator(self.own.count(), self.own.pushed().iter().map(|own| own.along(solution)));
        let mut shares = &self.resistance * along;
        correction.solve_mut(&mut shares);
        for (answer, share) in self.answers.iter().zip(&shares) {
            for (x, answer) in solution.iter_mut().zip(answer) {
                *x -= share * answer;
            }
        }
    }

    /// The increments of the states, `W (R + g_ℓ U p + g_ℓ̇ U w)`, with those of pose and rates.
    pub fn states(&self, (p, w): (&[f64], &[f64]), r: &[f64], out: &mut [f64]) {
        let Some(states) = &self.states else { return };
        let mut answer = DVector::from_column_slice(r);
        for own in self.own.pushed() {
            let part = &mut answer.as_mut_slice()[own.first..own.first + own.count];
            let (p, w) = (own.along(p), own.along(w));
            for (i, x) in part.iter_mut().enumerate() {
                *x += own.rates_by_length[i] * p + own.rates_by_speed[i] * w;
            }
        }
        states.solve_mut(&mut answer);
        out.copy_from_slice(answer.as_slice());
    }
}

impl Pushed {
    /// J x
    fn along(&self, x: &[f64]) -> f64 {
        self.arm * x[self.coordinate]
    }

    /// `F_x x`
    fn pull(&self, x: &[f64]) -> f64 {
        let own = &x[self.first..self.first + self.count];
        self.by_states.iter().zip(own).map(|(slope, x)| slope * x).sum()
    }
}
