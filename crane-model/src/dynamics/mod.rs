//! Motion by numerical integration.

#[cfg(feature = "std")]
mod adaptive;
#[cfg(feature = "std")]
pub mod bdf;
#[cfg(feature = "std")]
mod connector_update;
#[cfg(feature = "std")]
mod constant;
#[cfg(feature = "std")]
mod contacts;
#[cfg(feature = "std")]
mod course;
#[cfg(feature = "std")]
pub mod dormand_prince;
#[cfg(feature = "std")]
mod energy_integrals;
#[cfg(feature = "std")]
pub mod ensemble;
#[cfg(feature = "std")]
mod equations;
#[cfg(feature = "std")]
mod events;
#[cfg(feature = "std")]
mod force_state_update;
#[cfg(feature = "std")]
pub mod gradients;
#[cfg(feature = "std")]
mod integration;
#[cfg(feature = "std")]
mod method;
#[cfg(feature = "std")]
mod motion;
#[cfg(feature = "std")]
mod norm;
#[cfg(feature = "std")]
mod references;
pub mod rk4;
#[cfg(feature = "std")]
pub mod rosenbrock;
#[cfg(feature = "std")]
mod roughness;
#[cfg(feature = "std")]
mod run;
#[cfg(feature = "std")]
mod settings;
#[cfg(feature = "std")]
mod simulation;
mod state;
#[cfg(feature = "std")]
mod statistics;
#[cfg(feature = "std")]
mod step;
#[cfg(feature = "std")]
mod stepper;
#[cfg(feature = "std")]
mod stopped;
#[cfg(feature = "std")]
mod stops;
#[cfg(feature = "std")]
mod switches;
#[cfg(feature = "std")]
mod system;
#[cfg(feature = "std")]
mod typed;
#[cfg(feature = "std")]
mod watch;

#[cfg(feature = "std")]
pub use constant::Rk4;
#[cfg(feature = "std")]
pub use contacts::Contacts;
#[cfg(feature = "std")]
pub use course::{Course, Happening, Progress};
#[cfg(feature = "std")]
pub use events::{Phases, Quantities, ResultsAt, after as crane_after, event_times, without_events};
#[cfg(feature = "std")]
pub use integration::Integration;
#[cfg(feature = "std")]
pub use method::{Method, UnknownMethod};
#[cfg(feature = "std")]
pub use norm::EffortAccuracy;
#[cfg(feature = "std")]
pub use run::{Run, Sample};
#[cfg(feature = "std")]
pub use settings::Settings;
#[cfg(feature = "std")]
pub use simulation::Simulation;
#[cfg(feature = "std")]
pub use state::InitialState;
pub use state::{NotFinite, State, acceleration};
#[cfg(feature = "std")]
pub use statistics::Statistics;
#[cfg(feature = "std")]
pub use stepper::{Ahead, Steered, Stepper};
#[cfg(feature = "std")]
pub use stopped::{Cause, Stopped};
#[cfg(feature = "std")]
pub use stops::next_stop;
#[cfg(feature = "std")]
pub use watch::Watch;
