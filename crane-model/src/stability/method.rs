//! The stability functions of the methods.

use super::StabilityFunction::{self, Bdf2, Rational};
use crate::dynamics::{Method, dormand_prince, rk4, rosenbrock};

impl Method {
    /// R(z), by which a step multiplies a small motion: for implicit methods with the exact Jacobian, for the backward differentiation formula of order 2,
    /// to which they return if a motion grows at a higher order.
    pub const fn stability(self) -> StabilityFunction {
        match self {
            Method::Rk4 => Rational { numerator: &rk4::STABILITY, denominator: &[1.0] },
            Method::DormandPrince => Rational { numerator: &dormand_prince::STABILITY, denominator: &[1.0] },
            Method::Rosenbrock => Rational { numerator: &rosenbrock::NUMERATOR, denominator: &rosenbrock::DENOMINATOR },
            Method::Bdf => Bdf2,
        }
    }
}
