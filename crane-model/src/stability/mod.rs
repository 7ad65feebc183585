//! Stability of a time step, computed before a run.
//!
//! A method multiplies a small motion `e^{λt}` by R(hλ) per step. The run is stable where |R(hλ)| ≤ 1 for every eigenvalue λ of
//! the damped crane, linearised about its pose.

mod boundary;
mod function;
mod limit;
mod method;
mod words;

pub use function::StabilityFunction;
pub use limit::{Limit, limit};
pub use words::{cause, grouped};
