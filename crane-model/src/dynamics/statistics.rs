//! What a run did.

/// What a run did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Steps done.
    pub steps: usize,
    /// Steps tried in vain: their error was above the tolerance.
    pub rejections: usize,
    /// Evaluations of the accelerations.
    pub evaluations: usize,
    /// Factorisations of the system of an implicit step.
    pub factorisations: usize,
}
