//! Functions of a crane on numbers with slopes.

use std::collections::BTreeMap;

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::Arguments;

use crate::Evaluation;
use crate::LiveCrane;
use crate::dual::Dual8;
use crate::machine::Number;

/// The functions of a crane at t = 0, with live parameters that may have slopes.
pub(super) struct Source<'a> {
    /// The crane.
    pub crane: &'a LiveCrane,
    evaluations: BTreeMap<FunctionId, Evaluation<Dual8>>,
    parameters: Vec<Dual8>,
    inputs: Vec<Dual8>,
}

impl<'a> Source<'a> {
    /// With the parameters of the crane, without slopes.
    pub fn new(crane: &'a LiveCrane) -> Self {
        let parameters = crane.parameters().iter().map(|value| Dual8::splat(*value)).collect();
        let inputs = crane.inputs().numbers().map(Dual8::splat).collect();
        Self { crane, evaluations: BTreeMap::new(), parameters, inputs }
    }

    /// Other values and slopes of all inputs, three numbers each.
    pub fn set_inputs(&mut self, inputs: Vec<Dual8>) {
        for evaluation in self.evaluations.values_mut() {
            evaluation.set_inputs(inputs.iter().copied());
        }
        self.inputs = inputs;
    }

    /// Other values and slopes of all parameters.
    pub fn set_parameters(&mut self, parameters: Vec<Dual8>) {
        for evaluation in self.evaluations.values_mut() {
            evaluation.set_parameters(&parameters);
        }
        self.parameters = parameters;
    }

    /// A function of a pose at rest; zeros if the crane does not need it.
    pub fn at(&mut self, id: FunctionId, q: &[Dual8]) -> Vec<Dual8> {
        let rest = vec![Dual8::splat(0.0); q.len()];
        self.with_rates(id, q, &rest)
    }

    /// A function of a pose and rates; zeros if the crane does not need it.
    pub fn with_rates(&mut self, id: FunctionId, q: &[Dual8], v: &[Dual8]) -> Vec<Dual8> {
        let Self { crane, evaluations, parameters, inputs } = self;
        let evaluation = evaluations.entry(id).or_insert_with(|| {
            let mut evaluation = Evaluation::new(crane, id);
            evaluation.set_parameters(parameters);
            evaluation.set_inputs(inputs.iter().copied());
            evaluation
        });
        evaluation.results_at(&Arguments { q, v, ..Arguments::none() }).to_vec()
    }

    /// `Jᵀ λ` from the rows of loop joints and what they transmit.
    pub fn generalized(&mut self, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Dual8> {
        let mut sum = vec![Dual8::splat(0.0); q.len()];
        if multipliers.is_empty() {
            return sum;
        }
        let rows = self.at(FunctionId::LoopJacobians, q);
        for (multiplier, row) in multipliers.iter().zip(rows.chunks_exact(q.len())) {
            sum.iter_mut().zip(row).for_each(|(sum, entry)| *sum = *sum + *multiplier * *entry);
        }
        sum
    }
}
