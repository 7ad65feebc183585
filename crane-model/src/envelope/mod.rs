//! Envelopes: the largest load within limits, over ranges of poses and parameters.
//!
//! A pose is given by the positions of the drives; whatever they do not hold, such as a hanging load or a flexible beam, follows from
//! equilibrium. The load of a pose is the largest one for which the crane rests within all [`Limits`] with it and with every smaller load,
//! down to the minimum, on one path of poses: a crane that snaps through to another rest has reached its end.
//!
//! Where moments, stresses and efforts grow with the load, that is the maximum load overall. A crane that needs a load to be within its
//! limits, such as one that its counterweight tips over, has no rating.
//!
//! [`critical_load`] uses the same search for the load that lifts the first foot and the load that tips the crane, at one pose.
//!
//! [`load_factor`] uses it for all weights and loads at once: buckling. [`second_order`] makes them small.
//!
//! Poses are rated in pieces: a piece is a row of neighbouring poses, each starting from the equilibrium of the previous one. Its result
//! depends neither on what else is rated nor on the number of threads.

mod axes;
mod condition;
mod coverage;
mod critical;
mod limits;
mod load_factor;
mod rating;
mod search;
mod second_order;
mod sweep;

pub use axes::{Axes, Axis, TURN, Varied};
pub use condition::{Condition, Margin};
pub use coverage::Coverage;
pub use critical::{Critical, CriticalLoad, NoCriticalLoad, critical_load};
pub use limits::{Limit, Limits, PartLimit};
pub use load_factor::{Followed, LoadFactor, load_factor};
pub use rating::Rating;
pub use second_order::{SecondOrder, second_order};
pub use sweep::{Envelope, Execution, PIECE, UNITS_OF_LOADS, is_load, only_mass, range_of_loads};
