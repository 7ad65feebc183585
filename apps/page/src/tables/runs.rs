//! Runs: minimum and maximum values, when they occur, and how far off they may be; work, energy balance and time.

use crane_model::{
    DisplayUnit, EventInfo,
    dyn_crane::DynCrane,
    results::{CylinderDuty, DriveDuty, Duties, Extremes, PumpDuty, Table, headlines},
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
                let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } =
                    Extremes::of_column(&run.table, name);
                let found =
                    run.verification.as_ref().and_then(|verification| verification.find_errors(&run.table, name));
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
fn summary(runs: &[(&str, &Recorded)], duties: &[Duties]) -> Grid {
    let values = runs.iter().map(|(label, _)| Heading::about(label, VALUE));
    let headings = [Heading::from("quantity")].into_iter().chain(values).chain(["unit".into()]).collect();
    let mut grid = Grid::with_headings("summary", "Run", headings);
    let mut row = |name: &str, unit: &str, values: &mut dyn Iterator<Item = Option<f64>>| {
        let values: Vec<Option<f64>> = values.collect();
        if values.iter().all(Option::is_none) {
            return;
        }
        let values = values.into_iter().map(|value| value.map_or(Cell::Empty, |value| Cell::of_unit(value, unit)));
        grid.row([name.into()].into_iter().chain(values).chain([Cell::unit_of(unit)]).collect::<Vec<_>>());
    };
    let greatest = |run: &Recorded, column: &str| run.table.values(column).map(|v| v.map(f64::abs).fold(0.0, f64::max));
    let last = |run: &Recorded, column: &str| run.table.values(column).and_then(Iterator::last);
    let recorded = || runs.iter().map(|(_, run)| *run);
    row("work of the drives", "J", &mut recorded().map(|run| last(run, "drive_work")));
    row("energy that came with events", "J", &mut recorded().map(|run| last(run, "event_work")));
    row("dissipated", "J", &mut recorded().map(|run| last(run, "dissipated_energy")));
    row("energy balance, largest error", "J", &mut recorded().map(|run| greatest(run, "energy_balance")));
    let mut of_pump = |name: &str, unit: &str, of: fn(PumpDuty) -> f64| {
        row(name, unit, &mut duties.iter().map(|duties| duties.pump.map(of)));
    };
    of_pump("energy of the pump", "J", |pump| pump.energy);
    of_pump("power of the pump, maximum", "W", |pump| pump.power);
    of_pump("flow of the pump, maximum", "m³/s", |pump| pump.flow);
    of_pump("pressure of the pump, maximum", "Pa", |pump| pump.pressure);
    if runs.iter().any(|(_, run)| run.wall.is_some()) {
        row("wall time", "s", &mut recorded().map(|run| Some(pace(run)?.0)));
        row("real-time factor", "", &mut recorded().map(|run| Some(pace(run)?.1)));
    }
    grid
}

/// Adds the tables of some runs: what happens, work and time, and what drives do.
pub fn add_runs(report: &mut Report, runs: &[(&str, &dyn DynCrane, &Recorded)]) {
    let cranes: Vec<(&str, &dyn DynCrane, &Table)> =
        runs.iter().map(|(label, crane, run)| (*label, *crane, &run.table)).collect();
    add_events(report, &cranes);
    add_duties(report, runs);
}

/// Adds work and time of some runs, and what drives and cylinders do.
pub fn add_duties(report: &mut Report, runs: &[(&str, &dyn DynCrane, &Recorded)]) {
    let recorded: Vec<(&str, &Recorded)> = runs.iter().map(|(label, _, run)| (*label, *run)).collect();
    let duties: Vec<Duties> = runs.iter().map(|(_, crane, run)| Duties::new(crane.description(), &run.table)).collect();
    let labelled: Vec<(&str, &Duties)> = runs.iter().map(|(label, ..)| *label).zip(&duties).collect();
    report.grid(summary(&recorded, &duties));
    report.grid(of_drives(&labelled));
    report.grid(of_cylinders(&labelled));
}

/// Adds what happens to some cranes in their runs: a row per event and parameter, in the order of time.
pub fn add_events(report: &mut Report, cranes: &[(&str, &dyn DynCrane, &Table)]) {
    // Cranes with the same events, as one with rigid and with flexible beams, need them once.
    let of_crane = |(_, crane, table): &(&str, &dyn DynCrane, &Table)| {
        let (events, times) = (&crane.description().events, table.times_of_events(crane.description()));
        let happened = events.iter().cloned().zip(times).filter_map(|(event, time)| Some((time?, event)));
        let mut all: Vec<(f64, EventInfo)> = happened.collect();
        all.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        all
    };
    let all: Vec<Vec<(f64, EventInfo)>> = cranes.iter().map(of_crane).collect();
    let alike = all.windows(2).all(|pair| pair[0] == pair[1]);
    let headers = ["event", "crane", "time [s]", "parameter", "from", "to", "unit"];
    let headers: Vec<&str> = headers.into_iter().filter(|header| !alike || *header != "crane").collect();
    let mut grid = Grid::new("events", "Events of the run", &headers);
    for ((label, crane, _), events) in cranes.iter().zip(&all).take(if alike { 1 } else { cranes.len() }) {
        let description = crane.description();
        let mut values: Vec<f64> = crane.parameter_values();
        for (time, event) in events {
            for &(index, value) in &event.changes {
                let parameter = &description.parameters[index];
                let before = std::mem::replace(&mut values[index], value);
                let [from, to] = [before, value].map(|value| Cell::of_unit(value, &parameter.unit));
                let of_crane = (!alike).then(|| Cell::from(*label));
                let rest = [(*time).into(), parameter.name.as_str().into(), from, to, Cell::unit_of(&parameter.unit)];
                grid.row([event.name.as_str().into()].into_iter().chain(of_crane).chain(rest).collect::<Vec<_>>());
            }
        }
    }
    report.grid(grid);
}

/// Headings of a table with a row per part and run: the second one only where there are several runs.
fn headings<const N: usize>(names: [&str; N], runs: usize) -> Vec<&str> {
    names.into_iter().filter(|name| runs > 1 || *name != "crane").collect()
}

/// Names of parts of all runs, each once.
fn names<'a>(runs: &[(&str, &'a Duties)], of: fn(&'a Duties) -> Vec<&'a str>) -> Vec<&'a str> {
    let mut names = Vec::new();
    for name in runs.iter().flat_map(|(_, duties)| of(duties)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// What each drive must be able to do in some runs, a row per drive and run: to choose motors and gears by. Powers are those of the drive on its
/// joint, and of a winch on its rope, at the results.
fn of_drives(runs: &[(&str, &Duties)]) -> Grid {
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
    let title = "Drives over the run: largest effort, its root mean square, fastest rate, largest power and work that it gives, and that it takes in as a brake";
    let mut grid = Grid::new("duties", title, &headings(headers, runs.len()));
    for drive in names(runs, |duties| duties.drives.iter().map(|duty| duty.name.as_str()).collect()) {
        for (label, duties) in runs {
            let Some(duty) = duties.drives.iter().find(|duty| duty.name == drive) else { continue };
            let DriveDuty { kind, effort, rms, rate, power, braking_power, work, braking_work, .. } = duty;
            let crane = (runs.len() > 1).then(|| Cell::from(*label));
            let numbers = [
                (*effort).into(),
                (*rms).into(),
                kind.force_unit().into(),
                (*rate).into(),
                format!("{}/s", kind.unit()).into(),
                (*power).into(),
                (*braking_power).into(),
                (*work).into(),
                (*braking_work).into(),
            ];
            grid.row([drive.into()].into_iter().chain(crane).chain(numbers).collect::<Vec<_>>());
        }
    }
    grid
}

/// What each cylinder must be able to do in some runs, a row per cylinder and run.
fn of_cylinders(runs: &[(&str, &Duties)]) -> Grid {
    let headers = [
        "cylinder",
        "crane",
        "push [N]",
        "pull [N]",
        "pressure [bar]",
        "speed [m/s]",
        "flow [l/min]",
        "shortest [m]",
        "longest [m]",
    ];
    let title = "Cylinders over the run: largest forces, highest pressure, fastest speed, largest flow, lengths between the pins";
    let mut grid = Grid::new("cylinder_duties", title, &headings(headers, runs.len()));
    for cylinder in names(runs, |duties| duties.cylinders.iter().map(|duty| duty.name.as_str()).collect()) {
        for (label, duties) in runs {
            let Some(duty) = duties.cylinders.iter().find(|duty| duty.name == cylinder) else { continue };
            let CylinderDuty { push, pull, pressure, speed, flow, lengths: [shortest, longest], .. } = *duty;
            let crane = (runs.len() > 1).then(|| Cell::from(*label));
            let numbers = [
                push.into(),
                pull.into(),
                Cell::Shown(pressure, DisplayUnit::Bar),
                speed.into(),
                Cell::Shown(flow, DisplayUnit::LitrePerMinute),
                shortest.into(),
                longest.into(),
            ];
            grid.row([cylinder.into()].into_iter().chain(crane).chain(numbers).collect::<Vec<_>>());
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
