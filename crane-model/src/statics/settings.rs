//! When a static solution stops.

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Maximum scaled residual `‖r/scale‖` of an equilibrium: the fraction of the balancing forces that is left over.
    pub tolerance: f64,
    /// Newton steps before giving up.
    pub iterations: usize,
    /// Load steps of a continuation before giving up; 0 for none.
    pub load_steps: usize,
}

impl Default for Settings {
    /// 1e-10 is 1e-5 N on a crane of ten tonnes and 1e4 times the rounding error; good guesses need 3 to 5 steps. A crane
    /// that sinks by several radians needs about 100 load steps.
    fn default() -> Self {
        Self { tolerance: 1e-10, iterations: 50, load_steps: 1000 }
    }
}
