//! A function of a program as a list of operations that is run from front to back.

use crane_codegen::symbolic::{Argument, Constant, Function, Op, Program, Scalar, Shape};
use nalgebra::ComplexField;

/// One operation on the results before it.
#[derive(Clone, Copy, Debug)]
enum Operation {
    Constant(f64),
    Input(usize, usize),
    Neg(usize),
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    Div(usize, usize),
    Sin(usize),
    Cos(usize),
    Stumpff(u8, usize),
    Min(usize, usize),
    Max(usize, usize),
}

/// Values of all arguments of a function; what it does not take may be empty.
#[derive(Clone, Copy, Debug, Default)]
pub struct Inputs<'a> {
    /// Time, s.
    pub t: f64,
    /// Coordinates, m and rad.
    pub q: &'a [f64],
    /// Their rates.
    pub v: &'a [f64],
    /// Right-hand side of a linear system.
    pub right: &'a [f64],
    /// Resistances of single coordinates.
    pub resistance: &'a [f64],
    /// Resistance of the base, 6×6, column by column.
    pub base: &'a [f64],
    /// What an earlier function left.
    pub factors: &'a [f64],
    /// Live parameters.
    pub parameters: &'a [f64],
}

impl Inputs<'_> {
    /// The arguments by their places in [`ARGUMENTS`].
    fn slices(&self) -> [&[f64]; 8] {
        let t = std::slice::from_ref(&self.t);
        [t, self.q, self.v, self.right, self.resistance, self.base, self.factors, self.parameters]
    }
}

const ARGUMENTS: [Argument; 8] = [
    Argument::Time,
    Argument::Position,
    Argument::Velocity,
    Argument::Right,
    Argument::Resistance,
    Argument::BaseResistance,
    Argument::Factors,
    Argument::Parameters,
];

/// A function without those parts of its program that it does not need.
#[derive(Clone, Debug)]
pub struct Routine {
    operations: Vec<Operation>,
    outputs: Vec<usize>,
    shape: Shape,
}

impl Routine {
    /// A function of a program.
    pub fn new(program: &Program, function: &Function) -> Self {
        let needed = program.needed(function.outputs.iter().copied());
        let mut place = vec![0; program.operations.len()];
        let mut operations = Vec::new();
        for (index, op) in program.operations.iter().enumerate().filter(|(index, _)| needed[*index]) {
            let at = |id: crane_codegen::symbolic::ExprId| place[id.index()];
            let operation = match *op {
                Op::Constant(constant) => Operation::Constant(Constant::value(constant)),
                Op::Symbol(id) => {
                    let symbol = program.symbol(id);
                    let argument = ARGUMENTS.iter().position(|argument| *argument == symbol.argument);
                    Operation::Input(argument.unwrap_or_default(), symbol.index)
                }
                Op::Neg(a) => Operation::Neg(at(a)),
                Op::Add(a, b) => Operation::Add(at(a), at(b)),
                Op::Sub(a, b) => Operation::Sub(at(a), at(b)),
                Op::Mul(a, b) => Operation::Mul(at(a), at(b)),
                Op::Div(a, b) => Operation::Div(at(a), at(b)),
                Op::Sin(a) => Operation::Sin(at(a)),
                Op::Cos(a) => Operation::Cos(at(a)),
                Op::Stumpff(k, a) => Operation::Stumpff(k, at(a)),
                Op::Min(a, b) => Operation::Min(at(a), at(b)),
                Op::Max(a, b) => Operation::Max(at(a), at(b)),
            };
            place[index] = operations.len();
            operations.push(operation);
        }
        let outputs = function.outputs.iter().map(|id| place[id.index()]).collect();
        Self { operations, outputs, shape: function.shape.clone() }
    }

    /// The function's result, in the order of its shape, closed.
    pub fn run(&self, inputs: &Inputs<'_>) -> Vec<f64> {
        let inputs = inputs.slices();
        let mut values: Vec<f64> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let value = match *operation {
                Operation::Constant(constant) => constant,
                Operation::Input(argument, index) => inputs[argument][index],
                Operation::Neg(a) => -values[a],
                Operation::Add(a, b) => values[a] + values[b],
                Operation::Sub(a, b) => values[a] - values[b],
                Operation::Mul(a, b) => values[a] * values[b],
                Operation::Div(a, b) => values[a] / values[b],
                Operation::Sin(a) => ComplexField::sin(values[a]),
                Operation::Cos(a) => ComplexField::cos(values[a]),
                Operation::Stumpff(k, a) => values[a].stumpff(k),
                Operation::Min(a, b) => Scalar::min(values[a], values[b]),
                Operation::Max(a, b) => Scalar::max(values[a], values[b]),
            };
            values.push(value);
        }
        self.shape.close(self.outputs.iter().map(|&output| values[output]).collect())
    }
}
