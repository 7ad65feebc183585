//! Runs as a user asks for them: from the pose where the crane rests, recorded, with an estimate of their error and with cautions;
//! one crane, or many.

pub mod ensemble;
mod failed;
mod manoeuvre;
mod recorded;
mod start;

pub use failed::{Failed, Reason};
pub use manoeuvre::{Bound, POSES, Pose, SAFE, manoeuvre, step_limit};
pub use recorded::{Recorded, imbalance, record, record_checked};
pub use start::{EQUILIBRIUM, GUESS, Start};
