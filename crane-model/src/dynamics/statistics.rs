//! Counts of a run.

/// Counts of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Completed steps.
    pub steps: usize,
    /// Rejected steps, whose error was above the tolerance.
    pub rejections: usize,
    /// Evaluations of the accelerations.
    pub evaluations: usize,
    /// Factorisations of the system of an implicit step.
    pub factorisations: usize,
}
