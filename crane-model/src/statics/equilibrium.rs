//! Result of a static solution.

use std::fmt;

use super::{Settings, Status};

/// One pose of the iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Scaled residual.
    pub residual: f64,
    /// Fraction of the Newton step that led here: 1 for a full step, 0 at the first pose.
    pub fraction: f64,
}

/// Result of the search.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Whether `q` is an equilibrium, and of what kind.
    pub status: Status,
    /// Last pose, m and rad.
    pub q: Vec<f64>,
    /// The first pose, which is the guess or the end of the continuation, and the pose after each Newton step.
    pub history: Vec<Iteration>,
    /// Load steps of the continuation that led to the first pose; `None` where Newton's method needed none.
    pub load_steps: Option<usize>,
}

impl Equilibrium {
    /// Newton steps done, after the continuation if there was one.
    pub fn steps(&self) -> usize {
        self.history.len().saturating_sub(1)
    }

    /// Whether the first two steps of Newton's method were whole ones, and each left a quarter of the residual on average, or less.
    ///
    /// Just that much is left at a double root, where a path ends, and more beyond; by the theorem of Newton and Kantorovich an equilibrium with less is the one nearby:
    /// P. Deuflhard, Newton Methods for Nonlinear Problems, Springer 2004, section 5.1.
    pub(crate) fn contracts(&self) -> bool {
        match self.history.as_slice() {
            [begin, first, second, ..] => {
                first.fraction == 1.0 && second.fraction == 1.0 && second.residual <= begin.residual / 16.0
            }
            _ => true,
        }
    }

    /// Whether `q` is a stable equilibrium.
    pub fn is_stable(&self) -> bool {
        self.status == Status::Converged
    }

    /// Whether the crane is at rest at `q`, stable or not, so that forces there mean something.
    pub fn rests(&self) -> bool {
        match self.status {
            Status::Converged | Status::Unstable { .. } => true,
            Status::Singular { .. } => self.at_rest(&Settings::default()),
            Status::TipsOver { .. }
            | Status::Floats
            | Status::Slides { .. }
            | Status::Overflow
            | Status::NotConverged => false,
        }
    }

    /// Whether `q` is an equilibrium.
    pub(super) fn at_rest(&self, settings: &Settings) -> bool {
        self.residual() <= settings.tolerance
    }

    /// Scaled residual at `q`.
    pub fn residual(&self) -> f64 {
        self.history.last().map_or(f64::NAN, |last| last.residual)
    }
}

impl fmt::Display for Equilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = self.steps();
        write!(f, "{}; {steps} Newton {}", self.status, if steps == 1 { "step" } else { "steps" })?;
        match self.load_steps {
            Some(count) => write!(f, " after continuation in {count} load steps"),
            None => Ok(()),
        }
    }
}
