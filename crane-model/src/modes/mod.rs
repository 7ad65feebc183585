//! Small vibrations about a pose at rest or a steady motion: `A δq̈ + D δq̇ + K δq = 0`.

mod damped;
mod eigenvectors;
mod small_motions;
mod state_space;
mod steady;
mod undamped;

pub use damped::{ComplexShape, DampedMode, damped, damped_with_shapes};
pub use small_motions::SmallMotions;
pub use state_space::StateSpace;
pub use steady::{Held, NotSteady, Steady, steady};
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
