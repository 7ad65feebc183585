//! The methods that integrate a motion, by name.

use std::{fmt, str::FromStr};

/// A method of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The classical Runge–Kutta method, constant step: [`rk4`](super::rk4).
    Rk4,
    /// The explicit pair of Dormand and Prince, adaptive: [`dormand_prince`](super::dormand_prince).
    DormandPrince,
    /// A linearly implicit W-method for stiff motions, adaptive: [`rosenbrock`](super::rosenbrock).
    Rosenbrock,
    /// Backward differentiation formulas of variable order for stiff motions, adaptive: [`bdf`](super::bdf). The best choice at
    /// usual accuracies, for soft and stiff cranes; measured in docs/error-vs-runtime.md.
    #[default]
    Bdf,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 4] = [Method::Rk4, Method::DormandPrince, Method::Rosenbrock, Method::Bdf];

    /// The default.
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

    /// One-line description.
    pub const fn title(self) -> &'static str {
        match self {
            Method::Rk4 => "classical Runge-Kutta, order 4, constant step",
            Method::DormandPrince => "Dormand-Prince, orders 5 and 4, explicit, adaptive",
            Method::Rosenbrock => "Rosenbrock W-method, orders 4 and 3, linearly implicit, adaptive",
            Method::Bdf => "backward differentiation formulas, orders 1 to 4, implicit, adaptive",
        }
    }

    /// Order of consistency; the highest, if it varies.
    pub const fn order(self) -> usize {
        match self {
            Method::Rk4 | Method::Rosenbrock | Method::Bdf => 4,
            Method::DormandPrince => 5,
        }
    }

    /// Whether it adapts its steps to a tolerance.
    pub const fn is_adaptive(self) -> bool {
        match self {
            Method::Rk4 => false,
            Method::DormandPrince | Method::Rosenbrock | Method::Bdf => true,
        }
    }

    /// Whether its step size has a stability limit, whatever the damping.
    pub const fn is_explicit(self) -> bool {
        match self {
            Method::Rk4 | Method::DormandPrince => true,
            Method::Rosenbrock | Method::Bdf => false,
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
