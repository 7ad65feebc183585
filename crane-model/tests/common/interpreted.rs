//! A crane of a spec's text, run by the interpreter of the compiler: no rustc.

use crane_codegen::{
    SourceFile,
    chain::{Analyses, Chain},
    compile, mechanics,
    symbolic::{Inputs, Program},
};
use crane_model::{CraneModel, Description, Dynamics, Linearisation, Linearise, ParameterError, modes::SmallMotions};
use nalgebra::{DVector, Matrix4, SMatrix, SVector};

use crate::common::description;

static DESCRIPTION: Description = description("interpreted", &[], &[]);

/// A crane of `N` coordinates.
pub struct Interpreted<const N: usize> {
    chain: Chain,
    program: Program,
}

impl<const N: usize> Interpreted<N> {
    /// The crane of a text, which must have `N` coordinates.
    pub fn new(text: &str) -> Self {
        let chain = compile::load(&SourceFile::new("spec", text)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        assert_eq!(chain.coordinates.len(), N);
        let program = mechanics::derive(&chain, Analyses::ALL);
        Self { chain, program }
    }

    /// The equilibrium, by plain Newton steps from the spec's guess.
    pub fn equilibrium(&self) -> SVector<f64, N> {
        let mut q = SVector::from_column_slice(&self.chain.guess);
        // Sound guesses need 5; more change nothing.
        for _ in 0..10 {
            let rest = SVector::zeros();
            let force = self.bias(&q, &rest) + self.forces(0.0, &q, &rest);
            let stiffness = SmallMotions::from(&self.linearise(&q)).stiffness;
            let step = stiffness.lu().solve(&DVector::from_column_slice(force.as_slice()));
            q += SVector::from_column_slice(step.expect("a regular stiffness").as_slice());
        }
        q
    }

    /// A function's slots.
    fn slots(&self, function: &str, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Vec<f64> {
        let function = self.program.function(function).expect("a function of every crane");
        let (q, v) = (q.as_slice().to_vec(), v.as_slice().to_vec());
        self.program.evaluate(function, &Inputs::state(t, q, v, self.chain.parameter_defaults()))
    }
}

/// A matrix of its upper triangle, row by row.
fn symmetric<const N: usize>(upper: &[f64]) -> SMatrix<f64, N, N> {
    let slot = |row: usize, column: usize| row * N - row * (row + 1) / 2 + column;
    SMatrix::from_fn(|i, j| upper[slot(i.min(j), i.max(j))])
}

impl<const N: usize> CraneModel<N> for Interpreted<N> {
    fn description(&self) -> &Description {
        &DESCRIPTION
    }

    fn parameter(&self, _: usize) -> f64 {
        f64::NAN
    }

    fn set_parameter(&mut self, _: usize, _: f64) -> Result<(), ParameterError> {
        Ok(())
    }

    fn transforms(&self, _: &SVector<f64, N>, _: &mut [Matrix4<f64>]) {}

    fn forces(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_vec(self.slots("forces", t, q, v))
    }

    fn gravity_energy(&self, q: &SVector<f64, N>) -> f64 {
        self.slots("gravity_energy", 0.0, q, &SVector::zeros())[0]
    }
}

impl<const N: usize> Dynamics<N> for Interpreted<N> {
    fn mass_matrix(&self, q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        symmetric(&self.slots("mass_matrix", 0.0, q, &SVector::zeros()))
    }

    fn bias(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_vec(self.slots("bias", 0.0, q, v))
    }

    fn kinetic_energy(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.slots("kinetic_energy", 0.0, q, v)[0]
    }
}

impl<const N: usize> Linearise<N> for Interpreted<N> {
    fn linearise(&self, q: &SVector<f64, N>) -> Linearisation<N> {
        let slots = self.slots("linearise", 0.0, q, &SVector::zeros());
        let size = N * (N + 1) / 2;
        let [mass, stiffness, damping] = [0, 1, 2].map(|k| symmetric(&slots[k * size..(k + 1) * size]));
        Linearisation { mass, stiffness, damping }
    }
}
