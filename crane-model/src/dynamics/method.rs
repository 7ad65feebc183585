//! The methods that integrate a motion, by name.

use std::{fmt, str::FromStr};

use super::rk4;
use crate::stability::StabilityFunction;

/// A method of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The classical Runge–Kutta method: [`rk4`].
    #[default]
    Rk4,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 1] = [Method::Rk4];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Rk4 => "rk4",
        }
    }

    /// One line for people.
    pub const fn title(self) -> &'static str {
        match self {
            Method::Rk4 => "classical Runge-Kutta, order 4, constant step",
        }
    }

    /// Order of consistency.
    pub const fn order(self) -> usize {
        match self {
            Method::Rk4 => 4,
        }
    }

    /// R(z), by which a step multiplies a small motion.
    pub const fn stability(self) -> StabilityFunction {
        match self {
            Method::Rk4 => StabilityFunction { numerator: &rk4::STABILITY, denominator: &[1.0] },
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
