//! Motion by numerical integration.

#[cfg(feature = "std")]
mod adaptive;
#[cfg(feature = "std")]
pub mod bdf;
#[cfg(feature = "std")]
pub mod dormand_prince;
#[cfg(feature = "std")]
pub mod ensemble;
#[cfg(feature = "std")]
mod method;
#[cfg(feature = "std")]
mod motion;
pub mod rk4;
#[cfg(feature = "std")]
pub mod rosenbrock;
#[cfg(feature = "std")]
mod roughness;
#[cfg(feature = "std")]
mod simulation;
#[cfg(feature = "std")]
mod step;
#[cfg(feature = "std")]
mod stopped;
#[cfg(feature = "std")]
mod system;

#[cfg(feature = "std")]
pub use method::{Method, UnknownMethod};
#[cfg(feature = "std")]
pub use simulation::{Run, Sample, Settings, Statistics, simulate};
#[cfg(feature = "std")]
pub use stopped::{Cause, Stopped};
