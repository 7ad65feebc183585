//! Events of a run.

use super::ParameterId;

/// Something that happens at a time of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Name.
    pub name: String,
    /// When, s.
    pub time: f64,
    /// The values of parameters from then on.
    pub changes: Vec<(ParameterId, f64)>,
    /// How masses that are added moved before; `None`: with the crane.
    pub joins: Option<Joins>,
}

/// How masses that join the crane moved before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joins {
    /// Their velocity along the axes of the world, m/s.
    pub velocity: [f64; 3],
    /// The point of interest at which their centre of mass is; `None` if they were at rest.
    pub point: Option<usize>,
}
