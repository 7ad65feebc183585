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
    dyn_crane::{DynCrane, Member},
    dynamics::{self, InitialState, Method, Run, Sample, Settings, Watch},
    results::{Extremes, Peaks, cautions},
};

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
    /// It cannot start, or stopped before its time.
    Failed(Failed),
    /// The ensemble was cancelled.
    CalledOff,
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
            Reason::CalledOff => f.write_str("cancelled"),
        }
    }
}

/// Execution of an ensemble, besides its settings.
pub struct Conduct<'a> {
    /// Threads.
    pub threads: usize,
    /// Called with every completed row, in the order of completion, from any thread.
    pub done: &'a (dyn Fn(usize, &Outcome) + Sync),
    /// Whether to cancel the rest; called after every step, with `true` on the calling thread.
    pub called_off: &'a (dyn Fn(bool) -> bool + Sync),
}

/// Runs the crane with every row of parameters, all of them in the order of the description, each from its own [`Start`]. One outcome
/// per row, in order.
pub fn run(crane: &dyn DynCrane, rows: &[Vec<f64>], settings: &Settings, conduct: &Conduct<'_>) -> Vec<Outcome> {
    // States of forces have no lanes.
    let in_lanes = settings.method == Method::Rk4 && !crane.description().has_own_states();
    let piece = if in_lanes { crane.lanes() } else { 1 };
    let waiting = Mutex::new(rows.chunks(piece).enumerate());
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let finished = Mutex::new(Vec::with_capacity(rows.len()));
    let work = |caller: bool| {
        let off = || (conduct.called_off)(caller);
        while let Some((index, rows)) = next() {
            let outcomes = match rows {
                _ if off() => rows.iter().map(|_| Outcome::without_run(Reason::CalledOff)).collect(),
                [row] if !in_lanes => vec![alone(crane, row, settings, &off)],
                rows => side_by_side(crane, rows, settings),
            };
            for (place, outcome) in outcomes.into_iter().enumerate() {
                let row = index * piece + place;
                if !matches!(outcome.run, Err(Reason::CalledOff)) {
                    (conduct.done)(row, &outcome);
                }
                finished.lock().unwrap_or_else(PoisonError::into_inner).push((row, outcome));
            }
        }
    };
    thread::scope(|scope| {
        for _ in 1..conduct.threads.min(rows.len().div_ceil(piece)) {
            scope.spawn(|| work(false));
        }
        work(true);
    });
    let mut finished = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    finished.sort_by_key(|(row, _)| *row);
    finished.into_iter().map(|(_, outcome)| outcome).collect()
}

/// The crane with other parameters, and the start of its run.
fn ready(crane: &dyn DynCrane, parameters: &[f64]) -> Result<(Box<dyn DynCrane>, Start), Reason> {
    let mut own = crane.boxed_clone();
    own.set_parameters(parameters).map_err(Reason::Refused)?;
    let start = Start::of(own.as_ref()).map_err(Reason::Failed)?;
    Ok((own, start))
}

/// The record of a run in progress.
struct Gathering<'a> {
    crane: &'a dyn DynCrane,
    peaks: Peaks,
    odd: [Option<String>; 2],
    end: InitialState,
    off: &'a dyn Fn() -> bool,
    called_off: bool,
}

impl<'a> Gathering<'a> {
    fn new(crane: &'a dyn DynCrane, off: &'a dyn Fn() -> bool) -> Self {
        let (peaks, end) = (Peaks::default(), InitialState::default());
        Self { crane, peaks, odd: [None, None], end, off, called_off: false }
    }

    fn take(&mut self, sample: &Sample<'_>) {
        let description = self.crane.description();
        self.peaks.push(self.crane, sample);
        let [singular, tilted] = &mut self.odd;
        *singular = singular.take().or_else(|| description.near_singular(sample.q));
        *tilted = tilted.take().or_else(|| description.large_tilt(sample.q));
        self.end.q.clear();
        self.end.v.clear();
        self.end.x.clear();
        self.end.q.extend_from_slice(sample.q);
        self.end.v.extend_from_slice(sample.v);
        self.end.x.extend_from_slice(sample.x);
    }

    fn finish(self, run: Result<Run, dynamics::Stopped>) -> Outcome {
        let [singular, tilted] = self.odd;
        if self.called_off {
            return Outcome::without_run(Reason::CalledOff);
        }
        let description = self.crane.description();
        match run {
            Ok(run) => {
                let columns = Peaks::columns(description);
                let values: Vec<f64> = self.peaks.values().collect();
                let extremes = |name: &str| {
                    let first = columns.iter().position(|column| column.name.strip_suffix("_min") == Some(name))?;
                    let &[minimum, time_of_minimum, maximum, time_of_maximum] = values[first..].first_chunk()?;
                    Some(Extremes { minimum, time_of_minimum, maximum, time_of_maximum })
                };
                let pulls = cautions::of_reactions(description, &extremes);
                let cautions = singular.into_iter().chain(tilted).chain(pulls).collect();
                Outcome { peaks: Some(self.peaks), end: self.end, cautions, run: Ok(run) }
            }
            Err(stopped) => {
                let failed =
                    runs::Reason::Stopped { stopped, near_singular: singular, limit: None }.of(&description.name);
                let cautions = tilted.into_iter().collect();
                Outcome { peaks: None, end: self.end, cautions, run: Err(Reason::Failed(failed)) }
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
        self.called_off = (self.off)();
        if self.called_off { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Runs the crane of one row.
fn alone(crane: &dyn DynCrane, parameters: &[f64], settings: &Settings, off: &dyn Fn() -> bool) -> Outcome {
    let (own, start) = match ready(crane, parameters) {
        Ok(ready) => ready,
        Err(reason) => return Outcome::without_run(reason),
    };
    let mut gathering = Gathering::new(own.as_ref(), off);
    let run = dynamics::simulate_watched(own.as_ref(), &start.state(), settings, &mut gathering);
    gathering.finish(run)
}

/// Runs the cranes of some rows together, those that can start.
fn side_by_side(crane: &dyn DynCrane, rows: &[Vec<f64>], settings: &Settings) -> Vec<Outcome> {
    let ready: Vec<_> = rows.iter().map(|row| ready(crane, row)).collect();
    let mut members = Vec::new();
    let mut gatherings = Vec::new();
    for ((own, start), row) in ready.iter().zip(rows).filter_map(|(ready, row)| Some((ready.as_ref().ok()?, row))) {
        members.push(Member { parameters: row.clone(), start: start.state() });
        gatherings.push(Gathering::new(own.as_ref(), &|| false));
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
        Ok(_) => outcomes.next().unwrap_or_else(|| Outcome::without_run(Reason::CalledOff)),
        Err(reason) => Outcome::without_run(reason.clone()),
    };
    ready.iter().map(outcome).collect()
}
