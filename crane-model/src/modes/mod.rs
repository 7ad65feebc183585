//! Small vibrations about a pose at rest: `A δq̈ + D δq̇ + K δq = 0`.

mod damped;
mod eigenvectors;
mod small_motions;
mod undamped;

pub use damped::{DampedMode, damped};
pub use small_motions::SmallMotions;
pub use undamped::{Mode, undamped};

use std::{error::Error, fmt};

/// Why there are no modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoModes {
    /// The mass matrix is not positive definite.
    MassMatrix,
    /// The eigenvalue iteration did not converge.
    Eigenvalues,
}

impl fmt::Display for NoModes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NoModes::MassMatrix => "no modes: the mass matrix is not positive definite",
            NoModes::Eigenvalues => "no modes: the eigenvalue iteration did not converge",
        })
    }
}

impl Error for NoModes {}
