//! Results as columns with names and units.

mod recording;
mod table;

pub use recording::{Recording, drive_effort};
pub use table::{Column, Table};
