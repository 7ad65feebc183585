//! Results as columns with names and units.

mod peaks;
mod recording;
mod table;

pub use peaks::Peaks;
pub use recording::{Recording, drive_effort, stop_effort};
pub use table::{Column, Table};
