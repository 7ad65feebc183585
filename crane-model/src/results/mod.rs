//! Results as columns with names and units, their extremes, their errors, and cautions about them.

pub mod cautions;
mod connectors;
mod cylinders;
mod duties;
mod extremes;
mod feet;
mod headlines;
mod history;
mod key_figures;
mod limits;
mod loads;
mod loops;
pub(crate) mod overlaps;
mod peaks;
mod recording;
mod servos;
mod table;
mod telescopes;
pub mod verification;

pub(crate) use cylinders::unassembled;
pub use cylinders::{HighestPressure, beyond_stroke, highest_pressure};
pub use duties::{CylinderDuty, DriveDuty, Duties, PumpDuty};
pub use extremes::Extremes;
pub use feet::{Lift, Pull, TipsOver, lifts, pulls, tips_over, vertical_reaction};
pub use headlines::{Kind, ROUNDING, headlines};
pub use history::{Instant, instants, stressed_over};
pub use key_figures::KeyFigure;
pub use peaks::Peaks;
pub(crate) use recording::{FleetRecording, drive_efforts_with, energies_with, quantities_with};
pub use recording::{
    QUANTITIES, Recording, connector_force, drive_effort, friction_utilisation, quantities, quantities_at, stop_effort,
    support_gap,
};
pub use table::Table;
pub use verification::Verification;

pub use crate::column::{Column, column_name};
pub use crate::hydraulics::{CylinderState, cylinders_at};
