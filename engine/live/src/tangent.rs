//! A line of operations with the derivatives of every value, eight directions next to each other.
//!
//! A value is in all eight places of its cell, its derivatives are in those of another one, if it has any. A product then takes two
//! operations more, or one if one of its factors is a number.

use crane_jit::{Step, StraightLine, Value, value};

use crate::bytecode::Kind;

/// Orders of Stumpff's functions that have derivatives, and those that these need.
const STUMPFF: [usize; 2] = [6, 8];

/// Numbers that the derivatives need: −0, −1, ½, and 0 to 5.
const NUMBERS: [f64; 9] = [-0.0, -1.0, 0.5, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
const ZERO: usize = 0;
const NEGATIVE: usize = 1;
const HALF: usize = 2;
const INTEGERS: usize = 3;

/// The line whose given values are those of a line, then their derivatives, then some numbers; and whose results are those of the line, then
/// their derivatives. `pauses`: what the pauses of the line compute.
pub fn tangent(line: &StraightLine, pauses: &[Kind]) -> StraightLine {
    let given = line.given.len();
    let slopes = line.given.iter().map(|number| number.map(|_| 0.0));
    let all: Vec<Option<f64>> = line.given.iter().copied().chain(slopes).chain(NUMBERS.into_iter().map(Some)).collect();
    let of_given = |at: usize| Number { value: value(at), slopes: line.given[at].is_none().then(|| value(given + at)) };
    let mut writer = TangentWriter {
        of: (0..given).map(of_given).collect(),
        numbers: 2 * given,
        count: all.len(),
        line: StraightLine { given: all, steps: vec![], results: 2 * line.results },
    };
    let mut pauses = pauses.iter();
    for step in &line.steps {
        match step {
            Step::Store { place: index, value } => writer.store(*index, *value, line.results),
            Step::Pause { arguments, .. } => {
                let kind = pauses.next().copied().unwrap_or(Kind::Exp);
                writer.pause(kind, arguments);
            }
            _ => writer.write(step),
        }
    }
    writer.line
}

/// A value and its derivatives.
#[derive(Clone, Copy, Debug)]
struct Number {
    value: Value,
    /// `None`: zero.
    slopes: Option<Value>,
}

/// A line under construction.
struct TangentWriter {
    /// Each value of the line without derivatives.
    of: Vec<Number>,
    /// The place of the first of [`NUMBERS`].
    numbers: usize,
    /// The number of values.
    count: usize,
    line: StraightLine,
}

impl TangentWriter {
    fn number_of(&self, value: Value) -> Number {
        self.of[value as usize]
    }

    fn number(&self, which: usize) -> Value {
        value(self.numbers + which)
    }

    fn push(&mut self, step: Step) -> Value {
        self.line.steps.push(step);
        self.count += 1;
        value(self.count - 1)
    }

    /// `a b + c`, where c may be zero.
    fn product(&mut self, a: Value, b: Value, c: Option<Value>) -> Value {
        let c = c.unwrap_or(self.number(ZERO));
        self.push(Step::MulAdd([a, b, c]))
    }

    fn negative(&mut self, a: Value) -> Value {
        self.product(a, self.number(NEGATIVE), None)
    }

    /// Derivatives that may be zero, as a value.
    fn or_zero(&self, slopes: Option<Value>) -> Value {
        slopes.unwrap_or(self.number(ZERO))
    }

    /// `b` if a > 0, otherwise `c`; zero if both are.
    fn select(&mut self, a: Value, b: Option<Value>, c: Option<Value>) -> Option<Value> {
        (b.is_some() || c.is_some()).then(|| self.push(Step::Select([a, self.or_zero(b), self.or_zero(c)])))
    }

    /// A step that makes one value.
    fn write(&mut self, step: &Step) {
        let made = match *step {
            Step::MulAdd(operands) => {
                let [a, b, c] = operands.map(|operand| self.number_of(operand));
                let value = self.push(Step::MulAdd([a.value, b.value, c.value]));
                let mut slopes = c.slopes;
                for (one, other) in [(a, b), (b, a)] {
                    if let Some(own) = one.slopes {
                        slopes = Some(self.product(own, other.value, slopes));
                    }
                }
                Number { value, slopes }
            }
            Step::Div(operands) => {
                let [a, b] = operands.map(|operand| self.number_of(operand));
                let value = self.push(Step::Div([a.value, b.value]));
                let mut above = a.slopes;
                if let Some(below) = b.slopes {
                    let negative = self.negative(below);
                    above = Some(self.product(negative, value, above));
                }
                Number { value, slopes: above.map(|above| self.push(Step::Div([above, b.value]))) }
            }
            // As for numbers with slopes, that of the second of equal ones.
            Step::Min(operands) => self.extreme(operands, true),
            Step::Max(operands) => self.extreme(operands, false),
            Step::Sqrt(a) => {
                let a = self.number_of(a);
                let value = self.push(Step::Sqrt(a.value));
                let slopes = a.slopes.map(|own| {
                    let half = self.push(Step::Div([self.number(HALF), value]));
                    let product = self.product(half, own, None);
                    // A zero slope stays zero, even where the root has a vertical tangent.
                    let negative = self.negative(own);
                    let below = self.push(Step::Select([negative, product, self.number(ZERO)]));
                    self.push(Step::Select([own, product, below]))
                });
                Number { value, slopes }
            }
            Step::Select(operands) => {
                let [a, b, c] = operands.map(|operand| self.number_of(operand));
                let value = self.push(Step::Select([a.value, b.value, c.value]));
                Number { value, slopes: self.select(a.value, b.slopes, c.slopes) }
            }
            Step::Store { .. } | Step::Pause { .. } => return,
        };
        self.of.push(made);
    }

    /// The smaller or the larger of two.
    fn extreme(&mut self, operands: [Value; 2], smaller: bool) -> Number {
        let [a, b] = operands.map(|operand| self.number_of(operand));
        let pair = [a.value, b.value];
        let value = self.push(if smaller { Step::Min(pair) } else { Step::Max(pair) });
        let (less, more) = if smaller { (a.value, b.value) } else { (b.value, a.value) };
        let is_first = self.product(less, self.number(NEGATIVE), Some(more));
        Number { value, slopes: self.select(is_first, a.slopes, b.slopes) }
    }

    fn store(&mut self, index: u32, stored: Value, results: usize) {
        let Number { value: own, slopes } = self.number_of(stored);
        self.line.steps.push(Step::Store { place: index, value: own });
        let index = index + value(results);
        self.line.steps.push(Step::Store { place: index, value: self.or_zero(slopes) });
    }

    /// Functions of several arguments at once, order by order.
    fn pause(&mut self, kind: Kind, arguments: &[Value]) {
        let reads = arguments.len();
        let arguments: Vec<Number> = arguments.iter().map(|argument| self.number_of(*argument)).collect();
        let [orders, made] = match kind {
            Kind::Angle => [2, 2],
            Kind::Stumpff => STUMPFF,
            _ => [1, 1],
        };
        let (first, makes) = (self.count, made * reads);
        let values = arguments.iter().map(|argument| argument.value).collect();
        self.line.steps.push(Step::Pause { arguments: values, makes });
        self.count += makes;
        for order in 0..orders {
            for (at, argument) in arguments.iter().enumerate() {
                let made = |order: usize| value(first + order * reads + at);
                let slopes = argument.slopes.map(|own| {
                    let derivative = match (kind, order) {
                        (Kind::Angle, 0) => made(1),
                        (Kind::Angle, _) => self.negative(made(0)),
                        // c_k' = (k c_{k+2} − c_{k+1})/2
                        (Kind::Stumpff, k) => {
                            let next = self.negative(made(k + 1));
                            let difference = self.product(self.number(INTEGERS + k), made(k + 2), Some(next));
                            self.product(difference, self.number(HALF), None)
                        }
                        _ => made(0),
                    };
                    self.product(own, derivative, None)
                });
                self.of.push(Number { value: made(order), slopes });
            }
        }
    }
}
