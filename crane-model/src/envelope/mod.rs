//! Envelopes: the largest load within limits, over ranges of poses and parameters.
//!
//! A pose is where the drives stand; what they do not hold, such as a load on its hinge or a beam, follows from equilibrium. For
//! each pose the load is the largest one up to which every smaller one, from the least on, rests within all [`Limits`].
//!
//! Where moments, stresses and efforts grow with the load, that is the largest load of all. A crane that needs a load to be within
//! its limits, such as one whose counterweight tips it, has no rating.
//!
//! Poses are rated in pieces: a row of neighbours, each from the equilibrium of its predecessor. A piece is the same whatever else
//! is rated, on however many threads.

mod axes;
mod condition;
mod limits;
mod radius;
mod rating;
mod search;
mod sweep;

pub use axes::{Axes, Axis, Varied};
pub use condition::Condition;
pub use limits::{Limit, Limits};
pub use radius::SlewAxis;
pub use rating::Rating;
pub use sweep::{Conduct, Envelope, PIECE, only_mass, range_of_loads};
