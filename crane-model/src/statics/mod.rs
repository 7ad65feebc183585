//! Static equilibrium by damped Newton–Raphson with the analytic tangent stiffness, and by continuation where that fails.

mod balance;
mod continuation;
mod equilibrium;
mod guess;
mod newton;
mod status;
mod tangent;

pub use equilibrium::{Equilibrium, Iteration, Settings, solve, solve_at};
pub use guess::guess;
pub use status::Status;
