//! Live parameters, and what the rules of the language ask of their values.

use super::{Chain, Value};

/// A live parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, a valid Rust identifier.
    pub name: String,
    /// Unit as written by the user, for tables.
    pub unit: String,
    /// What it is.
    pub about: String,
    /// Value unless set at run time.
    pub default: f64,
    /// The least value that every use of the parameter allows; `None`: any that a number may have.
    pub least: Option<Bound>,
}

/// The lower end of the range of a live parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// The least value.
    pub value: f64,
    /// Whether the parameter may be equal to it.
    pub allowed: bool,
    /// What to say of a value beyond it.
    pub refusal: Refusal,
}

/// What the compiler says of live parameters that break a rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Code of the rule, such as `E031`.
    pub code: &'static str,
    /// What is wrong; of a [`Bound`], the value that is refused follows.
    pub title: String,
    /// What to write instead.
    pub help: String,
}

impl Parameter {
    /// Raises the lower end of the range, unless it is as high already.
    pub fn raise(&mut self, bound: Bound) {
        let end = |bound: &Bound| (bound.value, !bound.allowed);
        if self.least.as_ref().is_none_or(|held| end(&bound) > end(held)) {
            self.least = Some(bound);
        }
    }
}

/// A rule that joins several numbers of which some are live.
#[derive(Clone, Debug, PartialEq)]
pub struct Relation {
    /// The rule holds where this is above zero.
    pub margin: Value,
    /// What to say where it does not hold.
    pub refusal: Refusal,
}

impl Chain {
    /// The first rule that joins several numbers which these values of the parameters break.
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
