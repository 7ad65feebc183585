//! Dual numbers through the interpreter: derivatives independent of the compiler's own rules.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crane_codegen::symbolic::Scalar;

/// A number with one derivative: `a + a′ε` with `ε² = 0`.
#[derive(Clone, Copy, Debug)]
pub struct Dual {
    value: f64,
    derivative: f64,
}

impl Dual {
    /// A value and its derivative.
    #[must_use]
    pub fn new(value: f64, derivative: f64) -> Self {
        Dual { value, derivative }
    }

    /// The value.
    #[must_use]
    pub fn value(self) -> f64 {
        self.value
    }

    /// The derivative.
    #[must_use]
    pub fn derivative(self) -> f64 {
        self.derivative
    }

    /// A function of it, by its value and its slope there.
    fn chain(self, value: f64, slope: f64) -> Self {
        Dual::new(value, slope * self.derivative)
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual::new(self.value + other.value, self.derivative + other.derivative)
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, other: Dual) -> Dual {
        Dual::new(self.value - other.value, self.derivative - other.derivative)
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        Dual::new(self.value * other.value, self.derivative * other.value + self.value * other.derivative)
    }
}

impl Div for Dual {
    type Output = Dual;
    fn div(self, other: Dual) -> Dual {
        let value = self.value / other.value;
        Dual::new(value, (self.derivative - value * other.derivative) / other.value)
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual::new(-self.value, -self.derivative)
    }
}

impl Scalar for Dual {
    fn from_f64(value: f64) -> Self {
        Dual::new(value, 0.0)
    }
    fn sin_cos(&self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
    fn min(self, other: Self) -> Self {
        if other.value < self.value { other } else { self }
    }
    fn max(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
    }
    fn sqrt(&self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    fn exp(&self) -> Self {
        let exponential = self.value.exp();
        self.chain(exponential, exponential)
    }
    fn select(&self, positive: Self, other: Self) -> Self {
        if self.value > 0.0 { positive } else { other }
    }
}
