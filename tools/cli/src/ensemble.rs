//! `crane simulate --ensemble`: a run of every row of a table of parameters.

use std::{
    io::Write,
    num::NonZeroUsize,
    path::Path,
    sync::{Mutex, PoisonError},
    thread,
    time::Instant,
};

use crane_model::{
    dyn_crane::{DynCrane, Member},
    dynamics::{self, InitialState, Method, ensemble::LANES},
    results::{Column, Peaks},
};

use crate::{
    Fleet,
    arguments::{Ensemble, Simulate, Step, Timing},
    files,
    parameter_table::ParameterTable,
    problem::{Outcome, Problem},
    report::Report,
    run::batches,
    start::Start,
};

/// Status of a run that reached its end.
const DONE: &str = "done";

/// What is told of one crane.
struct Row {
    /// Its peaks, if it reached the end.
    peaks: Option<Peaks>,
    /// Time reached, s.
    time: f64,
    /// [`DONE`], or why not.
    status: String,
}

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
    let rows = run(rig, &table, &settings, threads);
    let wall = begin.elapsed().as_secs_f64();
    write(&path, rig, &table, &rows)?;

    let done = rows.iter().filter(|row| row.status == DONE).count();
    let simulated: f64 = rows.iter().map(|row| row.time).sum();
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.fact("cranes", rows.len(), "");
    report.fact("reached the end", done, "");
    report.fact("step", settings.step_taken(), "s");
    report.fact("step from", step, "");
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
        format!("the column `status` of {} says why", path.display()),
    ))
}

/// Settings of all runs, and whose step it is: stable for the first and the last row that rest, the spec's at most unless
/// another is asked for.
fn settings(
    timing: &Timing,
    rig: &dyn DynCrane,
    table: &ParameterTable,
) -> Outcome<(dynamics::Settings, &'static str)> {
    let startable = |row: &Vec<f64>| {
        let crane = table.crane(rig, row)?;
        Start::of(crane.as_ref()).map(|start| (crane, start))
    };
    let rests = |row: &Vec<f64>| startable(row).ok();
    if let Some(method) = timing.method.filter(|method| *method != Method::Rk4) {
        let title = format!("`--method {method}` moves one crane alone; eight in lanes share the steps of rk4");
        return Err(Problem::usage(title, "leave `--method` out with `--ensemble`"));
    }
    // Where no crane rests, the first tells why.
    let (crane, start) =
        startable(&table.rows[0]).or_else(|problem| table.rows.iter().find_map(rests).ok_or(problem))?;
    let safe = Timing { step: Some(timing.step.unwrap_or(Step::Auto)), ..timing.clone() };
    let mut settings = safe.settings(crane.as_ref(), &start, Method::Rk4)?;
    if let Some((crane, start)) = table.rows.iter().rev().find_map(rests) {
        settings.step = settings.step.min(safe.settings(crane.as_ref(), &start, Method::Rk4)?.step);
    }
    let own = rig.description().step;
    let (step, from) = match timing.step {
        Some(Step::Seconds(step)) => (step, "`--step`"),
        None if own <= settings.step => (own, "the spec, safe for the first and last row"),
        _ => (settings.step, "the largest safe one of the first and last row"),
    };
    Ok((dynamics::Settings { step, audit: false, ..settings }, from))
}

/// Runs batches of cranes on threads, each taking the next when it is done with one; the rows in order.
fn run(rig: &dyn DynCrane, table: &ParameterTable, settings: &dynamics::Settings, threads: usize) -> Vec<Row> {
    let bar = batches(table.rows.len().div_ceil(LANES));
    let waiting = Mutex::new(table.rows.chunks(LANES).enumerate());
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let finished = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..threads.min(table.rows.len().div_ceil(LANES)) {
            scope.spawn(|| {
                while let Some((index, rows)) = next() {
                    let rows = batch(rig, table, rows, settings);
                    finished.lock().unwrap_or_else(PoisonError::into_inner).push((index, rows));
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    let mut finished = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    finished.sort_by_key(|(index, _)| *index);
    finished.into_iter().flat_map(|(_, rows)| rows).collect()
}

/// Runs the cranes of some rows, those that rest, side by side.
fn batch(rig: &dyn DynCrane, table: &ParameterTable, rows: &[Vec<f64>], settings: &dynamics::Settings) -> Vec<Row> {
    let mut told: Vec<Row> = rows.iter().map(|_| Row { peaks: None, time: 0.0, status: DONE.to_owned() }).collect();
    let (mut places, mut cranes, mut members) = (Vec::new(), Vec::new(), Vec::new());
    for (place, row) in rows.iter().enumerate() {
        let crane = table.crane(rig, row);
        match crane.and_then(|crane| Start::of(crane.as_ref()).map(|start| (crane, start))) {
            Ok((crane, start)) => {
                let parameters = (0..rig.description().parameters.len()).map(|index| crane.parameter(index)).collect();
                members.push(Member { parameters, start: InitialState::at_rest(start.q) });
                cranes.push(crane);
                places.push(place);
            }
            Err(problem) => problem.title().clone_into(&mut told[place].status),
        }
    }
    let mut peaks = vec![Peaks::default(); members.len()];
    let results = rig.simulate_ensemble(&members, settings, &mut |member, sample| {
        peaks[member].push(cranes[member].as_ref(), sample);
    });
    let results = match results {
        Ok(results) => results,
        Err(refused) => {
            for place in places {
                told[place].status = refused.to_string();
            }
            return told;
        }
    };
    for ((place, peaks), result) in places.into_iter().zip(peaks).zip(results) {
        told[place] = match result {
            Ok(run) => Row { peaks: Some(peaks), time: run.time, status: DONE.to_owned() },
            Err(stopped) => Row { peaks: None, time: stopped.time, status: stopped.to_string() },
        };
    }
    told
}

/// Writes parameters, peaks, time reached and status of every crane.
fn write(path: &Path, rig: &dyn DynCrane, table: &ParameterTable, rows: &[Row]) -> Outcome<()> {
    let description = rig.description();
    let parameters = table.columns.iter().map(|&index| &description.parameters[index]);
    let parameters = parameters.map(|info| Column { name: info.name.to_string(), unit: info.unit.to_string() });
    let peaks = Peaks::columns(description);
    let time = Column { name: "time".to_owned(), unit: "s".to_owned() };
    let header: Vec<String> = parameters.chain(peaks.clone()).chain([time]).map(|column| column.to_string()).collect();
    let header = header.into_iter().chain(["status".to_owned()]);
    let rows = rows.iter().zip(&table.rows).map(|(row, parameters)| {
        let values: Vec<Option<f64>> = match &row.peaks {
            Some(peaks) => peaks.values().map(Some).collect(),
            None => vec![None; peaks.len()],
        };
        let numbers = parameters.iter().copied().map(Some).chain(values).chain([Some(row.time)]);
        let numbers = numbers.map(|number| number.map_or_else(String::new, files::number));
        numbers.chain([row.status.clone()]).collect()
    });
    files::write_fields(path, header, rows)
}
