//! Runs: minimum and maximum values, when they occur, and how far off they may be; work, energy balance and time.

use crane_model::{
    Description,
    results::{Extremes, headlines},
    runs::Recorded,
};

use super::{Cell, Grid, Heading, Report, VALUE};

/// A time without the rounding of its sum: 2.28 instead of 2.2800000000000002.
fn instant(time: f64) -> f64 {
    format!("{time:.9}").parse().unwrap_or(time)
}

/// Extremes of all headlines of some runs, a row per quantity and run.
pub fn extremes(description: &Description, runs: &[(&str, &Recorded)]) -> Grid {
    let headers =
        ["quantity", "crane", "minimum", "time of minimum", "maximum", "time of maximum", "error", "missed", "unit"];
    let alone = runs.len() < 2;
    let headers: Vec<&str> = headers.into_iter().filter(|header| !alone || *header != "crane").collect();
    let title = "Extremes of the run with their times in s, the largest difference from a finer run, and what they miss between two results";
    let mut grid = Grid::new("extremes", title, &headers);
    for kind in headlines(description) {
        for name in &kind.names {
            for (label, run) in runs {
                if run.table.values(name).is_none() {
                    continue;
                }
                let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } = Extremes::of(&run.table, name);
                let found = run.verification.as_ref().and_then(|found| found.find_errors(&run.table, name));
                let uncertain = [0, 1].map(|k| found.map_or(Cell::Empty, |found| Cell::Uncertainty(found[k])));
                let numbers = [minimum, instant(time_of_minimum), maximum, instant(time_of_maximum)].map(Cell::from);
                let crane = (!alone).then(|| Cell::from(*label));
                let row = [Cell::from(name.as_str())].into_iter().chain(crane).chain(numbers);
                grid.row(row.chain(uncertain).chain([kind.unit.into()]).collect::<Vec<_>>());
            }
        }
    }
    grid
}

/// Work, energy balance and time of runs, one column each.
pub fn summary(runs: &[(&str, &Recorded)]) -> Grid {
    let values = runs.iter().map(|(label, _)| Heading::of(label, VALUE));
    let headings = [Heading::from("quantity")].into_iter().chain(values).chain(["unit".into()]).collect();
    let mut grid = Grid::with_headings("summary", "Run", headings);
    let mut row = |name: String, unit: &str, value: &dyn Fn(&Recorded) -> Option<f64>| {
        let values: Vec<Option<f64>> = runs.iter().map(|(_, run)| value(run)).collect();
        if values.iter().all(Option::is_none) {
            return;
        }
        let values = values.into_iter().map(Cell::from);
        grid.row([name.into()].into_iter().chain(values).chain([unit.into()]).collect::<Vec<_>>());
    };
    let greatest = |run: &Recorded, column: &str| run.table.values(column).map(|v| v.map(f64::abs).fold(0.0, f64::max));
    let last = |run: &Recorded, column: &str| run.table.values(column).and_then(Iterator::last);
    row("work of the drives".to_owned(), "J", &|run| last(run, "drive_work"));
    row("dissipated".to_owned(), "J", &|run| last(run, "dissipated_energy"));
    row("energy balance, largest error".to_owned(), "J", &|run| greatest(run, "energy_balance"));
    if runs.iter().any(|(_, run)| run.wall.is_some()) {
        row("wall time".to_owned(), "s", &|run| Some(pace(run)?.0));
        row("real-time factor".to_owned(), "", &|run| Some(pace(run)?.1));
    }
    grid
}

/// Wall time of a run, s, and simulated time per wall time; none where no clock was read, as in a page, or no time is reported.
pub(crate) fn pace(run: &Recorded) -> Option<(f64, f64)> {
    Some((run.wall?.as_secs_f64(), run.real_time_factor()?))
}

/// Adds the cautions of labelled runs, with the label as prefix if there are several.
pub fn caution_of_runs<'a>(report: &mut Report, runs: impl ExactSizeIterator<Item = (&'a str, &'a Recorded)>) {
    let alone = runs.len() == 1;
    for (label, run) in runs {
        for caution in &run.cautions {
            report.caution(Some(if alone { caution.clone() } else { format!("{label}: {caution}") }));
        }
    }
}
