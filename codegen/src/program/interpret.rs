//! The semantics of a program: runs it without rustc, over any scalar.

use std::collections::BTreeMap;

use super::{Argument, Function, Program};
use crate::symbolic::{Constant, ExprId, Op, Scalar};

/// Values of a program's inputs, argument by argument.
#[derive(Clone, Debug)]
pub struct Inputs<S>(BTreeMap<Argument, Vec<S>>);

impl<S: Scalar> Inputs<S> {
    /// A state: time in s, coordinates in m and rad, velocities in m/s and rad/s; and the live parameters.
    pub fn state(t: S, q: Vec<S>, v: Vec<S>, parameters: Vec<S>) -> Self {
        let arguments = [Argument::Time, Argument::Position, Argument::Velocity, Argument::Parameters];
        Inputs(arguments.into_iter().zip([vec![t], q, v, parameters]).collect())
    }

    /// The same with other values of an argument.
    #[must_use]
    pub fn with(mut self, argument: Argument, values: Vec<S>) -> Self {
        self.0.insert(argument, values);
        self
    }

    /// The values of an argument; none if it was not given.
    #[must_use]
    pub fn get(&self, argument: Argument) -> Vec<S> {
        self.0.get(&argument).cloned().unwrap_or_default()
    }
}

impl Program {
    /// Evaluates a function; inputs that are not given follow the spec. The result is in the order of its [`Shape`](super::Shape),
    /// closed.
    ///
    /// # Panics
    /// If an input that the function uses is missing.
    pub fn evaluate<S: Scalar>(&self, function: &Function, inputs: &Inputs<S>) -> Vec<S> {
        let needed = self.needed(function.outputs.iter().copied());
        let mut values: Vec<Option<S>> = vec![None; self.operations.len()];
        for (index, op) in self.operations.iter().enumerate().filter(|(index, _)| needed[*index]) {
            let of = |id: ExprId| values[id.index()].clone().expect("operands come before their users");
            let value = match *op {
                Op::Constant(c) => S::from_f64(Constant::value(c)),
                Op::Symbol(id) => {
                    let symbol = self.symbol(id);
                    match inputs.0.get(&symbol.argument) {
                        // No input is set: value, factor of the spec's, rate.
                        None if symbol.argument == Argument::Inputs => S::from_f64([0.0, 1.0, 0.0][symbol.index % 3]),
                        None => panic!("`{}` needs {:?}", function.id.name(), symbol.argument),
                        Some(values) => values[symbol.index].clone(),
                    }
                }
                Op::Neg(a) => -of(a),
                Op::Add(a, b) => of(a) + of(b),
                Op::Sub(a, b) => of(a) - of(b),
                Op::Mul(a, b) => of(a) * of(b),
                Op::Div(a, b) => of(a) / of(b),
                Op::Sin(a) => of(a).sin_cos().0,
                Op::Cos(a) => of(a).sin_cos().1,
                Op::Stumpff(k, a) => of(a).stumpff(k),
                Op::Min(a, b) => of(a).min(of(b)),
                Op::Max(a, b) => of(a).max(of(b)),
                Op::Sqrt(a) => of(a).sqrt(),
                Op::Exp(a) => of(a).exp(),
                Op::Select(a, b, c) => of(a).select(of(b), of(c)),
            };
            values[index] = Some(value);
        }
        let slots = function.outputs.iter().map(|id| values[id.index()].clone().expect("outputs are needed"));
        function.shape.expand(slots.collect())
    }
}
