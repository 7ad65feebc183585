//! Products of vectors with the derivatives of a function, without these derivatives.
//!
//! Vectors over all numbers that a function depends on have them in this order: t; q, v and a; the live parameters; the values of the inputs.
//!
//! | product | cost |
//! |---|---|
//! | `wᵀ J`, backward along the function ([`PullBack`]) | a few times that of the function, for all numbers at once |
//! | `J x`, forward along the function ([`PushForward`]) | a few times that of the function |

use std::ops::Range;
use std::sync::Arc;

use crane_codegen::chain::Input;
use crane_codegen::program::{self, Argument, FunctionId, PULLED_BACK};
use crane_model::dyn_crane::DynModel;

use crate::LiveCrane;
use crate::assemble::TooLarge;
use crate::dual::{DIRECTIONS, Dual8};
use crate::library::Library;
use crate::machine::{Arguments, Machine};
use crate::rows::Evaluation;

/// A state at which a function is differentiated.
#[derive(Clone, Copy, Debug)]
pub struct State<'a> {
    /// Time, s.
    pub t: f64,
    /// Pose, m and rad.
    pub q: &'a [f64],
    /// Its rates.
    pub v: &'a [f64],
    /// Accelerations.
    pub a: &'a [f64],
}

/// Names of all numbers that functions of a crane depend on, and how many each has. A live parameter that is called as one of the first four is
/// `parameters.q`.
#[must_use]
pub fn numbers(crane: &LiveCrane) -> Vec<(String, usize)> {
    let description = crane.description();
    let n = crane.size();
    let own = [("t", 1), ("q", n), ("v", n), ("a", n)];
    let parameters = description.parameters.iter().map(|parameter| {
        let is_taken = own.iter().any(|(name, _)| *name == &*parameter.name);
        (if is_taken { format!("parameters.{}", parameter.name) } else { parameter.name.to_string() }, 1)
    });
    let inputs = description.inputs.iter().map(|input| (format!("inputs.{}", input.name), 1));
    own.map(|(name, count)| (name.to_owned(), count)).into_iter().chain(parameters).chain(inputs).collect()
}

/// Whether a function has products, see [`program::has_products`].
#[must_use]
pub fn has_products(crane: &LiveCrane, function: FunctionId) -> bool {
    program::has_products(function, !crane.loop_joints().is_empty())
}

/// `wᵀ J` of a function of a crane, with a workspace for its calls.
#[derive(Debug)]
pub struct PullBack {
    library: Arc<Library>,
    function: FunctionId,
    machine: Machine<f64>,
    inputs: Vec<f64>,
    results: Vec<f64>,
    /// Where each of [`PULLED_BACK`] is among the results.
    places: [Range<usize>; PULLED_BACK.len()],
}

/// The derivatives of a weighted sum of the results of a function.
#[derive(Clone, Copy, Debug)]
pub struct Pulled<'r> {
    /// By time.
    pub t: f64,
    /// By the pose.
    pub q: &'r [f64],
    /// By its rates.
    pub v: &'r [f64],
    /// By accelerations.
    pub a: &'r [f64],
    /// By the live parameters.
    pub parameters: &'r [f64],
    /// By the numbers of the inputs, of which the first of each is its value.
    pub inputs: &'r [f64],
}

impl PullBack {
    /// Of a function of a crane with its parameters and inputs; `None` if the crane does not need it.
    ///
    /// # Errors
    /// It needs too many registers.
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Result<Option<Self>, TooLarge> {
        let library = crane.library();
        let Some(routine) = library.pulled_back(function)? else { return Ok(None) };
        let (n, parameters) = (crane.size(), crane.parameters());
        let mut end = 0;
        let inputs: Vec<f64> = crane.inputs().numbers().collect();
        let places = PULLED_BACK.map(|argument| {
            let begin = end;
            end += match argument {
                Argument::Time => 1,
                Argument::Parameters => parameters.len(),
                Argument::Inputs => inputs.len(),
                _ => n,
            };
            begin..end
        });
        let (machine, results) = (routine.machine(parameters), vec![0.0; routine.results()]);
        Ok(Some(Self { library, function, machine, inputs, results, places }))
    }

    /// Other live parameters, all of them.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        if let Ok(Some(routine)) = self.library.pulled_back(self.function) {
            routine.set_parameters(&mut self.machine, parameters);
        }
    }

    /// The product at a state, with a weight for each result of the function, in their order.
    pub fn at(&mut self, state: &State<'_>, weights: &[f64]) -> Pulled<'_> {
        let Self { library, function, machine, inputs, results, places } = self;
        let &State { t, q, v, a } = state;
        let arguments = Arguments { t, q, v, a, multiplier: weights, inputs, ..Arguments::none() };
        if let Ok(Some(routine)) = library.pulled_back(*function) {
            routine.run(machine, &arguments, results);
        }
        let [t, q, v, a, parameters, inputs] = places.each_ref().map(|place| &results[place.clone()]);
        Pulled { t: t[0], q, v, a, parameters, inputs }
    }
}

impl Pulled<'_> {
    /// All of it, in the order of [`numbers`].
    pub fn write(&self, out: &mut [f64]) {
        let inputs = self.inputs.iter().step_by(Input::SLOTS);
        let all = [self.t].into_iter().chain([self.q, self.v, self.a, self.parameters].concat()).chain(inputs.copied());
        out.iter_mut().zip(all).for_each(|(out, number)| *out = number);
    }
}

/// `J x` of a function of a crane, with a workspace for its calls.
#[derive(Debug)]
pub struct PushForward {
    evaluation: Evaluation<Dual8>,
    n: usize,
    inputs: Vec<f64>,
    /// The live parameters that the evaluation has, if they do not change along the last direction.
    parameters: Option<Vec<f64>>,
}

impl PushForward {
    /// Of a function of a crane with its inputs.
    #[must_use]
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Self {
        let (evaluation, inputs) = (Evaluation::new(crane, function), crane.inputs().numbers().collect());
        Self { evaluation, n: crane.size(), inputs, parameters: Some(crane.parameters().to_vec()) }
    }

    /// The product at a state and with live parameters, with the changes of all [`numbers`]; one number for each result of the function.
    pub fn at(&mut self, state: &State<'_>, parameters: &[f64], changes: &[f64], out: &mut [f64]) {
        let mut changes = changes.iter().copied();
        let mut next = |number: f64| {
            let mut slopes = [0.0; DIRECTIONS];
            slopes[0] = changes.next().unwrap_or_default();
            Dual8::new(number, slopes)
        };
        let t = next(state.t);
        let mut all = |numbers: &[f64]| -> Vec<Dual8> {
            (0..self.n).map(|i| next(numbers.get(i).copied().unwrap_or_default())).collect()
        };
        let [q, v, a] = [state.q, state.v, state.a].map(&mut all);
        let along: Vec<Dual8> = parameters.iter().map(|number| next(*number)).collect();
        let rests = along.iter().all(|number| number.slope(0) == 0.0);
        let inputs = self.inputs.iter().enumerate();
        let inputs = inputs.map(
            |(slot, number)| {
                if slot % Input::SLOTS == 0 { next(*number) } else { Dual8::along(*number, None) }
            },
        );
        let inputs: Vec<Dual8> = inputs.collect();
        if !rests || self.parameters.as_deref() != Some(parameters) {
            self.evaluation.set_parameters(&along);
            self.parameters = rests.then(|| parameters.to_vec());
        }
        self.evaluation.set_inputs(&inputs);
        let results = self.evaluation.at(t, &q, &v, &a);
        out.iter_mut().zip(results).for_each(|(out, number)| *out = number.slope(0));
    }
}
