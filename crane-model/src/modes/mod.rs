//! Small vibrations about a pose at rest or a steady motion: `A δq̈ + D δq̇ + K δq = 0`.

mod damped;
mod decays;
mod eigenvectors;
mod held;
mod servos;
mod small_motions;
mod state_space;
mod steady;
mod undamped;
mod verdict;
mod vibrations;

pub(crate) use damped::eigenvalues;
pub use damped::{ComplexShape, DampedMode, damped, damped_with_shapes};
pub use decays::decays;
pub(crate) use held::{stiffen_by_bristles, stiffen_by_oil};
pub use servos::{UnstableServo, unstable_servos, with_servos};
pub use small_motions::SmallMotions;
pub(crate) use small_motions::independent_motions;
pub use state_space::StateSpace;
pub use steady::{Held, NotSteady, Steady, steady};
pub use undamped::{Mode, undamped};
pub use verdict::{GROWTH, damping_ratio, grows};
pub use vibrations::{Vibration, vibrations};

use std::{error::Error, fmt};

/// Why there are no modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoModes {
    /// The mass matrix is not positive definite.
    MassMatrix,
    /// The eigenvalue iteration did not converge.
    Eigenvalues,
    /// A coefficient of the small motions is not a number: the crane does not have the functions for them, or forces overflow.
    NotFinite,
}

impl fmt::Display for NoModes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NoModes::MassMatrix => "no modes: the mass matrix is not positive definite",
            NoModes::Eigenvalues => "no modes: the eigenvalue iteration did not converge",
            NoModes::NotFinite => {
                "no modes: mass, stiffness or damping is not a finite number: forces overflow, or `analyses` of the spec leave out `modes`, \
                 or `motion_derivatives` of small motions about a motion"
            }
        })
    }
}

impl Error for NoModes {}
