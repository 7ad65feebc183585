//! The meaning of a program: runs it without rustc, over any scalar.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::op::{Constant, Op};
use super::program::{Argument, Function, Program};

/// What the interpreter needs from a number: f64, a dual number, a number of higher precision.
pub trait Scalar:
    Clone + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The number of a constant.
    fn from_f64(value: f64) -> Self;
    /// Sine and cosine.
    fn sin_cos(&self) -> (Self, Self);
    /// The smaller of two.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The larger of two.
    #[must_use]
    fn max(self, other: Self) -> Self;
}

impl Scalar for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
    fn sin_cos(&self) -> (Self, Self) {
        f64::sin_cos(*self)
    }
    fn min(self, other: Self) -> Self {
        f64::min(self, other)
    }
    fn max(self, other: Self) -> Self {
        f64::max(self, other)
    }
}

/// Values of a program's inputs.
#[derive(Clone, Debug)]
pub struct Inputs<S> {
    /// Time, s.
    pub t: S,
    /// Coordinates, m and rad.
    pub q: Vec<S>,
    /// Velocities, m/s and rad/s.
    pub v: Vec<S>,
    /// Live parameters.
    pub parameters: Vec<S>,
}

impl<S: Scalar> Inputs<S> {
    fn get(&self, argument: Argument, index: usize) -> S {
        match argument {
            Argument::Time => self.t.clone(),
            Argument::Position => self.q[index].clone(),
            Argument::Velocity => self.v[index].clone(),
            Argument::Parameters => self.parameters[index].clone(),
        }
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
                    inputs.get(symbol.argument, symbol.index)
                }
                Op::Neg(a) => -of(a),
                Op::Add(a, b) => of(a) + of(b),
                Op::Sub(a, b) => of(a) - of(b),
                Op::Mul(a, b) => of(a) * of(b),
                Op::Div(a, b) => of(a) / of(b),
                Op::Sin(a) => of(a).sin_cos().0,
                Op::Cos(a) => of(a).sin_cos().1,
                Op::Min(a, b) => of(a).min(of(b)),
                Op::Max(a, b) => of(a).max(of(b)),
            };
            values[index] = Some(value);
        }
        let slots = function.outputs.iter().map(|id| values[id.index()].clone().expect("outputs are needed"));
        function.shape.close(slots.collect())
    }
}
