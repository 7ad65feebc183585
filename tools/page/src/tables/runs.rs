//! Runs: minimum and maximum values, when they occur, and how far off they may be; work, energy balance and time.

use crane_model::{
    ColumnKind, Description,
    dyn_crane::DynCrane,
    results::{Extremes, Table, column_name, drive_effort, headlines},
    runs::Recorded,
};

use super::{Cell, Grid, Heading, Report, VALUE};

/// Extremes of all headlines of some runs, a row per quantity and run.
pub fn extremes(runs: &[(&str, &Recorded)]) -> Grid {
    let headers =
        ["quantity", "crane", "minimum", "time of minimum", "maximum", "time of maximum", "error", "missed", "unit"];
    let alone = runs.len() < 2;
    let headers: Vec<&str> = headers.into_iter().filter(|header| !alone || *header != "crane").collect();
    let title = "Extremes of the run with their times in s, the largest difference from a finer run, and what they miss between two results";
    let mut grid = Grid::new("extremes", title, &headers);
    let columns = runs.first().map_or(&[][..], |(_, run)| &run.table.columns);
    for kind in headlines(columns) {
        for name in &kind.names {
            for (label, run) in runs {
                if run.table.values(name).is_none() {
                    continue;
                }
                let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } = Extremes::of(&run.table, name);
                let found = run.verification.as_ref().and_then(|found| found.find_errors(&run.table, name));
                let uncertain =
                    [0, 1].map(|k| found.map_or(Cell::Empty, |found| Cell::error_of_unit(found[k], &kind.unit)));
                let [least, most] = [minimum, maximum].map(|value| Cell::of_unit(value, &kind.unit));
                let numbers = [least, Cell::instant(time_of_minimum), most, Cell::instant(time_of_maximum)];
                let crane = (!alone).then(|| Cell::from(*label));
                let row = [Cell::from(name.as_str())].into_iter().chain(crane).chain(numbers);
                grid.row(row.chain(uncertain).chain([Cell::unit_of(&kind.unit)]).collect::<Vec<_>>());
            }
        }
    }
    grid
}

/// Work, energy balance and time of runs, one column each.
fn summary(runs: &[(&str, &Recorded)]) -> Grid {
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
    row("energy that came with events".to_owned(), "J", &|run| last(run, "event_work"));
    row("dissipated".to_owned(), "J", &|run| last(run, "dissipated_energy"));
    row("energy balance, largest error".to_owned(), "J", &|run| greatest(run, "energy_balance"));
    row("energy of the pump".to_owned(), "J", &|run| Some(integral(&run.table, &column(&run.table, PUMP)?)));
    row("power of the pump, maximum".to_owned(), "W", &|run| greatest(run, PUMP));
    if runs.iter().any(|(_, run)| run.wall.is_some()) {
        row("wall time".to_owned(), "s", &|run| Some(pace(run)?.0));
        row("real-time factor".to_owned(), "", &|run| Some(pace(run)?.1));
    }
    grid
}

/// The column with the power of the pump.
const PUMP: &str = "pump_power";

/// The values of a column; `None` if there is none of that name.
fn column(table: &Table, name: &str) -> Option<Vec<f64>> {
    table.values(name).map(Iterator::collect)
}

/// The integral of numbers over the times of a table, by the trapezoidal rule.
fn integral(table: &Table, values: &[f64]) -> f64 {
    let Some(t) = column(table, "t") else { return 0.0 };
    t.windows(2).zip(values.windows(2)).map(|(t, values)| 0.5 * (values[0] + values[1]) * (t[1] - t[0])).sum()
}

/// Adds the tables of some runs: what happens, work and time, and what drives do.
pub fn add_runs(report: &mut Report, description: &Description, runs: &[(&str, &dyn DynCrane, &Recorded)]) {
    let recorded: Vec<(&str, &Recorded)> = runs.iter().map(|(label, _, run)| (*label, *run)).collect();
    let cranes: Vec<(&str, &dyn DynCrane, f64)> =
        runs.iter().map(|(label, crane, run)| (*label, *crane, run.run.time)).collect();
    add_events(report, &cranes);
    report.grid(summary(&recorded));
    report.grid(duties(description, &recorded));
}

/// Adds what happens to some cranes up to the ends of their runs, s: a row per event and parameter.
pub fn add_events(report: &mut Report, cranes: &[(&str, &dyn DynCrane, f64)]) {
    // Cranes with the same events, as one with rigid and with flexible beams, need them once.
    let alike = cranes.windows(2).all(|pair| pair[0].1.description().events == pair[1].1.description().events);
    let headers = ["event", "crane", "time [s]", "parameter", "from", "to", "unit"];
    let headers: Vec<&str> = headers.into_iter().filter(|header| !alike || *header != "crane").collect();
    let mut grid = Grid::new("events", "Events of the run", &headers);
    for (label, crane, end) in cranes.iter().take(if alike { 1 } else { cranes.len() }) {
        let description = crane.description();
        let mut values: Vec<f64> = (0..description.parameters.len()).map(|index| crane.parameter(index)).collect();
        for event in description.events.iter().filter(|event| event.time <= *end) {
            for &(index, value) in &event.changes {
                let parameter = &description.parameters[index];
                let before = std::mem::replace(&mut values[index], value);
                let [from, to] = [before, value].map(|value| Cell::of_unit(value, &parameter.unit));
                let of_crane = (!alike).then(|| Cell::from(*label));
                let rest =
                    [event.time.into(), parameter.name.as_str().into(), from, to, Cell::unit_of(&parameter.unit)];
                grid.row([event.name.as_str().into()].into_iter().chain(of_crane).chain(rest).collect::<Vec<_>>());
            }
        }
    }
    report.grid(grid);
}

/// What each drive must be able to do in some runs, a row per drive and run: to choose motors, gears and cylinders by. Powers are those of the drive on its
/// joint, at the results.
fn duties(description: &Description, runs: &[(&str, &Recorded)]) -> Grid {
    let headers = [
        "drive",
        "crane",
        "effort",
        "rms effort",
        "unit",
        "rate",
        "unit of rates",
        "power [W]",
        "braking power [W]",
        "work [J]",
        "braking work [J]",
    ];
    let alone = runs.len() < 2;
    let headers: Vec<&str> = headers.into_iter().filter(|header| !alone || *header != "crane").collect();
    let title = "Drives over the run: largest effort, its root mean square, fastest rate, largest power and work that it gives, and that it takes in as a brake";
    let mut grid = Grid::new("duties", title, &headers);
    for drive in &description.drives {
        let coordinate = &description.coordinates[drive.coordinate];
        for (label, run) in runs {
            let table = &run.table;
            let effort = column(table, &drive_effort(&coordinate.name, coordinate.kind));
            let rate = column(table, &column_name(ColumnKind::Rate, &coordinate.name, coordinate.kind.turns()));
            let (Some(effort), Some(rate), Some(t)) = (effort, rate, column(table, "t")) else { continue };
            let duration = t.last().copied().unwrap_or_default() - t.first().copied().unwrap_or_default();
            let power =
                |sign: f64| effort.iter().zip(&rate).map(|(f, v)| (sign * f * v).max(0.0)).collect::<Vec<f64>>();
            let [gives, brakes] = [1.0, -1.0].map(power);
            let most = |values: &[f64]| values.iter().map(|value| value.abs()).fold(0.0, f64::max);
            let squares: Vec<f64> = effort.iter().map(|effort| effort * effort).collect();
            let rms = if duration > 0.0 { (integral(table, &squares) / duration).sqrt() } else { most(&effort) };
            let kind = coordinate.kind;
            let crane = (!alone).then(|| Cell::from(*label));
            let numbers = [
                most(&effort).into(),
                rms.into(),
                kind.force_unit().into(),
                most(&rate).into(),
                format!("{}/s", kind.unit()).into(),
                most(&gives).into(),
                most(&brakes).into(),
                integral(table, &gives).into(),
                integral(table, &brakes).into(),
            ];
            grid.row([coordinate.name.as_str().into()].into_iter().chain(crane).chain(numbers).collect::<Vec<_>>());
        }
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
