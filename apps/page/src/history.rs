//! Internal forces and tipping lines over a run.

pub use crane_model::results::{Instant, instants};
