//! Minimum and maximum values of a run, when they occur, and how far off they may be.

use crane_model::{
    Description,
    results::{Extremes, headlines},
    runs::Recorded,
};

use crate::report::{Cell, Grid};

/// A time without the rounding of its sum: 2.28 instead of 2.2800000000000002.
fn instant(time: f64) -> f64 {
    format!("{time:.9}").parse().unwrap_or(time)
}

/// Extremes of all headlines of some runs, a row per quantity and run.
pub fn extremes(description: &Description, runs: &[(&str, &Recorded)]) -> Grid {
    let headers = ["quantity", "crane", "minimum", "time of minimum", "maximum", "time of maximum", "error", "unit"];
    let alone = runs.len() < 2;
    let headers: Vec<&str> = headers.into_iter().filter(|header| !alone || *header != "crane").collect();
    let title = "Extremes of the run with their times in s, and the largest difference from a finer run";
    let mut grid = Grid::new("extremes", title, &headers);
    for kind in headlines(description) {
        for name in &kind.names {
            for (label, run) in runs {
                if run.table.values(name).is_none() {
                    continue;
                }
                let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } = Extremes::of(&run.table, name);
                let error = run.verification.as_ref().and_then(|v| v.difference(&run.table, name));
                let numbers = [minimum, instant(time_of_minimum), maximum, instant(time_of_maximum)].map(Cell::from);
                let crane = (!alone).then(|| Cell::from(*label));
                let row = [Cell::from(name.as_str())].into_iter().chain(crane).chain(numbers);
                grid.row(
                    row.chain([error.map_or(Cell::Empty, Cell::Uncertainty), kind.unit.into()]).collect::<Vec<_>>(),
                );
            }
        }
    }
    grid
}
