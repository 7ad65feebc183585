//! Combinations of weights and loads.

use super::{Constant, Entries, Spanned};
use crate::node::FromNode;

/// Partial factors of weights and loads, with which statics and strength are verified. What is not named is as written.
#[derive(Clone, Debug, FromNode)]
pub struct Combination {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// Factor of the weight of everything. Default 1.
    #[key(unit = "1", limit = Positive, usual = 0.1..10.0)]
    pub weight: Option<Spanned<Constant>>,
    /// Factors of the weight of masses that are live parameters in kg, such as a payload, in place of that of `weight`, by name.
    #[key(unit = "1", limit = Positive, usual = 0.1..10.0)]
    pub masses: Option<Spanned<Entries<Constant>>>,
    /// Factors of `loads`, by name; 0 leaves a load out. Default 1.
    #[key(unit = "1", usual = 0.01..10.0)]
    pub loads: Option<Spanned<Entries<Constant>>>,
}
