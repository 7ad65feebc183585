//! Runs of many cranes that differ in their parameters, with any method, on several threads.
//!
//! With adaptive methods every crane runs separately; with [`Method::Rk4`] several run together in the lanes of
//! [`dynamics::ensemble`]. The result of a row does not depend on the other rows or on the number of threads.

use std::{
    ops::ControlFlow,
    sync::{Mutex, PoisonError},
    thread,
};

use super::{self as runs, Failed, Start};
use crate::{
    ParameterError,
    dyn_crane::DynCrane,
    dynamics::{self, InitialState, Method, Run, Sample, Settings, Watch, ensemble::Member},
    results::{self, Peaks, Recording, cautions},
};

/// What distinguishes a row from the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    /// Live parameters, in the order of the description.
    pub parameters: Vec<f64>,
    /// Inputs, in the order of the description; none: those of the crane.
    pub inputs: Vec<Option<f64>>,
    /// Pose at the start, if it is not that of [`Start::of`].
    pub q: Option<Vec<f64>>,
    /// Rates at the start.
    pub v: Option<Vec<f64>>,
}

impl From<Vec<f64>> for Case {
    /// A case with other parameters.
    fn from(parameters: Vec<f64>) -> Self {
        Self { parameters, ..Self::default() }
    }
}

/// The result of the run of a row.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Extremes and final values, if it reached the end.
    pub peaks: Option<Peaks>,
    /// Pose and rates reached.
    pub end: InitialState,
    /// Cautions about the run.
    pub cautions: Vec<String>,
    /// Steps and time, or why it did not reach the end.
    pub run: Result<Run, Reason>,
}

/// Why a row did not reach the end.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// Its parameters break a rule of the spec language.
    Refused(ParameterError),
    /// It cannot start, or stopped before its end.
    Failed(Failed),
    /// The ensemble was cancelled.
    Cancelled,
}

impl Outcome {
    fn without_run(reason: Reason) -> Self {
        Self { peaks: None, end: InitialState::default(), cautions: Vec::new(), run: Err(reason) }
    }

    /// Time reached, s.
    pub fn time(&self) -> f64 {
        match &self.run {
            Ok(run) => run.time,
            Err(Reason::Failed(failed)) => match failed.reason.as_ref() {
                runs::Reason::Stopped { stopped, .. } => stopped.time,
                _ => 0.0,
            },
            Err(_) => 0.0,
        }
    }
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Reason::Refused(refused) => write!(f, "{refused}"),
            Reason::Failed(failed) => write!(f, "{failed}"),
            Reason::Cancelled => f.write_str("cancelled"),
        }
    }
}

/// How an ensemble is executed, in addition to its settings.
pub struct Execution<'a> {
    /// Number of threads.
    pub threads: usize,
    /// Called with every completed row, in the order of completion, from any thread.
    pub done: &'a (dyn Fn(usize, &Outcome) + Sync),
    /// Whether to cancel the rest; called after every step, with `true` on the calling thread.
    pub cancelled: &'a (dyn Fn(bool) -> bool + Sync),
}

/// Runs the crane of every row, each from its own start. One outcome per row, in order.
pub fn run_ensemble(
    crane: &dyn DynCrane,
    rows: &[Case],
    settings: &Settings,
    execution: &Execution<'_>,
) -> Vec<Outcome> {
    // Lanes support neither states of forces nor different inputs nor loops.
    let same_inputs = rows.iter().all(|row| row.inputs.is_empty());
    let in_lanes = settings.method == Method::Rk4 && same_inputs && !crane.description().has_force_states();
    let in_lanes = in_lanes && crane.loop_joints().is_empty();
    let piece = if in_lanes { crane.lanes() } else { 1 };
    let waiting = Mutex::new(rows.chunks(piece).enumerate());
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let finished = Mutex::new(Vec::with_capacity(rows.len()));
    let work = |caller: bool| {
        let off = || (execution.cancelled)(caller);
        while let Some((index, rows)) = next() {
            let outcomes = match rows {
                _ if off() => rows.iter().map(|_| Outcome::without_run(Reason::Cancelled)).collect(),
                [row] if !in_lanes => vec![alone(crane, row, settings, &off)],
                rows => side_by_side(crane, rows, settings),
            };
            for (position, outcome) in outcomes.into_iter().enumerate() {
                let row = index * piece + position;
                if !matches!(outcome.run, Err(Reason::Cancelled)) {
                    (execution.done)(row, &outcome);
                }
                finished.lock().unwrap_or_else(PoisonError::into_inner).push((row, outcome));
            }
        }
    };
    thread::scope(|scope| {
        for _ in 1..execution.threads.min(rows.len().div_ceil(piece)) {
            scope.spawn(|| work(false));
        }
        work(true);
    });
    let mut finished = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    finished.sort_by_key(|(row, _)| *row);
    finished.into_iter().map(|(_, outcome)| outcome).collect()
}

/// The crane of a row, and the start of its run.
///
/// # Errors
/// Its parameters break a rule, or it has no start.
pub fn ready(crane: &dyn DynCrane, row: &Case) -> Result<(Box<dyn DynCrane>, Start), Reason> {
    let mut row_crane = crane.boxed_clone();
    row_crane.set_parameters(&row.parameters).map_err(Reason::Refused)?;
    for (index, input) in row.inputs.iter().enumerate() {
        row_crane.set_input(index, *input);
    }
    let start = Start::with(row_crane.as_ref(), row.q.as_deref(), row.v.as_deref()).map_err(Reason::Failed)?;
    Ok((row_crane, start))
}

/// The record of a run in progress.
struct Gathering<'a> {
    crane: &'a dyn DynCrane,
    recording: Recording<'a>,
    end: InitialState,
    off: &'a dyn Fn() -> bool,
    cancelled: bool,
}

impl<'a> Gathering<'a> {
    fn new(crane: &'a dyn DynCrane, off: &'a dyn Fn() -> bool) -> Self {
        let (recording, end) = (Recording::of_peaks(crane), InitialState::default());
        Self { crane, recording, end, off, cancelled: false }
    }

    fn take(&mut self, sample: &Sample<'_>) {
        self.recording.push(sample);
        let InitialState { q, v, x } = &mut self.end;
        for (end, now) in [(q, sample.q), (v, sample.v), (x, sample.x)] {
            end.clear();
            end.extend_from_slice(now);
        }
    }

    fn finish(self, run: Result<Run, dynamics::Stopped>) -> Outcome {
        if self.cancelled {
            return Outcome::without_run(Reason::Cancelled);
        }
        let (description, table) = (self.crane.description(), self.recording.into_table());
        let near_singular = cautions::near_singular(description, &table);
        let tilted = cautions::large_tilt(description, &table).into_iter();
        let unassembled = || {
            let (cylinder, time) = results::unassembled(description, &table)?;
            Some(runs::Reason::Unassembled { cylinder, time })
        };
        let failed = match run {
            Ok(run) => unassembled().map_or(Ok(run), Err),
            Err(stopped) => Err(runs::Reason::Stopped { stopped, near_singular: near_singular.clone(), limit: None }),
        };
        match failed {
            Ok(run) => {
                let of_run = cautions::of_run(self.crane, &table, cautions::BEND);
                Outcome { peaks: Some(Peaks::of(description, &table)), end: self.end, cautions: of_run, run: Ok(run) }
            }
            Err(reason) => {
                let run = Err(Reason::Failed(reason.of(&description.name)));
                Outcome { peaks: None, end: self.end, cautions: tilted.collect(), run }
            }
        }
    }
}

impl Watch for Gathering<'_> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.take(sample);
        ControlFlow::Continue(())
    }

    fn step(&mut self, _: f64) -> ControlFlow<()> {
        self.cancelled = (self.off)();
        if self.cancelled { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Runs the crane of one row.
fn alone(crane: &dyn DynCrane, row: &Case, settings: &Settings, off: &dyn Fn() -> bool) -> Outcome {
    let (row_crane, start) = match ready(crane, row) {
        Ok(ready) => ready,
        Err(reason) => return Outcome::without_run(reason),
    };
    let mut gathering = Gathering::new(row_crane.as_ref(), off);
    let run = dynamics::simulate_watched(row_crane.as_ref(), &start.state(), settings, &mut gathering);
    gathering.finish(run)
}

/// Runs the cranes of some rows together, except those that cannot start.
fn side_by_side(crane: &dyn DynCrane, rows: &[Case], settings: &Settings) -> Vec<Outcome> {
    let ready: Vec<_> = rows.iter().map(|row| ready(crane, row)).collect();
    let mut members = Vec::new();
    let mut gatherings = Vec::new();
    for ((row_crane, start), row) in ready.iter().zip(rows).filter_map(|(ready, row)| Some((ready.as_ref().ok()?, row)))
    {
        members.push(Member { parameters: row.parameters.clone(), start: start.state() });
        gatherings.push(Gathering::new(row_crane.as_ref(), &|| false));
    }
    let runs = crane.simulate_ensemble(&members, settings, &mut |member, sample| gatherings[member].take(sample));
    let mut outcomes = match runs {
        Ok(runs) => gatherings.into_iter().zip(runs).map(|(gathering, run)| gathering.finish(run)).collect::<Vec<_>>(),
        Err(refused) => {
            let refused = || Outcome::without_run(Reason::Refused(refused.clone()));
            gatherings.iter().map(|_| refused()).collect()
        }
    }
    .into_iter();
    let outcome = |ready: &Result<_, Reason>| match ready {
        Ok(_) => outcomes.next().unwrap_or_else(|| Outcome::without_run(Reason::Cancelled)),
        Err(reason) => Outcome::without_run(reason.clone()),
    };
    ready.iter().map(outcome).collect()
}
