//! Events of a run.

use super::{Constant, Entries, FixedAngle, Spanned};
use crate::node::FromNode;

/// Something that happens at a time of a run or on a condition: from then on, parameters have other values.
#[derive(Clone, Debug, FromNode)]
pub struct Event {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// Its time. Either this or `when`.
    #[key(unit = "s", limit = Positive)]
    pub at: Option<Spanned<Constant>>,
    /// The condition on which it happens, once. Either this or `at`.
    pub when: Option<Spanned<Condition>>,
    /// The values of parameters from then on, by name.
    #[key(unit = "its own")]
    pub set: Spanned<Entries<FixedAngle>>,
    /// How masses that are added moved before. Default: with the crane.
    pub joins: Option<Spanned<Joins>>,
}

/// That a result passes a value.
#[derive(Clone, Debug, FromNode)]
pub struct Condition {
    /// The result: the name of a column of runs, such as `hook_z`.
    pub result: Spanned<String>,
    /// The value above which it rises. Either this or `below`.
    #[key(unit = "its own")]
    pub above: Option<Spanned<FixedAngle>>,
    /// The value below which it falls. Either this or `above`.
    #[key(unit = "its own")]
    pub below: Option<Spanned<FixedAngle>>,
}

/// How masses that join the crane moved before: with them, their momentum joins it, and rates jump.
#[derive(Clone, Debug, FromNode)]
pub struct Joins {
    /// Their velocity along the axes of the world. Default: `[0, 0, 0]`, at rest.
    #[key(unit = "m/s", usual = 0.0..50.0)]
    pub velocity: Option<Spanned<[Spanned<Constant>; 3]>>,
    /// The point of interest at which their centre of mass is; required with a `velocity`.
    pub point: Option<Spanned<String>>,
}
