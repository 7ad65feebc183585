//! Events of a run.

use core::fmt;

use super::{List, Text};

/// Something that happens during a run.
#[derive(Clone, Debug, PartialEq)]
pub struct EventInfo {
    /// Name.
    pub name: Text,
    /// When.
    pub moment: Moment,
    /// The values of parameters from then on, with their indices.
    pub changes: List<(usize, f64)>,
    /// How masses that are added moved before; `None`: with the crane, so that rates go on.
    pub joins: Option<JoinsInfo>,
}

/// When an event happens.
#[derive(Clone, PartialEq)]
pub enum Moment {
    /// At a time, s.
    At(f64),
    /// As soon as a result passes a value: each run finds the time.
    When(ConditionInfo),
}

impl fmt::Debug for Moment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Moment::At(time) => f.debug_tuple("Moment::At").field(time).finish(),
            Moment::When(condition) => f.debug_tuple("Moment::When").field(condition).finish(),
        }
    }
}

/// That a result is on one side of a value.
#[derive(Clone, Debug, PartialEq)]
pub struct ConditionInfo {
    /// The column of results.
    pub result: Text,
    /// Its unit.
    pub unit: Text,
    /// Whether the result is above the value, or below it.
    pub above: bool,
    /// The value, in this unit.
    pub value: f64,
}

impl ConditionInfo {
    /// Whether it holds at a value of the result.
    pub fn is_met(&self, result: f64) -> bool {
        if self.above { result > self.value } else { result < self.value }
    }
}

impl fmt::Display for ConditionInfo {
    /// What happens when it comes to hold, such as `hook_z rises above 1.5 m`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { result, unit, above, value } = self;
        let passes = if *above { "rises above" } else { "falls below" };
        write!(f, "{} {passes} {value} {}", result.as_str(), unit.as_str())
    }
}

/// How masses that join the crane moved before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JoinsInfo {
    /// Their velocity along the axes of the world, m/s.
    pub velocity: [f64; 3],
    /// The point of interest at which their centre of mass is; `None` if they were at rest.
    pub point: Option<usize>,
}
