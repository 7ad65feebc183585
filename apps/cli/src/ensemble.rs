//! `crane simulate --ensemble`: a run of every row of a table of parameters.

use std::{
    io::Write,
    num::NonZeroUsize,
    path::Path,
    sync::{Mutex, PoisonError},
    thread,
    time::Instant,
};

use crane_codegen::SourceFile;
use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{self, Method},
    results::{Column, Peaks},
    runs::{
        Start,
        ensemble::{self, Case, Execution, Outcome as Row},
    },
};
use crane_page::tables::{Report, number_text};
use serde_json::Value;

use crate::{
    arguments::{Ensemble, Simulate, Step, Timing},
    files,
    journal::{self, Journal, Request},
    parameter_table::ParameterTable,
    problem::{Outcome, Problem},
    selection::Registry,
    simulate::method,
};

/// Status of a run that reached its end.
const DONE: &str = "done";

/// The crane, or the live one of its spec if that runs as fleets, which are faster than what rustc compiled.
fn as_fleets(crane: Box<dyn DynCrane>, settings: &dynamics::Settings, registry: &Registry) -> Box<dyn DynCrane> {
    let together = |crane: &dyn DynCrane| ensemble::rows_together(crane, settings);
    match registry.live(crane.as_ref()) {
        Ok(live) if together(&live) > together(crane.as_ref()) => Box::new(live),
        _ => crane,
    }
}

/// Runs all cranes of the table and writes a row for each.
pub fn simulate(options: &Simulate, given: &Path, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    if options.run.timing.from.is_some() || !options.run.timing.start.is_empty() {
        return Err(Problem::usage(
            "`--from` and `--start` do not apply to `--ensemble`: each row starts where its crane rests",
            "leave them out, or simulate the rows one by one",
        ));
    }
    let crane = options.run.analysis.crane.open(registry)?;
    let table = ParameterTable::read(&registry.console, given, crane.description())?;
    let (settings, step) = settings(&options.run.timing, crane.as_ref(), &table)?;
    let crane = as_fleets(crane, &settings, registry);
    let crane = crane.as_ref();
    let description = crane.description();
    let Ensemble { threads, results, restart, .. } = &options.ensemble;
    let threads = threads.map_or_else(thread::available_parallelism, Ok).map_or(1, NonZeroUsize::get);
    let path =
        results.clone().unwrap_or_else(|| options.run.folder.out.join(format!("{}_ensemble.csv", description.name)));
    registry.console.check_place(&path)?;
    files::folder(path.parent().unwrap_or(&path))?;

    let begin = Instant::now();
    let (journal, records) =
        Journal::open(&path.with_extension("part.csv"), &request(crane, &settings, &table), *restart)?;
    let header = header(crane, &table);
    let mut kept = kept_rows(&records, table.rows.len(), header.len());
    // Rows that run together depend on each other, so that the others of an incomplete piece would become different ones.
    for piece in kept.chunks_mut(ensemble::rows_together(crane, &settings)) {
        if piece.iter().any(Option::is_none) {
            piece.fill(None);
        }
    }
    let fresh: Vec<usize> = (0..kept.len()).filter(|row| kept[*row].is_none()).collect();
    let bar = registry.console.batches(kept.len());
    bar.inc((kept.len() - fresh.len()) as u64);
    let state = Mutex::new((kept, Ok(())));
    let parameters = table.parameters(crane);
    let cases: Vec<Case> = fresh.iter().map(|row| Case::from(parameters[*row].clone())).collect();
    let done = |index: usize, outcome: &Row| {
        let row = fresh[index];
        let fields = fields(crane, &table.rows[row], outcome);
        let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.1.is_ok() {
            state.1 = journal.add([[vec![row.to_string()], fields.clone()].concat()]);
        }
        state.0[row] = Some(fields);
        bar.inc(1);
    };
    let failed = |_| state.lock().unwrap_or_else(PoisonError::into_inner).1.is_err();
    let execution = Execution { threads, done: &done, cancelled: &failed };
    let simulated: f64 = ensemble::run_ensemble(crane, &cases, &settings, &execution).iter().map(Row::time).sum();
    bar.finish_and_clear();
    let wall = registry.console.seconds_since(begin);
    let (rows, written) = state.into_inner().unwrap_or_else(PoisonError::into_inner);
    written?;
    let rows: Vec<Vec<String>> = rows.into_iter().flatten().collect();
    let reached = rows.iter().filter(|row| row.last().is_some_and(|status| status == DONE)).count();
    registry.console.write_fields(&path, header.into_iter(), rows.iter().cloned())?;
    journal.remove()?;

    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.fact("cranes", rows.len(), "");
    report.fact_as("kept_from_before", "reused from an earlier run", rows.len() - fresh.len(), "");
    report.fact("reached the end", reached, "");
    method(&mut report, &settings);
    if settings.method.is_adaptive() {
        report.value("step", Value::Null);
        report.value("step_from", Value::Null);
    } else {
        report.fact("step", settings.step_taken(), "s");
        report.fact("step from", step, "");
    }
    report.fact("threads", threads, "");
    if let Some(wall) = wall {
        report.fact("wall time", wall, "s");
        report.fact("cranes per second", fresh.len() as f64 / wall, "");
        report.fact("real-time factor", simulated / wall, "");
    }
    report.fact("written to", path.display().to_string(), "");
    options.run.analysis.format.print(&report, &registry.console, out)?;
    if reached == rows.len() {
        return Ok(());
    }
    Err(Problem::failed(
        format!("{} of {} cranes did not reach the end", rows.len() - reached, rows.len()),
        format!("see the column `status` of {}", path.display()),
    ))
}

/// What the rows depend on: the crane, the settings of the runs, and the table.
fn request(crane: &dyn DynCrane, settings: &dynamics::Settings, table: &ParameterTable) -> Request<'static> {
    let cases = SourceFile::new("table", format!("{settings:?} {:?} {:?}", table.columns, table.rows)).hash();
    Request {
        line: format!("{} {cases}", journal::identity(crane)),
        of: "an ensemble",
        elsewhere: "choose another file with `--file`",
    }
}

/// Fields of the rows that an interrupted command completed; `width`: how many a row has.
fn kept_rows(records: &[Vec<String>], rows: usize, width: usize) -> Vec<Option<Vec<String>>> {
    let mut kept = vec![None; rows];
    for record in records {
        if let [row, fields @ ..] = record.as_slice()
            && let Some(slot) = row.parse().ok().and_then(|row: usize| kept.get_mut(row))
            && fields.len() == width
        {
            *slot = Some(fields.to_vec());
        }
    }
    kept
}

/// Settings of all runs, and for a method with constant steps where its step size comes from: stable for the first and the last row
/// that have an equilibrium, and at most the spec's unless another is asked for.
fn settings(
    timing: &Timing,
    base: &dyn DynCrane,
    table: &ParameterTable,
) -> Outcome<(dynamics::Settings, &'static str)> {
    let startable = |row: &Vec<f64>| {
        let crane = table.crane(base, row)?;
        let start = Start::new(crane.as_ref())?;
        Ok::<_, Problem>((crane, start))
    };
    let rests = |row: &Vec<f64>| startable(row).ok();
    // If no crane has an equilibrium, the first one gives the reason.
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
    let crane_step = base.description().step;
    let (step, from) = match timing.step {
        Some(Step::Seconds(step)) => (step, "`--step`"),
        asked => {
            let of_spec = asked.is_none().then_some(crane_step);
            let step = ensemble::constant_step(of_spec, settings.step);
            let is_of_spec = of_spec.is_some_and(|of_spec| of_spec <= step);
            let from = if is_of_spec {
                "the spec; safe for the first and last row"
            } else {
                "the largest step that is safe for the first and last row"
            };
            (step, from)
        }
    };
    Ok((dynamics::Settings { step, audit: false, ..settings }, from))
}

/// Headings: parameters, peaks and time reached with their units, cautions and status.
fn header(crane: &dyn DynCrane, table: &ParameterTable) -> Vec<String> {
    let parameters = table.columns.iter().map(|&index| &crane.description().parameters[index]);
    let parameters = parameters.map(|info| Column::new(info.name.as_str(), info.unit.as_str()));
    let time = Column::new("time", "s");
    let columns = parameters.chain(Peaks::columns(crane)).chain([time]).map(|column| column.to_string());
    columns.chain(["cautions".to_owned(), "status".to_owned()]).collect()
}

/// Parameters, peaks, time reached, cautions and status of a crane, without line ends.
fn fields(crane: &dyn DynCrane, parameters: &[f64], row: &Row) -> Vec<String> {
    let values: Vec<Option<f64>> = match &row.peaks {
        Some(peaks) => peaks.values().map(Some).collect(),
        None => vec![None; Peaks::columns(crane).len()],
    };
    let numbers = parameters.iter().copied().map(Some).chain(values).chain([Some(row.time())]);
    let numbers = numbers.map(|number| number.map_or_else(String::new, number_text));
    let status = row.run.as_ref().map_or_else(ToString::to_string, |_| DONE.to_owned());
    numbers.chain([row.cautions.join("; "), status].map(|words| words.replace(['\n', '\r'], " "))).collect()
}
