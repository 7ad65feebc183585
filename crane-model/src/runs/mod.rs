//! Complete runs of one crane or many: from the equilibrium, recorded, with an estimate of their error and with cautions.

mod adjoint;
mod effort;
pub mod ensemble;
mod failed;
mod gradients;
mod manoeuvre;
mod measure;
mod quasi_static;
mod recorded;
mod start;

pub use adjoint::{Transposed, record_adjoint};
pub use effort::{Effort, large_effort};
pub use failed::{Failed, Reason};
pub use gradients::{Gradients, record_gradients};
pub use manoeuvre::{Bound, POSES, Pose, SAFE, limiting_modes, manoeuvre, step_limit};
pub use measure::Measure;
pub use quasi_static::QuasiStatic;
pub use recorded::{Recorded, check, imbalance, record, record_checked};
pub use start::{EQUILIBRIUM, EQUILIBRIUM_MOVING, GUESS, GUESS_MOVING, Start};
