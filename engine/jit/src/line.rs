//! What is compiled: a straight line of operations on values, each of which is made once.

/// Number of a value: first those that are given, then those that steps make, in order.
pub type Value = u32;

/// The value with this number. No line has as many as there are numbers.
#[must_use]
pub fn value(number: usize) -> Value {
    Value::try_from(number).unwrap_or(Value::MAX)
}

/// A straight line of operations.
#[derive(Clone, Debug, Default)]
pub struct StraightLine {
    /// The values that are given before a call, in the first places of the frame; `Some` for numbers that never change.
    pub given: Vec<Option<f64>>,
    /// The steps, in order.
    pub steps: Vec<Step>,
    /// The number of results.
    pub results: usize,
}

/// A step of a line.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// `a b + c`, a value
    MulAdd([Value; 3]),
    /// `a / b`, a value
    Div([Value; 2]),
    /// The smaller of two, a value.
    Min([Value; 2]),
    /// The larger of two, a value.
    Max([Value; 2]),
    /// `√a`, a value
    Sqrt(Value),
    /// `b` if a > 0, otherwise `c`, a value.
    Select([Value; 3]),
    /// A result.
    Store {
        /// Its place among the results.
        place: u32,
        /// Its value.
        value: Value,
    },
    /// The caller computes values from others.
    Pause {
        /// What it reads, in places of the frame that follow one another.
        arguments: Vec<Value>,
        /// The number of values that it makes, in the places after those.
        makes: usize,
    },
}

/// How `a b + c` is rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// Once.
    Fused,
    /// The product, then the sum.
    Separate,
}

/// How many numbers a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One.
    One,
    /// Eight, next to each other.
    Eight,
}

impl Width {
    /// The number of numbers.
    #[must_use]
    pub fn numbers(self) -> usize {
        match self {
            Width::One => 1,
            Width::Eight => 8,
        }
    }
}

/// How many numbers an instruction computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    /// One.
    One,
    /// Four of eight.
    Four,
    /// Eight.
    Eight,
}

impl Lanes {
    /// The number of numbers.
    pub fn numbers(self) -> usize {
        match self {
            Lanes::One => 1,
            Lanes::Four => 4,
            Lanes::Eight => 8,
        }
    }
}
