//! The semantics of a program: runs it without rustc, over any scalar.

use std::collections::BTreeMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::op::{Constant, Op};
use super::program::{Argument, Function, Program};
use super::stumpff;

/// What the interpreter needs from a number: f64, a dual number, a number of higher precision.
pub trait Scalar:
    Clone + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The number of a constant.
    fn from_f64(value: f64) -> Self;
    /// Sine and cosine.
    fn sin_cos(&self) -> (Self, Self);
    /// Stumpff's function `c_k(x) = Σ (−x)^i/(2i + k)!`, 0 ≤ x ≤ 100; the default uses its series.
    #[must_use]
    fn stumpff(&self, k: u8) -> Self {
        stumpff::series(k, self)
    }
    /// The smaller of two.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The larger of two.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// Square root.
    #[must_use]
    fn sqrt(&self) -> Self;
    /// Exponential.
    #[must_use]
    fn exp(&self) -> Self;
    /// `positive` if the number is above zero, otherwise `other`.
    #[must_use]
    fn select(&self, positive: Self, other: Self) -> Self;
}

impl Scalar for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
    fn sin_cos(&self) -> (Self, Self) {
        f64::sin_cos(*self)
    }
    fn stumpff(&self, k: u8) -> Self {
        stumpff::of(k, *self)
    }
    fn min(self, other: Self) -> Self {
        f64::min(self, other)
    }
    fn max(self, other: Self) -> Self {
        f64::max(self, other)
    }
    fn sqrt(&self) -> Self {
        f64::sqrt(*self)
    }
    fn exp(&self) -> Self {
        f64::exp(*self)
    }
    fn select(&self, positive: Self, other: Self) -> Self {
        if *self > 0.0 { positive } else { other }
    }
}

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
    /// Evaluates a function; the result is in the order of its [`Shape`](super::Shape), closed.
    ///
    /// # Panics
    /// If an input that the function uses is missing.
    pub fn evaluate<S: Scalar>(&self, function: &Function, inputs: &Inputs<S>) -> Vec<S> {
        let needed = self.needed(function.outputs.iter().copied());
        let mut values: Vec<Option<S>> = vec![None; self.operations.len()];
        for (index, op) in self.operations.iter().enumerate().filter(|(index, _)| needed[*index]) {
            let of = |id: super::ExprId| values[id.index()].clone().expect("operands come before their users");
            let value = match *op {
                Op::Constant(c) => S::from_f64(Constant::value(c)),
                Op::Symbol(id) => {
                    let symbol = self.symbol(id);
                    inputs.0[&symbol.argument][symbol.index].clone()
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
        function.shape.close(slots.collect())
    }
}
