//! Products of vectors with the derivatives of a function, without these derivatives.
//!
//! Vectors over all numbers that a function depends on have them in this order: t; q, v and a; the live parameters; the values of the inputs.
//!
//! | product | cost |
//! |---|---|
//! | `wᵀ J`, backward along the function ([`PullBack`]) | a few times that of the function, for all numbers at once |
//! | `J x`, forward along the function ([`PushForward`]) | a few times that of the function |
//!
//! Both are for one state or for eight. Functions with too many operations for them have [`PushForwardOfLarge`].

use std::ops::Range;
use std::sync::Arc;

use crane_codegen::chain::Input;
use crane_codegen::program::{self, Argument, FunctionId, PULLED_BACK, Product};
use crane_model::dyn_crane::{Arguments, Functions};

use crate::Evaluation;
use crate::LiveCrane;
use crate::assemble::TooLarge;
use crate::dual::{DIRECTIONS, Dual8};
use crate::library::Library;
use crate::machine::{Environment, Machine, Number};

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

/// A product of a function of a crane, with a workspace for its calls.
#[derive(Debug)]
struct Calls<T> {
    library: Arc<Library>,
    function: FunctionId,
    product: Product,
    machine: Machine<T>,
    inputs: Vec<T>,
    results: Vec<T>,
    /// Where each of [`PULLED_BACK`] is among all numbers.
    places: [Range<usize>; PULLED_BACK.len()],
}

impl<T: Number> Calls<T> {
    fn new(crane: &LiveCrane, function: FunctionId, product: Product) -> Result<Option<Self>, TooLarge> {
        let library = crane.library();
        let Some(routine) = library.product(function, product)? else { return Ok(None) };
        let splat = |number: &f64| T::splat(*number);
        let (n, parameters) = (crane.size(), crane.parameters().iter().map(splat).collect::<Vec<T>>());
        let mut end = 0;
        let inputs: Vec<T> = crane.inputs().numbers().map(T::splat).collect();
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
        let (machine, results) = (routine.machine(&parameters), vec![T::splat(0.0); routine.results()]);
        Ok(Some(Self { library, function, product, machine, inputs, results, places }))
    }

    fn set_parameters(&mut self, parameters: &[T]) {
        if let Ok(Some(routine)) = self.library.product(self.function, self.product) {
            routine.set_parameters(&mut self.machine, parameters);
        }
    }

    fn run(&mut self, state: &Arguments<'_, T>, multiplier: &[T]) {
        let Self { library, function, product, machine, inputs, results, .. } = self;
        let environment = Environment { multiplier, inputs, ..(*state).into() };
        if let Ok(Some(routine)) = library.product(*function, *product) {
            routine.run(machine, &environment, results);
        }
    }
}

/// `wᵀ J` of a function of a crane, with a workspace for its calls.
#[derive(Debug)]
pub struct PullBack<T = f64>(Calls<T>);

/// The derivatives of a weighted sum of the results of a function.
#[derive(Clone, Copy, Debug)]
pub struct Pulled<'r, T = f64> {
    /// By time.
    pub t: T,
    /// By the pose.
    pub q: &'r [T],
    /// By its rates.
    pub v: &'r [T],
    /// By accelerations.
    pub a: &'r [T],
    /// By the live parameters.
    pub parameters: &'r [T],
    /// By the numbers of the inputs, of which the first of each is its value.
    pub inputs: &'r [T],
}

impl<T: Number> PullBack<T> {
    /// Of a function of a crane with its parameters and inputs; `None` if the crane does not need it.
    ///
    /// # Errors
    /// It needs too many registers.
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Result<Option<Self>, TooLarge> {
        Ok(Calls::new(crane, function, Product::Vjp)?.map(Self))
    }

    /// Other live parameters, all of them.
    pub fn set_parameters(&mut self, parameters: &[T]) {
        self.0.set_parameters(parameters);
    }

    /// The product at a state, with a weight for each result of the function, in their order.
    pub fn at(&mut self, state: &Arguments<'_, T>, weights: &[T]) -> Pulled<'_, T> {
        self.0.run(state, weights);
        let Calls { results, places, .. } = &self.0;
        let [t, q, v, a, parameters, inputs] = places.each_ref().map(|place| &results[place.clone()]);
        Pulled { t: t[0], q, v, a, parameters, inputs }
    }
}

impl<T: Copy> Pulled<'_, T> {
    /// All of it, in the order of [`numbers`].
    pub fn all(&self) -> impl Iterator<Item = T> {
        let inputs = self.inputs.iter().step_by(Input::SLOTS);
        [self.t].into_iter().chain([self.q, self.v, self.a, self.parameters].concat()).chain(inputs.copied())
    }
}

/// `J x` of a function of a crane, with a workspace for its calls.
#[derive(Debug)]
pub struct PushForward<T = f64> {
    calls: Calls<T>,
    /// Changes of all numbers, with those of the numbers of inputs.
    changes: Vec<T>,
}

impl<T: Number> PushForward<T> {
    /// Of a function of a crane with its parameters and inputs; `None` if the crane does not need it.
    ///
    /// # Errors
    /// It needs too many registers.
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Result<Option<Self>, TooLarge> {
        let calls = Calls::new(crane, function, Product::Jvp)?;
        Ok(calls.map(|calls| {
            let numbers = calls.places.iter().map(|place| place.end).max().unwrap_or_default();
            Self { calls, changes: vec![T::splat(0.0); numbers] }
        }))
    }

    /// Other live parameters, all of them.
    pub fn set_parameters(&mut self, parameters: &[T]) {
        self.calls.set_parameters(parameters);
    }

    /// The product at a state, with the changes of all [`numbers`]; one number for each result of the function.
    pub fn at(&mut self, state: &Arguments<'_, T>, changes: &[T]) -> &[T] {
        let [.., inputs] = &self.calls.places;
        let (own, of_inputs) = changes.split_at(inputs.start.min(changes.len()));
        self.changes[..own.len()].copy_from_slice(own);
        // Of the numbers of an input, only its value changes.
        let values = self.changes[inputs.start..].iter_mut().step_by(Input::SLOTS);
        values.zip(of_inputs).for_each(|(place, change)| *place = *change);
        self.calls.run(state, &self.changes);
        &self.calls.results
    }
}

/// `J x` of a function with any number of operations, at one state, with a workspace for its calls.
#[derive(Debug)]
pub struct PushForwardOfLarge {
    evaluation: Evaluation<Dual8>,
    n: usize,
    inputs: Vec<f64>,
    /// The live parameters that the evaluation has, if they do not change along the last direction.
    parameters: Option<Vec<f64>>,
}

impl PushForwardOfLarge {
    /// Of a function of a crane with its inputs.
    #[must_use]
    pub fn new(crane: &LiveCrane, function: FunctionId) -> Self {
        let (evaluation, inputs) = (Evaluation::new(crane, function), crane.inputs().numbers().collect());
        Self { evaluation, n: crane.size(), inputs, parameters: Some(crane.parameters().to_vec()) }
    }

    /// The product at a state and with live parameters, with the changes of all [`numbers`]; one number for each result of the function.
    pub fn at(&mut self, state: &Arguments<'_>, parameters: &[f64], changes: &[f64], out: &mut [f64]) {
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
        self.evaluation.set_inputs(inputs);
        let results = self.evaluation.results_at(&Arguments { t, q: &q, v: &v, a: &a, ..Arguments::none() });
        out.iter_mut().zip(results).for_each(|(out, number)| *out = number.slope(0));
    }
}
