//! Numbers of a chain: compiled-in constants, or expressions over live parameters.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Index of a live parameter in [`Chain::parameters`](super::Chain::parameters).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ParameterId(pub usize);

/// A number of the chain, in SI units.
///
/// Arithmetic folds constants, so a `Value` without parameters is always [`Value::Constant`], and a term that is
/// exactly zero disappears. Only numbers that the user keeps live remain expressions.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Known when the crane is compiled.
    Constant(f64),
    /// Known at run time.
    Parameter(ParameterId),
    /// −a
    Neg(Box<Value>),
    /// a + b
    Add(Box<Value>, Box<Value>),
    /// a · b
    Mul(Box<Value>, Box<Value>),
    /// a / b
    Div(Box<Value>, Box<Value>),
    /// sin a
    Sin(Box<Value>),
    /// cos a
    Cos(Box<Value>),
    /// √a
    Sqrt(Box<Value>),
}

impl Value {
    /// Exactly zero.
    pub const ZERO: Value = Value::Constant(0.0);
    /// Exactly one.
    pub const ONE: Value = Value::Constant(1.0);

    /// Whether the value is the constant zero: the compiler drops such a term.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        matches!(self, Value::Constant(c) if *c == 0.0)
    }

    /// The number, if it contains no live parameter.
    #[must_use]
    pub fn as_constant(&self) -> Option<f64> {
        match self {
            Value::Constant(c) => Some(*c),
            _ => None,
        }
    }

    /// The number with the given parameter values.
    ///
    /// # Panics
    /// If `parameters` is shorter than the chain's list of parameters.
    #[must_use]
    pub fn at(&self, parameters: &[f64]) -> f64 {
        match self {
            Value::Constant(c) => *c,
            Value::Parameter(ParameterId(i)) => parameters[*i],
            Value::Neg(a) => -a.at(parameters),
            Value::Add(a, b) => a.at(parameters) + b.at(parameters),
            Value::Mul(a, b) => a.at(parameters) * b.at(parameters),
            Value::Div(a, b) => a.at(parameters) / b.at(parameters),
            Value::Sin(a) => libm::sin(a.at(parameters)),
            Value::Cos(a) => libm::cos(a.at(parameters)),
            Value::Sqrt(a) => libm::sqrt(a.at(parameters)),
        }
    }

    /// The same number with each parameter multiplied by a factor.
    #[must_use]
    pub fn with_factors(&self, factor: &impl Fn(ParameterId) -> f64) -> Value {
        let same = |of: &Value| of.with_factors(factor);
        match self {
            Value::Constant(c) => Value::Constant(*c),
            Value::Parameter(id) => Value::Parameter(*id) * Value::Constant(factor(*id)),
            Value::Neg(a) => -same(a),
            Value::Add(a, b) => same(a) + same(b),
            Value::Mul(a, b) => same(a) * same(b),
            Value::Div(a, b) => same(a) / same(b),
            Value::Sin(a) => Value::Sin(Box::new(same(a))),
            Value::Cos(a) => Value::Cos(Box::new(same(a))),
            Value::Sqrt(a) => same(a).sqrt(),
        }
    }

    /// Square root.
    #[must_use]
    pub fn sqrt(self) -> Value {
        match self {
            Value::Constant(c) => Value::Constant(libm::sqrt(c)),
            live => Value::Sqrt(Box::new(live)),
        }
    }

    /// Sine and cosine of an angle in rad; exact at multiples of a quarter turn, so that a frame rotated by 90° keeps
    /// its zeros.
    #[must_use]
    pub fn sin_cos(&self) -> (Value, Value) {
        match self {
            Value::Constant(angle) => {
                let (sin, cos) = exact_sin_cos(*angle);
                (Value::Constant(sin), Value::Constant(cos))
            }
            live => (Value::Sin(Box::new(live.clone())), Value::Cos(Box::new(live.clone()))),
        }
    }
}

/// Sine and cosine, with exact values if the angle is a quarter turn to within its own rounding.
fn exact_sin_cos(angle: f64) -> (f64, f64) {
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    let nearest = quarters.round();
    // Four ulp: the angle was written as a decimal number, or came from a rational multiple of pi.
    if (quarters - nearest).abs() <= 4.0 * f64::EPSILON * nearest.abs().max(1.0) {
        #[allow(clippy::cast_possible_truncation)] // the remainder by 4 is one of -3..=3
        match (nearest % 4.0) as i8 {
            0 => (0.0, 1.0),
            1 | -3 => (1.0, 0.0),
            2 | -2 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        }
    } else {
        // libm instead of the platform's functions: the same bytes on any machine.
        (libm::sin(angle), libm::cos(angle))
    }
}

impl Default for Value {
    fn default() -> Self {
        Value::ZERO
    }
}

impl From<f64> for Value {
    fn from(constant: f64) -> Self {
        Value::Constant(constant)
    }
}

impl Add for Value {
    type Output = Value;
    fn add(self, other: Value) -> Value {
        match (self, other) {
            (Value::Constant(a), Value::Constant(b)) => Value::Constant(a + b),
            (a, b) if b.is_zero() => a,
            (a, b) if a.is_zero() => b,
            (a, b) => Value::Add(Box::new(a), Box::new(b)),
        }
    }
}

impl Neg for Value {
    type Output = Value;
    fn neg(self) -> Value {
        match self {
            Value::Constant(a) => Value::Constant(-a),
            Value::Neg(a) => *a,
            a => Value::Neg(Box::new(a)),
        }
    }
}

impl Sub for Value {
    type Output = Value;
    fn sub(self, other: Value) -> Value {
        self + (-other)
    }
}

impl Mul for Value {
    type Output = Value;
    fn mul(self, other: Value) -> Value {
        match (self, other) {
            (Value::Constant(a), Value::Constant(b)) => Value::Constant(a * b),
            (a, b) if a.is_zero() || b.is_zero() => Value::ZERO,
            (Value::Constant(1.0), b) => b,
            (a, Value::Constant(1.0)) => a,
            (a, b) => Value::Mul(Box::new(a), Box::new(b)),
        }
    }
}

impl Div for Value {
    type Output = Value;
    fn div(self, other: Value) -> Value {
        match (self, other) {
            (Value::Constant(a), Value::Constant(b)) => Value::Constant(a / b),
            (a, _) if a.is_zero() => Value::ZERO,
            (a, Value::Constant(1.0)) => a,
            (a, b) => Value::Div(Box::new(a), Box::new(b)),
        }
    }
}

impl Mul<Value> for f64 {
    type Output = Value;
    fn mul(self, other: Value) -> Value {
        Value::Constant(self) * other
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn quarter_turns_are_exact() {
        for (angle, sin, cos) in [
            (0.0, 0.0, 1.0),
            (FRAC_PI_2, 1.0, 0.0),
            (-FRAC_PI_2, -1.0, 0.0),
            (PI, 0.0, -1.0),
            (1.5 * PI, -1.0, 0.0),
            (-4.5 * PI, -1.0, 0.0),
            (1e6 * PI, 0.0, 1.0),
        ] {
            assert_eq!(Value::Constant(angle).sin_cos(), (sin.into(), cos.into()), "{angle}");
        }
        let (sin, cos) = Value::Constant(1.0).sin_cos();
        assert_eq!((sin, cos), (libm::sin(1.0).into(), libm::cos(1.0).into()));
    }

    #[test]
    fn parameters_stay_live_and_zeros_vanish() {
        let mass = Value::Parameter(ParameterId(0));
        assert_eq!(mass.clone() * Value::ZERO, Value::ZERO);
        assert_eq!(mass.clone() + Value::ZERO, mass);
        assert_eq!((Value::from(2.0) * mass.clone() / Value::from(4.0) - mass).at(&[3.0]), -1.5);
    }
}
