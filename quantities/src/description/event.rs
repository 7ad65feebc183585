//! Events of a run.

use super::{List, Text};

/// Something that happens at a time of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct EventInfo {
    /// Name.
    pub name: Text,
    /// When, s.
    pub time: f64,
    /// The values of parameters from then on, with their indices.
    pub changes: List<(usize, f64)>,
    /// How masses that are added moved before; `None`: with the crane, so that rates go on.
    pub joins: Option<JoinsInfo>,
}

/// How masses that join the crane moved before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JoinsInfo {
    /// Their velocity along the axes of the world, m/s.
    pub velocity: [f64; 3],
    /// The point of interest at which their centre of mass is; `None` if they were at rest.
    pub point: Option<usize>,
}
