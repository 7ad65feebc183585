//! The methods that integrate a motion, by name.

use std::{fmt, str::FromStr};

use super::{bdf, dormand_prince, rk4, rosenbrock};
use crate::stability::StabilityFunction;

/// A method of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The classical Runge–Kutta method, constant step: [`rk4`].
    #[default]
    Rk4,
    /// The explicit pair of Dormand and Prince, adaptive: [`dormand_prince`].
    DormandPrince,
    /// A linearly implicit W-method for stiff motions, adaptive: [`rosenbrock`].
    Rosenbrock,
    /// Backward differentiation formulas of variable order for stiff motions, adaptive: [`bdf`].
    Bdf,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 4] = [Method::Rk4, Method::DormandPrince, Method::Rosenbrock, Method::Bdf];

    /// What is best where engineers look, on cranes from soft to stiff. Measured: docs/error-vs-runtime.md.
    pub const RECOMMENDED: Method = Method::Bdf;

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Rk4 => "rk4",
            Method::DormandPrince => "dopri5",
            Method::Rosenbrock => "rosw4",
            Method::Bdf => "bdf",
        }
    }

    /// One line for people.
    pub const fn title(self) -> &'static str {
        match self {
            Method::Rk4 => "classical Runge-Kutta, order 4, constant step",
            Method::DormandPrince => "Dormand-Prince, orders 5 and 4, explicit, adaptive",
            Method::Rosenbrock => "Rosenbrock W-method, orders 4 and 3, linearly implicit, adaptive",
            Method::Bdf => "backward differentiation formulas, orders 1 to 4, implicit, adaptive",
        }
    }

    /// Order of consistency; the highest, where it varies.
    pub const fn order(self) -> usize {
        match self {
            Method::Rk4 | Method::Rosenbrock => 4,
            Method::Bdf => bdf::ORDER,
            Method::DormandPrince => 5,
        }
    }

    /// Whether it chooses its steps for a tolerance.
    pub const fn is_adaptive(self) -> bool {
        !matches!(self, Method::Rk4)
    }

    /// Whether its steps have a limit of stability whatever the damping.
    pub const fn is_explicit(self) -> bool {
        matches!(self, Method::Rk4 | Method::DormandPrince)
    }

    /// R(z), by which a step multiplies a small motion; of an implicit method with the exact Jacobian. Of backward differences that of
    /// order 2, to which they return where a motion grows at a higher one.
    pub const fn stability(self) -> StabilityFunction {
        use StabilityFunction::{Backward, Rational};
        match self {
            Method::Rk4 => Rational { numerator: &rk4::STABILITY, denominator: &[1.0] },
            Method::DormandPrince => Rational { numerator: &dormand_prince::STABILITY, denominator: &[1.0] },
            Method::Rosenbrock => Rational { numerator: &rosenbrock::NUMERATOR, denominator: &rosenbrock::DENOMINATOR },
            Method::Bdf => Backward,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// There is no method of this name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownMethod(pub String);

impl fmt::Display for UnknownMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = Method::ALL.map(Method::name).join(", ");
        write!(f, "there is no method `{}`; methods: {names}", self.0)
    }
}

impl std::error::Error for UnknownMethod {}

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        Method::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| UnknownMethod(name.to_owned()))
    }
}
