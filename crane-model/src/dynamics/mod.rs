//! Motion by numerical integration.

#[cfg(feature = "std")]
pub mod ensemble;
#[cfg(feature = "std")]
mod method;
pub mod rk4;
#[cfg(feature = "std")]
mod roughness;
#[cfg(feature = "std")]
mod simulation;
#[cfg(feature = "std")]
mod stopped;

#[cfg(feature = "std")]
pub use method::{Method, UnknownMethod};
#[cfg(feature = "std")]
pub use simulation::{Run, Sample, Settings, simulate};
#[cfg(feature = "std")]
pub use stopped::{Cause, Stopped};
