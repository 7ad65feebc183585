//! Units: what may stand behind a number, `320 bar`, and the dimension that it must have.
//!
//! Every unit is a power of ten, of 60 and of π/180 of an SI unit, so that a number with a unit is converted with a single rounding
//! (angles: with three).

mod quantity;
mod table;
mod unit;

pub use quantity::{Quantity, WrongQuantity, name_and_unit, number_in, split};
pub use table::{Symbol, TABLE};
pub use unit::{Dimension, Unit, UnknownUnit};
