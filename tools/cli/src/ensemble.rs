//! `crane simulate --ensemble`: a run of every row of a table of parameters.

use std::{io::Write, num::NonZeroUsize, path::Path, thread, time::Instant};

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{self, Method},
    results::{Column, Peaks},
    runs::{
        Start,
        ensemble::{self, Conduct, Outcome as Row},
    },
};

use crate::{
    Fleet,
    arguments::{Ensemble, Simulate, Step, Timing},
    files,
    parameter_table::ParameterTable,
    problem::{Outcome, Problem},
    report::Report,
    run::batches,
};

/// Status of a run that reached its end.
const DONE: &str = "done";

/// Runs all cranes of the table and writes a row for each.
pub fn simulate(options: &Simulate, table: &Path, fleet: &Fleet, out: &mut dyn Write) -> Outcome<()> {
    let rig = options.analysis.crane.open(fleet)?;
    let rig = rig.as_ref();
    let description = rig.description();
    let table = ParameterTable::read(table, description)?;
    let (settings, step) = settings(&options.timing, rig, &table)?;
    let Ensemble { threads, results, .. } = &options.ensemble;
    let threads = threads.map_or_else(thread::available_parallelism, Ok).map_or(1, NonZeroUsize::get);
    let path = results.clone().unwrap_or_else(|| options.folder.out.join(format!("{}_ensemble.csv", description.name)));
    files::folder(path.parent().unwrap_or(&path))?;

    let begin = Instant::now();
    let bar = batches(table.rows.len());
    let conduct = Conduct { threads, done: &|_, _| bar.inc(1), called_off: &|_| false };
    let rows = ensemble::run(rig, &table.parameters(rig), &settings, &conduct);
    bar.finish_and_clear();
    let wall = begin.elapsed().as_secs_f64();
    write(&path, rig, &table, &rows)?;

    let done = rows.iter().filter(|row| row.run.is_ok()).count();
    let simulated: f64 = rows.iter().map(Row::time).sum();
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.fact("cranes", rows.len(), "");
    report.fact("reached the end", done, "");
    report.fact("method", settings.method.title(), "");
    if settings.method.is_adaptive() {
        report.fact("tolerance", settings.tolerance, "m, rad");
    } else {
        report.fact("step", settings.step_taken(), "s");
        report.fact("step from", step, "");
    }
    report.fact("threads", threads, "");
    report.fact("wall time", wall, "s");
    report.fact("cranes per second", rows.len() as f64 / wall, "");
    report.fact("real-time factor", simulated / wall, "");
    report.fact("written to", path.display().to_string(), "");
    report.print(options.analysis.format, out)?;
    if done == rows.len() {
        return Ok(());
    }
    Err(Problem::failed(
        format!("{} of {} cranes did not reach the end", rows.len() - done, rows.len()),
        format!("see the column `status` of {}", path.display()),
    ))
}

/// Settings of all runs, and whose step it is by a method with constant steps: stable for the first and the last row that rest, the
/// spec's at most unless another is asked for.
fn settings(
    timing: &Timing,
    rig: &dyn DynCrane,
    table: &ParameterTable,
) -> Outcome<(dynamics::Settings, &'static str)> {
    let startable = |row: &Vec<f64>| {
        let crane = table.crane(rig, row)?;
        let start = Start::of(crane.as_ref())?;
        Ok::<_, Problem>((crane, start))
    };
    let rests = |row: &Vec<f64>| startable(row).ok();
    // If no crane rests, the first one gives the reason.
    let (crane, from) =
        startable(&table.rows[0]).or_else(|problem| table.rows.iter().find_map(rests).ok_or(problem))?;
    let method = timing.method.unwrap_or(if timing.step.is_some() { Method::Rk4 } else { Method::RECOMMENDED });
    if method.is_adaptive() {
        let settings = timing.settings(crane.as_ref(), &from, method)?;
        return Ok((dynamics::Settings { audit: false, ..settings }, ""));
    }
    let safe = Timing { step: Some(timing.step.unwrap_or(Step::Auto)), ..timing.clone() };
    let safe_for = |crane: &dyn DynCrane, start: &Start| safe.settings(crane, start, Method::Rk4);
    let mut settings = safe_for(crane.as_ref(), &from)?;
    if let Some((crane, from)) = table.rows.iter().rev().find_map(rests) {
        settings.step = settings.step.min(safe_for(crane.as_ref(), &from)?.step);
    }
    let own = rig.description().step;
    let (step, from) = match timing.step {
        Some(Step::Seconds(step)) => (step, "`--step`"),
        None if own <= settings.step => (own, "the spec; safe for the first and last row"),
        _ => (settings.step, "the largest step that is safe for the first and last row"),
    };
    Ok((dynamics::Settings { step, audit: false, ..settings }, from))
}

/// Writes parameters, peaks, time reached, cautions and status of every crane.
fn write(path: &Path, rig: &dyn DynCrane, table: &ParameterTable, rows: &[Row]) -> Outcome<()> {
    let description = rig.description();
    let parameters = table.columns.iter().map(|&index| &description.parameters[index]);
    let parameters = parameters.map(|info| Column { name: info.name.to_string(), unit: info.unit.to_string() });
    let peaks = Peaks::columns(description);
    let time = Column { name: "time".to_owned(), unit: "s".to_owned() };
    let header: Vec<String> = parameters.chain(peaks.clone()).chain([time]).map(|column| column.to_string()).collect();
    let header = header.into_iter().chain(["cautions".to_owned(), "status".to_owned()]);
    let rows = rows.iter().zip(&table.rows).map(|(row, parameters)| {
        let values: Vec<Option<f64>> = match &row.peaks {
            Some(peaks) => peaks.values().map(Some).collect(),
            None => vec![None; peaks.len()],
        };
        let numbers = parameters.iter().copied().map(Some).chain(values).chain([Some(row.time())]);
        let numbers = numbers.map(|number| number.map_or_else(String::new, files::number));
        let status = row.run.as_ref().map_or_else(ToString::to_string, |_| DONE.to_owned());
        numbers.chain([row.cautions.join("; "), status]).collect()
    });
    files::write_fields(path, header, rows)
}
