//! Runs of many cranes that differ in their parameters, with any method, on several threads.
//!
//! Several cranes run together, with common steps, in the lanes of [`dynamics::ensemble`]: with [`dynamics::Method::Rk4`], or as a fleet, if the crane has
//! fleets. The others run separately. Results do not depend on the number of threads; those of a fleet depend on its other rows, within the
//! tolerance.

use std::{
    ops::ControlFlow,
    sync::{Mutex, PoisonError},
    thread,
};

use super::{self as runs, Failed, Start};
use crate::{
    ParameterError,
    dyn_crane::DynCrane,
    dynamics::{self, InitialState, Run, Sample, Settings, Simulation, Watch, ensemble::Member},
    interleaved,
    results::{self, FleetRecording, Peaks, Recording, Table, cautions},
};

/// What distinguishes a row from the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    /// Live parameters, in the order of the description.
    pub parameters: Vec<f64>,
    /// Inputs, in the order of the description; none: those of the crane.
    pub inputs: Vec<Option<f64>>,
    /// Pose at the start, if it is not that of [`Start::new`].
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
    let way = Way::choose(crane, rows, settings);
    let pieces = way.pieces(rows);
    let waiting = Mutex::new(pieces.iter());
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
    let finished = Mutex::new(Vec::with_capacity(rows.len()));
    let work = |caller: bool| {
        let off = || (execution.cancelled)(caller);
        while let Some(&(first, rows)) = next() {
            let outcomes = match rows {
                _ if off() => rows.iter().map(|_| Outcome::without_run(Reason::Cancelled)).collect(),
                rows => match way {
                    Way::Alone => rows.iter().map(|row| alone(crane, row, settings, &off)).collect(),
                    Way::InLanes => side_by_side(crane, rows, settings),
                    Way::AsFleet { cranes } => as_fleet(crane, (rows, cranes), settings, &off),
                },
            };
            for (position, outcome) in outcomes.into_iter().enumerate() {
                let row = first + position;
                if !matches!(outcome.run, Err(Reason::Cancelled)) {
                    (execution.done)(row, &outcome);
                }
                finished.lock().unwrap_or_else(PoisonError::into_inner).push((row, outcome));
            }
        }
    };
    thread::scope(|scope| {
        for _ in 1..execution.threads.min(pieces.len()) {
            scope.spawn(|| work(false));
        }
        work(true);
    });
    let mut finished = finished.into_inner().unwrap_or_else(PoisonError::into_inner);
    finished.sort_by_key(|(row, _)| *row);
    finished.into_iter().map(|(_, outcome)| outcome).collect()
}

/// The constant step of all rows unless one is asked for, s: that of the spec, if it is given, as far as it is safe for the first and the last row.
pub fn constant_step(of_spec: Option<f64>, safe: f64) -> f64 {
    of_spec.map_or(safe, |step| step.min(safe))
}

/// How many rows, one after the other, run as a fleet: the digits of their results depend on each other. Otherwise 1.
pub fn rows_together(crane: &dyn DynCrane, settings: &Settings) -> usize {
    match Way::choose(crane, &[], settings) {
        Way::AsFleet { cranes } => cranes,
        Way::Alone | Way::InLanes => 1,
    }
}

/// How rows run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// One by one.
    Alone,
    /// Side by side, with constant steps.
    InLanes,
    /// As many cranes as one, with steps that all allow.
    AsFleet { cranes: usize },
}

impl Way {
    /// The fastest way.
    fn choose(crane: &dyn DynCrane, rows: &[Case], settings: &Settings) -> Self {
        // Neither fleets nor lanes change their parameters during a run.
        if !crane.description().events.is_empty() {
            return Way::Alone;
        }
        if settings.method.is_adaptive() {
            let fleet = if settings.audit { None } else { crane.fleet(&[crane]) };
            return fleet.map_or(Way::Alone, |fleet| Way::AsFleet { cranes: fleet.cranes() });
        }
        // Lanes support neither states of forces nor different inputs nor loops.
        let same_inputs = rows.iter().all(|row| row.inputs.is_empty());
        let is_plain = !crane.description().has_force_states() && crane.loop_joints().is_empty();
        if same_inputs && is_plain { Way::InLanes } else { Way::Alone }
    }

    /// The rows that run together, with the index of the first: those left over by fleets, too few for one, run one by one, on as many threads.
    fn pieces(self, rows: &[Case]) -> Vec<(usize, &[Case])> {
        let (together, left) = match self {
            Way::Alone => (1, 0),
            Way::InLanes => (dynamics::ensemble::LANES, 0),
            Way::AsFleet { cranes } => {
                let last = rows.len() % cranes;
                (cranes, if is_worth_a_fleet(last, cranes) { 0 } else { last })
            }
        };
        let (rows, left) = rows.split_at(rows.len() - left);
        let firsts = (0..rows.len()).step_by(together).chain(rows.len()..);
        firsts.zip(rows.chunks(together).chain(left.chunks(1))).collect()
    }
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
    let start = Start::with(row_crane.as_ref(), 0.0, row.q.as_deref(), row.v.as_deref()).map_err(Reason::Failed)?;
    Ok((row_crane, start))
}

/// The record of a run in progress.
struct Gathering<'a> {
    crane: &'a dyn DynCrane,
    recording: Recording<'a>,
    end: InitialState,
    off: Off<'a>,
}

/// Whether a run has been cancelled.
struct Off<'a> {
    asked: &'a dyn Fn() -> bool,
    cancelled: bool,
}

impl<'a> Off<'a> {
    fn new(asked: &'a dyn Fn() -> bool) -> Self {
        Self { asked, cancelled: false }
    }

    fn ask(&mut self) -> ControlFlow<()> {
        self.cancelled = (self.asked)();
        if self.cancelled { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Takes the state of a sample.
fn take_state(end: &mut InitialState, sample: &Sample<'_>) {
    let InitialState { q, v, x } = end;
    for (end, now) in [(q, sample.q), (v, sample.v), (x, sample.x)] {
        end.clear();
        end.extend_from_slice(now);
    }
}

impl<'a> Gathering<'a> {
    fn new(crane: &'a dyn DynCrane, off: &'a dyn Fn() -> bool) -> Self {
        let (recording, end) = (Recording::of_peaks(crane), InitialState::default());
        Self { crane, recording, end, off: Off::new(off) }
    }

    fn take(&mut self, sample: &Sample<'_>) {
        self.recording.push(sample);
        take_state(&mut self.end, sample);
    }

    fn finish(self, run: Result<Run, dynamics::Stopped>) -> Outcome {
        if self.off.cancelled {
            return Outcome::without_run(Reason::Cancelled);
        }
        outcome_of(self.crane, &self.recording.into_table(), self.end, run)
    }
}

/// The outcome of a run, from what was recorded of it and the motion at its end.
fn outcome_of(crane: &dyn DynCrane, table: &Table, end: InitialState, run: Result<Run, dynamics::Stopped>) -> Outcome {
    let description = crane.description();
    let unassembled = || {
        let (cylinder, time) = results::unassembled(description, table)?;
        Some(runs::Reason::Unassembled { cylinder, time })
    };
    let failed = match run {
        Ok(run) => unassembled().map_or(Ok(run), Err),
        Err(stopped) => {
            let near_singular = cautions::near_singular(description, table);
            Err(runs::Reason::Stopped { stopped, near_singular, limit: None })
        }
    };
    match failed {
        Ok(run) => {
            let of_run = cautions::of_run(crane, table, cautions::BEND);
            Outcome { peaks: Some(Peaks::new(description, table)), end, cautions: of_run, run: Ok(run) }
        }
        Err(reason) => {
            let tilted = cautions::large_tilt(description, table).into_iter();
            let run = Err(Reason::Failed(reason.for_crane(&description.name)));
            Outcome { peaks: None, end, cautions: tilted.collect(), run }
        }
    }
}

impl Watch for Gathering<'_> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.take(sample);
        ControlFlow::Continue(())
    }

    fn step(&mut self, _: f64) -> ControlFlow<()> {
        self.off.ask()
    }
}

/// Runs the crane of one row.
fn alone(crane: &dyn DynCrane, row: &Case, settings: &Settings, off: &dyn Fn() -> bool) -> Outcome {
    match ready(crane, row) {
        Ok((crane, start)) => alone_from(crane.as_ref(), &start, settings, off),
        Err(reason) => Outcome::without_run(reason),
    }
}

/// Runs a crane from its start.
fn alone_from(crane: &dyn DynCrane, start: &Start, settings: &Settings, off: &dyn Fn() -> bool) -> Outcome {
    let mut gathering = Gathering::new(crane, off);
    let run = Simulation::with_events(crane, &results::QUANTITIES, start.state.clone(), settings).watch(&mut gathering);
    gathering.finish(run)
}

/// The record of a run of a fleet in progress.
struct OfFleet<'a> {
    recording: FleetRecording<'a>,
    /// Poses, rates and states of forces of all.
    end: InitialState,
    off: Off<'a>,
}

impl Watch for OfFleet<'_> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.recording.push(sample);
        take_state(&mut self.end, sample);
        ControlFlow::Continue(())
    }

    fn step(&mut self, _: f64) -> ControlFlow<()> {
        self.off.ask()
    }
}

impl OfFleet<'_> {
    /// The outcome of each crane.
    fn finish(self, cranes: &[(&dyn DynCrane, InitialState)], runs: &[Run]) -> Vec<Outcome> {
        let Self { recording, end: InitialState { q, v, x }, off: Off { cancelled, .. } } = self;
        let all = recording.cranes();
        recording.each(cranes.len(), |lane, table| {
            if cancelled {
                return Outcome::without_run(Reason::Cancelled);
            }
            let own = |numbers: &[f64]| interleaved::of_crane(numbers, lane, all).copied().collect();
            outcome_of(
                cranes[lane].0,
                table,
                InitialState { q: own(&q), v: own(&v), x: own(&x) },
                Ok(runs[lane].clone()),
            )
        })
    }
}

/// Whether some cranes take less time as a fleet than one by one.
fn is_worth_a_fleet(members: usize, cranes: usize) -> bool {
    2 * members > cranes
}

/// Runs the cranes of some rows as a fleet, if they fill more than half of it and all of them reach the end; otherwise one by one.
fn as_fleet(
    crane: &dyn DynCrane,
    (rows, cranes): (&[Case], usize),
    settings: &Settings,
    off: &dyn Fn() -> bool,
) -> Vec<Outcome> {
    let ready: Vec<_> = rows.iter().map(|row| if off() { Err(Reason::Cancelled) } else { ready(crane, row) }).collect();
    let members: Vec<_> = ready.iter().flatten().map(|(crane, start)| (crane.as_ref(), start.state.clone())).collect();
    let models: Vec<&dyn DynCrane> = members.iter().map(|(crane, _)| *crane as &dyn DynCrane).collect();
    let fleet = if is_worth_a_fleet(members.len(), cranes) { crane.fleet(&models) } else { None };
    let together = fleet.and_then(|fleet| {
        let recording = FleetRecording::new(fleet.as_ref(), crane);
        let mut records = OfFleet { recording, end: InitialState::default(), off: Off::new(off) };
        let runs = dynamics::ensemble::simulate_fleet(fleet.as_ref(), &members, settings, &mut records).ok()?;
        Some(records.finish(&members, &runs))
    });
    let mut together = together.map(Vec::into_iter);
    let outcome = |ready: &Result<(Box<dyn DynCrane>, Start), Reason>| match ready {
        Err(reason) => Outcome::without_run(reason.clone()),
        Ok((crane, start)) => {
            let of_fleet = together.as_mut().and_then(Iterator::next);
            of_fleet.unwrap_or_else(|| alone_from(crane.as_ref(), start, settings, off))
        }
    };
    ready.iter().map(outcome).collect()
}

/// Runs the cranes of some rows together, except those that cannot start.
fn side_by_side(crane: &dyn DynCrane, rows: &[Case], settings: &Settings) -> Vec<Outcome> {
    let ready: Vec<_> = rows.iter().map(|row| ready(crane, row)).collect();
    let mut members = Vec::new();
    let mut gatherings = Vec::new();
    for ((row_crane, start), row) in ready.iter().zip(rows).filter_map(|(ready, row)| Some((ready.as_ref().ok()?, row)))
    {
        members.push(Member { parameters: row.parameters.clone(), start: start.state.clone() });
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
