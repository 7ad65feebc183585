//! Static equilibrium by damped Newton–Raphson with the analytic tangent stiffness, and by continuation where that fails.

mod closed;
mod continuation;
mod diagnosis;
mod equations;
mod equilibrium;
mod guess;
mod newton;
mod overloaded;
mod residual_scale;
mod rest;
mod settings;
mod solve;
mod status;
mod tangent;
mod tipped;

pub use diagnosis::Diagnosis;
pub use equilibrium::{Equilibrium, Iteration};
pub(crate) use guess::open_guess;
pub(crate) use overloaded::{REACHED, Reached, reached};
pub use rest::RestSearch;
pub(crate) use rest::advance;
pub use settings::Settings;
pub use solve::Problem;
pub use status::Status;
