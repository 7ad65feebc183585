//! `crane simulate`: a run of one crane into files.

use std::{io::Write, path::Path};

use crane_model::{
    CoordinateKind, Description,
    dyn_crane::DynCrane,
    dynamics,
    dynamics::Method,
    results::{Table, drive_effort},
    runs::Recorded,
};
use crane_page::{
    record,
    tables::{Grid, Report, VALUE, add_runs, extremes},
};
use serde_json::Value;

use crate::{
    arguments::Run,
    figures::{Curve, Mark, PALETTE, Panel, svg},
    files,
    integration::record_checked,
    problem::{Outcome, Problem},
    screen::Console,
    selection::Registry,
};

/// A recorded run as a curve of the figures.
pub struct Trace<'a> {
    /// Name in the legend.
    pub label: &'a str,
    /// Its results.
    pub table: &'a Table,
    /// Whether it is dashed, so that it can lie over others.
    pub dashed: bool,
}

/// Runs a crane and writes its results.
pub fn simulate(options: &Run, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.analysis.crane.open(registry)?;
    let crane = crane.as_ref();
    let name = &crane.description().name;
    let start = options.timing.start(&registry.console, crane, false)?;
    let settings = options.timing.settings(crane, &start, Method::RECOMMENDED)?;
    files::folder(&options.folder.out)?;
    let bar = registry.console.progress(settings.duration);
    let checks = (!options.timing.no_verify, options.analysis.crane.limits);
    let recorded = record_checked(crane, &start, &settings, checks, (&registry.console, &bar))?;
    bar.finish_and_clear();

    let mut written = write_run(&registry.console, &options.folder.out, crane, &settings, &recorded)?;
    let traces = [Trace { label: name, table: &recorded.table, dashed: false }];
    written.extend(write_figures(
        &registry.console,
        &options.folder.out,
        &format!("{name}_"),
        crane.description(),
        &traces,
    )?);

    let mut report = Report::default();
    report.fact("crane", name.as_str(), "");
    report.fact("start", recorded.start.as_str(), "");
    method(&mut report, &settings);
    let statistics = recorded.run.statistics;
    report.fact("steps", statistics.steps, "");
    report.fact_as("step", if settings.method.is_adaptive() { "mean step" } else { "step" }, recorded.run.step, "s");
    report.fact("rejected steps", statistics.rejections, "");
    report.fact("evaluations", statistics.evaluations, "");
    report.fact("factorisations", statistics.factorisations, "");
    for caution in &recorded.cautions {
        report.caution(Some(caution.as_str()));
    }
    report.grid(extremes(&[(name, &recorded)]));
    add_runs(&mut report, &[(VALUE, crane, &recorded)]);
    report.grid(file_list(&options.folder.out, &written));
    options.analysis.format.print(&report, &registry.console, out)
}

/// Adds the method, and its tolerance if it has one.
pub fn method(report: &mut Report, settings: &dynamics::Settings) {
    report.line("method", settings.method.title(), "");
    report.value("method", settings.method.name());
    if settings.method.is_adaptive() {
        report.fact("tolerance", settings.tolerance, "m, rad");
    } else {
        report.value("tolerance", Value::Null);
    }
}

/// The files written, as a table.
pub fn file_list(folder: &Path, written: &[String]) -> Grid {
    let mut grid = Grid::new("files", format!("Written to {}", folder.display()), &["file"]);
    for file in written {
        grid.row([file.as_str().into()]);
    }
    grid
}

/// Writes the results and the record of a run; returns their file names.
pub fn write_run(
    console: &Console,
    folder: &Path,
    crane: &dyn DynCrane,
    settings: &dynamics::Settings,
    recorded: &Recorded,
) -> Outcome<Vec<String>> {
    let name = &crane.description().name;
    let (csv, json) = (format!("{name}.csv"), format!("{name}.json"));
    console.write_csv(&folder.join(&csv), &recorded.table)?;
    console.write_text(&folder.join(&json), &format!("{:#}\n", record(crane, settings, recorded, files::PROGRAM)))?;
    Ok(vec![csv, json])
}

/// Writes figures of the points' paths in a plane and of the drives' torques and forces; returns their file names.
pub fn write_figures(
    console: &Console,
    folder: &Path,
    prefix: &str,
    description: &Description,
    traces: &[Trace<'_>],
) -> Outcome<Vec<String>> {
    let mut written = Vec::new();
    let figures = [("path", vec![path(description, traces)], 1), ("drives", drives(description, traces), 2)];
    for (what, panels, columns) in figures {
        if panels.iter().any(|panel| !panel.curves.is_empty()) {
            let file = format!("{prefix}{what}.svg");
            write_figure(console, &folder.join(&file), &panels, columns)?;
            written.push(file);
        }
    }
    Ok(written)
}

/// Writes a figure.
///
/// # Errors
/// The file system refuses.
pub fn write_figure(console: &Console, file: &Path, panels: &[Panel], columns: usize) -> Outcome<()> {
    let text = svg(panels, columns)
        .map_err(|error| Problem::failed(format!("cannot draw {}: {error}", file.display()), ""))?;
    console.write_text(file, &text)
}

/// Values of two columns as points.
pub fn points(table: &Table, x: &str, y: &str, scale: f64) -> Vec<(f64, f64)> {
    match (table.values(x), table.values(y)) {
        (Some(x), Some(y)) => x.zip(y.map(|y| y * scale)).collect(),
        _ => Vec::new(),
    }
}

/// A name for people to read: spaces instead of underscores.
pub fn spoken(name: &str) -> String {
    name.replace('_', " ")
}

/// The paths of the points in the horizontal plane, [Urbaś 2016, Fig. 8], or in a vertical plane that they hardly leave.
fn path(description: &Description, traces: &[Trace<'_>]) -> Panel {
    /// Points hardly move along an axis if their range is below this fraction of that along z.
    const HARDLY: f64 = 0.01;
    let travel = |axis: &str| {
        let columns = description.points.iter().map(|point| format!("{point}_{axis}"));
        let ranges = columns.filter_map(|column| {
            let values: Vec<f64> = traces.first()?.table.values(&column)?.collect();
            Some(values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min))
        });
        ranges.fold(0.0, f64::max)
    };
    let [x, y] = match (travel("x"), travel("y"), HARDLY * travel("z")) {
        (_, y, hardly) if y < hardly => ["x", "z"],
        (x, _, hardly) if x < hardly => ["y", "z"],
        _ => ["x", "y"],
    };
    let curves = traces
        .iter()
        .flat_map(|trace| {
            description.points.iter().zip(PALETTE.iter().cycle()).map(|(point, &colour)| Curve {
                label: format!("{}, {}", spoken(point), spoken(trace.label)),
                colour,
                mark: if trace.dashed { Mark::Dashed } else { Mark::Solid },
                points: points(trace.table, &format!("{point}_{x}"), &format!("{point}_{y}"), 1.0),
            })
        })
        .collect();
    Panel { x: format!("{x} [m]"), y: format!("{y} [m]"), equal: true, logarithmic: false, curves }
}

fn drives(description: &Description, traces: &[Trace<'_>]) -> Vec<Panel> {
    let panel = |drive: &crane_model::DriveInfo| {
        let coordinate = &description.coordinates[drive.coordinate];
        let effort = drive_effort(&coordinate.name, coordinate.kind);
        let (symbol, unit) = match coordinate.kind {
            CoordinateKind::Translation => ("force", "kN"),
            CoordinateKind::Rotation => ("torque", "kN m"),
        };
        let curves = traces
            .iter()
            .zip(PALETTE.iter().cycle())
            .map(|(trace, &colour)| Curve {
                label: spoken(trace.label),
                colour,
                mark: if trace.dashed { Mark::Dashed } else { Mark::Solid },
                points: points(trace.table, "t", &effort, 1e-3),
            })
            .collect();
        Panel {
            x: "t [s]".to_owned(),
            y: format!("{}, {symbol} [{unit}]", spoken(&coordinate.name)),
            equal: false,
            logarithmic: false,
            curves,
        }
    };
    description.drives.iter().map(panel).collect()
}
