//! Live parameters, and the rules of the language for their values.

use crane_quantities::{Bound, Refusal};

use super::{Chain, Value};

/// A live parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, a valid Rust identifier.
    pub name: String,
    /// Unit as written by the user, for tables.
    pub unit: String,
    /// Its description.
    pub about: String,
    /// Value unless set at run time.
    pub default: f64,
    /// The smallest value that every use of the parameter allows; `None`: any number.
    pub lower_bound: Option<Bound>,
}

impl Parameter {
    /// Raises the lower end of the range, unless it is already as high.
    pub fn raise(&mut self, bound: Bound) {
        let end = |bound: &Bound| (bound.value, !bound.allowed);
        if self.lower_bound.as_ref().is_none_or(|held| end(&bound) > end(held)) {
            self.lower_bound = Some(bound);
        }
    }
}

/// A rule about several numbers, some of which are live.
#[derive(Clone, Debug, PartialEq)]
pub struct Relation {
    /// The rule holds if this is above zero.
    pub margin: Value,
    /// The message if it does not hold.
    pub refusal: Refusal,
}

impl Chain {
    /// The first rule about several numbers that these values of the parameters break.
    ///
    /// # Panics
    /// If `parameters` is shorter than the chain's list of parameters.
    #[must_use]
    pub fn broken_relation(&self, parameters: &[f64]) -> Option<&Relation> {
        self.relations.iter().find(|relation| {
            let margin = relation.margin.at(parameters);
            margin.is_nan() || margin <= 0.0
        })
    }
}
