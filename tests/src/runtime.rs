//! 64-bit numbers with the runtime's sine and cosine, so that the interpreter rounds as generated code does.

use crane_codegen::symbolic::Scalar;
use crane_model::rt;

/// A number that computes as generated code does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Runtime(pub f64);

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl std::ops::$trait for Runtime {
            type Output = Runtime;
            fn $method(self, other: Runtime) -> Runtime {
                Runtime(self.0.$method(other.0))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl std::ops::Neg for Runtime {
    type Output = Runtime;
    fn neg(self) -> Runtime {
        Runtime(-self.0)
    }
}

impl Scalar for Runtime {
    fn from_f64(value: f64) -> Self {
        Runtime(value)
    }
    fn sin_cos(&self) -> (Self, Self) {
        let ([sin], [cos]) = rt::sin_cos([self.0]);
        (Runtime(sin), Runtime(cos))
    }
    fn stumpff(&self, k: u8) -> Self {
        Runtime(rt::stumpff([self.0])[usize::from(k)][0])
    }
    fn min(self, other: Self) -> Self {
        Runtime(self.0.min(other.0))
    }
    fn max(self, other: Self) -> Self {
        Runtime(self.0.max(other.0))
    }
    fn sqrt(&self) -> Self {
        Runtime(rt::sqrt(self.0))
    }
    fn exp(&self) -> Self {
        Runtime(rt::exp(self.0))
    }
    fn select(&self, positive: Self, other: Self) -> Self {
        Runtime(rt::select(self.0, positive.0, other.0))
    }
}
