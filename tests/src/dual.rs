//! Dual numbers through the interpreter: derivatives independent of the compiler's own rules.

use crane_codegen::symbolic::Scalar;
use num_dual::{Dual64, DualNum};

/// A number with one derivative.
#[derive(Clone, Copy, Debug)]
pub struct Dual(pub Dual64);

impl Dual {
    /// A value and its derivative.
    #[must_use]
    pub fn new(value: f64, derivative: f64) -> Self {
        Dual(Dual64::new(value, derivative))
    }

    /// The value.
    #[must_use]
    pub fn value(self) -> f64 {
        self.0.re
    }

    /// The derivative.
    #[must_use]
    pub fn derivative(self) -> f64 {
        self.0.eps
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl std::ops::$trait for Dual {
            type Output = Dual;
            fn $method(self, other: Dual) -> Dual {
                Dual(std::ops::$trait::$method(self.0, other.0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl std::ops::Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(-self.0)
    }
}

impl Scalar for Dual {
    fn from_f64(value: f64) -> Self {
        Dual::new(value, 0.0)
    }
    fn sin_cos(&self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Dual(sin), Dual(cos))
    }
    fn min(self, other: Self) -> Self {
        if other.0.re < self.0.re { other } else { self }
    }
    fn max(self, other: Self) -> Self {
        if other.0.re > self.0.re { other } else { self }
    }
    fn sqrt(&self) -> Self {
        Dual(self.0.sqrt())
    }
    fn exp(&self) -> Self {
        Dual(self.0.exp())
    }
    fn select(&self, positive: Self, other: Self) -> Self {
        if self.0.re > 0.0 { positive } else { other }
    }
}
