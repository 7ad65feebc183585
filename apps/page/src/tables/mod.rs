//! Tables of results: those of the page, and what the command prints.
//!
//! | module | content |
//! |---|---|
//! | `cell`, `grid`, `report` | fields, tables with named columns, tables in order with facts and cautions |
//! | `statics` | cranes in equilibrium, side by side |
//! | `runs` | extremes, work and time of runs, what drives must be able to do |
//! | `modes` | modes and the largest stable steps |
//! | `page` | all tables of a page |
//! | `mistakes` | mistakes of a spec and warnings about it, for programs |

mod cell;
mod grid;
mod mistakes;
mod modes;
mod page;
mod report;
mod runs;
mod statics;

pub use cell::{Cell, number_text};
pub(crate) use cell::{readable, uncertain};
pub use grid::{Grid, Heading, VALUE};
pub use mistakes::diagnostics;
pub use modes::{damped_mode, damped_modes, names, stable_steps, undamped_modes};
pub use page::of_page;
pub use report::{FORMAT, Report};
pub(crate) use runs::pace;
pub use runs::{add_duties, add_events, add_runs, caution_of_runs, extremes};
pub use statics::{Case, FLEXIBLE, RIGID, deflection, equilibria, verdicts};
