//! `crane margins`: stability margins of a control loop over poses, loads and other parameters.

use std::{
    io::Write,
    num::NonZeroUsize,
    path::Path,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use crane_live::LiveCrane;
use crane_model::{
    Description,
    dyn_crane::{DynCrane, Functions},
    envelope::{Axes, Axis},
    linear::{About, Forces, Input, NoModel, Output, linear_model, outputs},
    margins::{self, Acting, Loop, Margins, NoMargins},
    statics::Settings,
};
use crane_page::tables::{Cell, Grid, Report};
use serde_json::json;

use crate::{
    arguments::{self, Controller},
    envelope::{Map, map_svg, read_ranges, shown},
    files, poses,
    problem::{Outcome, Problem, nearest},
    screen::Console,
    selection::{Registry, refusal_message},
};

/// What is computed for a pose.
struct MarginRow {
    values: Vec<f64>,
    found: Result<Margins, String>,
}

/// The loop as asked for.
struct MarginsRequest {
    acting: Acting,
    output: Output,
    of: Loop,
    least: f64,
}

/// Endings of the file with the table, and of that with a map.
const ENDINGS: [&str; 2] = ["csv", "svg"];

/// Computes margins over all poses, prints them, and writes a table or a map.
pub fn margins(options: &arguments::Margins, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    if let Some(file) = &options.file {
        files::ending(file, &ENDINGS)?;
    }
    let crane = registry.live(options.analysis.crane.open(registry)?.as_ref())?;
    let description = crane.description();
    let axes = read_ranges(&options.ranges, description)?;
    let asked = ask(options, &crane)?;
    let rows = rows(&registry.console, &asked, &axes, &crane, options.threads)?;
    let mut report = Report::default();
    facts(&mut report, &asked, description, &rows);
    let grid = table(&axes, description, &rows);
    if let Some(file) = &options.file {
        write(&registry.console, file, &grid, &axes, &asked, description, &rows)?;
    }
    report.grid(grid);
    report.show_all(options.analysis.all);
    options.analysis.format.print(&report, &registry.console, out)?;
    if rows.iter().all(|row| row.found.is_err()) {
        let why = rows.iter().find_map(|row| row.found.as_ref().err()).map_or("", String::as_str);
        return Err(Problem::failed(format!("there are no margins: {why}"), "see the column `status`"));
    }
    Ok(())
}

fn ask(options: &arguments::Margins, crane: &LiveCrane) -> Outcome<MarginsRequest> {
    let description = crane.description();
    let unknown = |name: &str, what: &str, known: &[String]| {
        let guess = nearest(name, known.iter().map(String::as_str));
        let guess = guess.map_or_else(String::new, |guess| format!("did you mean `{guess}`? "));
        Problem::usage(format!("there is nothing `{name}` {what}"), format!("{guess}there are {}", known.join(", ")))
    };
    let acting = Acting::named(&options.on, description)
        .ok_or_else(|| unknown(&options.on, "on which a loop could act", &Acting::names(description)))?;
    let measured = options.measure.as_deref().or_else(|| acting.coordinate(description)).ok_or_else(|| {
        Problem::usage(
            format!("`--on {}` does not say what the loop measures", options.on),
            "name a column of a run, as in `--measure boom_psi`",
        )
    })?;
    let all = outputs(crane);
    let output = all.iter().find(|output| output.column.name == measured).cloned().ok_or_else(|| {
        let names: Vec<String> = all.iter().map(|output| output.column.name.clone()).collect();
        unknown(measured, "to measure", &names)
    })?;
    let Controller { p, i, d, filter, lead, delay, lag } = options.controller;
    if [p, i, d].iter().all(|gain| *gain == 0.0) {
        return Err(Problem::usage("all gains are zero: the loop is open", "give one, as in `--p 1.3`"));
    }
    let of = Loop { p, i, d, filter, lead: lead.unwrap_or_default(), delay, lag };
    if let Some((name, value, needed)) = of.mistake() {
        return Err(Problem::usage(format!("`--{name} {value:e}` is out of range"), format!("write {needed}")));
    }
    Ok(MarginsRequest { acting, output, of, least: options.least })
}

/// The rows of all poses, on several threads.
fn rows(
    console: &Console,
    asked: &MarginsRequest,
    axes: &Axes,
    crane: &LiveCrane,
    threads: Option<NonZeroUsize>,
) -> Outcome<Vec<MarginRow>> {
    let threads = threads.map_or_else(thread::available_parallelism, Ok).map_or(1, NonZeroUsize::get);
    let description = crane.description();
    let settings: Vec<Vec<(usize, f64)>> =
        (0..axes.poses()).map(|pose| poses::settings(axes, pose, description)).collect::<Outcome<_>>()?;
    for values in &settings {
        check(crane, values)?;
    }
    let bar = console.batches(axes.poses());
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let pose = next.fetch_add(1, Ordering::Relaxed);
            let Some(values) = settings.get(pose) else { break };
            let row = MarginRow { values: axes.values(pose), found: of_pose(asked, crane, values) };
            found.lock().unwrap_or_else(PoisonError::into_inner).push((pose, row));
            bar.inc(1);
        }
    };
    thread::scope(|scope| {
        for _ in 1..threads.min(settings.len()) {
            scope.spawn(work);
        }
        work();
    });
    bar.finish_and_clear();
    let mut found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    found.sort_by_key(|(pose, _)| *pose);
    Ok(found.into_iter().map(|(_, row)| row).collect())
}

fn with(crane: &LiveCrane, values: &[(usize, f64)]) -> Vec<f64> {
    let mut parameters = crane.parameters().to_vec();
    for (index, value) in values {
        parameters[*index] = *value;
    }
    parameters
}

/// Refuses parameters that break a rule.
fn check(crane: &LiveCrane, values: &[(usize, f64)]) -> Outcome<()> {
    crane.check(&with(crane, values)).map_err(|refused| {
        let (title, help) = refusal_message(&refused);
        Problem::usage(title, help)
    })
}

/// The margins in a pose.
fn of_pose(asked: &MarginsRequest, crane: &LiveCrane, values: &[(usize, f64)]) -> Result<Margins, String> {
    let mut crane = crane.clone();
    let parameters = with(&crane, values);
    DynCrane::set_parameters(&mut crane, &parameters).map_err(|refused| refused.to_string())?;
    let equilibrium = (&crane as &dyn DynCrane).equilibrium(&Settings::default());
    if !equilibrium.rests() {
        return Err(equilibrium.status.name().to_owned());
    }
    let rest = vec![0.0; crane.size()];
    let about = About { t: 0.0, q: &equilibrium.q, v: &rest, x: Forces::SlightlyOpen, steady: true };
    let inputs: Vec<Input> = asked.acting.inputs().into_iter().map(|(input, _)| input).collect();
    let model = linear_model(&crane, &about, &inputs, std::slice::from_ref(&asked.output))
        .map_err(|none: NoModel| none.to_string())?;
    let plant = margins::plant(&model, asked.acting, 0).map_err(|none: NoMargins| none.to_string())?;
    margins::margins(&plant, &asked.of).map_err(|none| none.to_string())
}

impl MarginsRequest {
    /// Whether a loop is unstable or its phase margin is below what it should be.
    fn falls_short(&self, margins: &Margins) -> bool {
        !margins.stable || phase_margin(margins).is_some_and(|phase| phase < self.least)
    }
}

/// The phase margin of a loop, rad: of a stable one, how far it is from the point −1 on either side.
fn phase_margin(margins: &Margins) -> Option<f64> {
    margins.phase.map(|(phase, _)| if margins.stable { phase.abs() } else { phase })
}

/// A margin of a loop.
type Least = fn(&Margins) -> Option<f64>;

fn facts(report: &mut Report, asked: &MarginsRequest, description: &Description, rows: &[MarginRow]) {
    let [on, measured] = [asked.acting.column(description), asked.output.column.clone()];
    let found = || rows.iter().filter_map(|row| row.found.as_ref().ok());
    let (count, computed) = (rows.len(), found().count());
    report.fact("crane", description.name.as_str(), "");
    report.fact("acts on", on.name, "");
    report.fact("measures", measured.name, "");
    let unit = format!("{} per {}", on.unit, measured.unit);
    let Loop { p, i, d, filter, lead, delay, lag } = asked.of;
    for (name, gain, per) in [("p", p, ""), ("i", i, " s"), ("d", d, "")] {
        if gain != 0.0 {
            report.line(name, gain, if name == "d" { format!("{unit}, times s") } else { format!("{unit}{per}") });
        }
    }
    for (name, time) in
        [("filter", filter), ("lead", lead[0]), ("lead, denominator", lead[1]), ("dead time", delay), ("lag", lag)]
    {
        if time != 0.0 {
            report.line(name, time, "s");
        }
    }
    if description.has_valves() {
        report.fact("valves", "slightly open", "");
    }
    report.value(
        "loop",
        json!({"p": p, "i": i, "d": d, "filter": filter, "lead": lead, "delay": delay, "lag": lag, "units": unit}),
    );
    report.fact_as("count", "poses", count, "");
    report.fact_as("stable_loops", "of which stable", found().filter(|margins| margins.stable).count(), "");
    let short = found().filter(|margins| asked.falls_short(margins)).count();
    report.fact_as("least_phase_margin", "phase margin that they should have", Cell::shown(asked.least, "°"), "°");
    report.fact_as("short_loops", "unstable or below it", short, "");
    // A loop may have all of its phase margin and hardly any of the others.
    let all: [(&str, &str, Least); 3] = [
        ("least phase margin", "°; 45° or more is usual", |margins| phase_margin(margins).map(f64::to_degrees)),
        ("least gain margin", "; 2 or more is usual", |margins| margins.gain.map(|(gain, _)| gain)),
        ("least distance from −1", "; 0.5 or more is usual", |margins| {
            margins.distance.map(|(distance, _)| distance)
        }),
    ];
    for (name, usual, of) in all {
        if let Some(least) = found().filter_map(of).min_by(f64::total_cmp) {
            report.line(name, format!("{least:.3}{usual}"), "");
        }
    }
    if computed < count {
        report.caution(Some(format!("{} of {count} poses have no margins: see the column status", count - computed)));
    }
}

/// The rows as a table.
fn table(axes: &Axes, description: &Description, rows: &[MarginRow]) -> Grid {
    let of_axes: Vec<(String, String, f64)> = axes.0.iter().map(|axis| shown(axis, description)).collect();
    let named = |(name, unit, _): &(String, String, f64)| {
        if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") }
    };
    let headings = [
        "stable",
        "phase margin [°]",
        "crossover [rad/s]",
        "gain margin",
        "gain reduction",
        "distance",
        "bandwidth [rad/s]",
        "damping ratio",
        "at [rad/s]",
        "status",
    ];
    let headings: Vec<String> = of_axes.iter().map(named).chain(headings.map(str::to_owned)).collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let title = "Margins (gain margin: factor to instability; distance: of L from −1; damping of the closed loop)";
    let mut grid = Grid::new("margins", title, &headings);
    for row in rows {
        let axis = |(value, (_, unit, _)): (&f64, &(String, String, f64))| {
            if unit == "°" { Cell::of_unit(*value, "rad") } else { Cell::Number(*value) }
        };
        let mut cells: Vec<Cell> = row.values.iter().zip(&of_axes).map(axis).collect();
        match &row.found {
            Ok(found) => {
                cells.extend([
                    if found.stable { "yes" } else { "no" }.into(),
                    found.phase.map_or(Cell::Empty, |(phase, _)| Cell::shown(phase, "°")),
                    found.phase.map(|(_, at)| at).into(),
                    found.gain.map(|(factor, _)| factor).into(),
                    found.reduction.map(|(factor, _)| factor).into(),
                    found.distance.map(|(distance, _)| distance).into(),
                    found.bandwidth.into(),
                    found.damping().into(),
                    found.closed.ok().flatten().map(crane_model::nalgebra::Complex::norm).into(),
                    found.closed.err().map_or_else(|| "ok".to_owned(), |why| why.to_string()).into(),
                ]);
            }
            Err(why) => {
                cells.extend((0..9).map(|_| Cell::Empty));
                cells.push(why.as_str().into());
            }
        }
        grid.row(cells);
    }
    grid
}

/// Writes the table, or a map of the phase margin.
fn write(
    console: &Console,
    file: &Path,
    grid: &Grid,
    axes: &Axes,
    asked: &MarginsRequest,
    description: &Description,
    rows: &[MarginRow],
) -> Outcome<()> {
    if files::ending(file, &ENDINGS)? == "csv" {
        let (header, fields) = grid.fields();
        return console.write_fields(file, header, fields);
    }
    let wide: Vec<usize> = (0..axes.0.len()).filter(|&index| axes.0[index].values.len() > 1).collect();
    let [x, y] = wide[..] else {
        return Err(Problem::usage(
            format!("a map has two axes, and there are {} with several values", wide.len()),
            "give two ranges FROM:TO:COUNT, and others with one value",
        ));
    };
    let axis = |index: usize| {
        let axis: &Axis = &axes.0[index];
        let (name, unit, factor) = shown(axis, description);
        (format!("{name} [{unit}]"), axis.values.iter().map(|value| factor * value).collect::<Vec<f64>>())
    };
    let (rows_of, columns_of) = (axes.0[y].values.len(), axes.0[x].values.len());
    let mut cells = vec![vec![f64::NAN; columns_of]; rows_of];
    let mut words = vec![vec![String::new(); columns_of]; rows_of];
    for (pose, row) in rows.iter().enumerate() {
        let places = axes.places(pose);
        let Ok(margins) = &row.found else { continue };
        let margin = margins.phase.map_or(180.0, |(phase, _)| phase.abs().to_degrees());
        // An unstable loop has no margin.
        cells[places[y]][places[x]] = if margins.stable { margin } else { 0.0 };
        words[places[y]][places[x]] = if margins.stable { format!("{margin:.0}") } else { "unstable".to_owned() };
    }
    let Loop { p, i, d, filter, lead: [above, below], delay, lag } = asked.of;
    let numbers = [
        ("p", p),
        ("i", i),
        ("d", d),
        ("filter", filter),
        ("lead", above),
        ("over", below),
        ("dead time", delay),
        ("lag", lag),
    ];
    let given = numbers.iter().filter(|(_, number)| *number != 0.0).map(|(name, number)| format!("{name} {number}"));
    let title = vec![
        "phase margin [°], 0 where the loop is unstable".to_owned(),
        format!("{}: {} → {}", description.name, asked.output.column.name, asked.acting.column(description).name),
        given.collect::<Vec<String>>().join(", "),
    ];
    let map = Map { title, x: axis(x), y: axis(y), cells, words };
    let picture = map_svg(&map).map_err(|error| Problem::failed(format!("cannot draw the map: {error}"), ""))?;
    console.write_text(file, &picture)
}
