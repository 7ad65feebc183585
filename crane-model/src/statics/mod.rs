//! Static equilibrium by damped Newton–Raphson with the analytic tangent stiffness.

mod balance;
mod guess;
mod newton;
mod status;
mod tangent;

pub use guess::guess;
pub use newton::{Equilibrium, Iteration, Settings, solve, solve_at};
pub use status::Status;
