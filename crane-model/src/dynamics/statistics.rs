//! Counts of a run.

/// Counts of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Completed steps.
    pub steps: usize,
    /// Rejected steps: their error was above the tolerance, or a contact changed during them.
    pub rejections: usize,
    /// Evaluations of the accelerations.
    pub evaluations: usize,
    /// Factorisations of the system of an implicit step.
    pub factorisations: usize,
}
