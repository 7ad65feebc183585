//! What a run shows and what it took.

use super::{EffortAccuracy, Statistics};

/// One moment of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<'a> {
    /// Time, s.
    pub t: f64,
    /// Generalized coordinates, m and rad.
    pub q: &'a [f64],
    /// Their rates, m/s and rad/s.
    pub v: &'a [f64],
    /// Work that the drives' motions put in since t = 0, J; 0 without audit.
    pub work: f64,
    /// Energy that the dampers took out since t = 0, J; 0 without audit.
    pub dissipated: f64,
}

/// What a run took.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// What it did.
    pub statistics: Statistics,
    /// Step, s; the mean of an adaptive method.
    pub step: f64,
    /// Time reached, s.
    pub time: f64,
    /// The drives' efforts and how far off they may be, by a method that looks at them.
    pub efforts: Vec<EffortAccuracy>,
}
