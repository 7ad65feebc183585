//! A recorded run.

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use super::{Bound, Failed, Reason, Start, step_limit};
use crate::{
    Description, EventInfo, Moment,
    dyn_crane::DynCrane,
    dynamics::{self, Run, Sample, Stopped, Watch},
    results::{self, Column, Extremes, Recording, Table, Verification, cautions, verification},
    stability::cause,
};

/// A finished run.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Description of its start.
    pub start: String,
    /// Steps and time.
    pub run: Run,
    /// All results.
    pub table: Table,
    /// Wall time; `None` where there is no clock, and where results are to be the same in each run.
    pub wall: Option<Duration>,
    /// Its estimated errors, if requested.
    pub verification: Option<Verification>,
    /// Cautions: conditions for which the model or the method is not valid.
    pub cautions: Vec<String>,
}

impl Recorded {
    /// Simulated time per wall time.
    pub fn real_time_factor(&self) -> Option<f64> {
        self.wall.map(|wall| self.run.time / wall.as_secs_f64())
    }
}

/// Error of the energy balance, relative to the energy exchanged, above which there is a caution: a hundred times that of usual
/// steps and tolerances.
const IMBALANCE: f64 = 0.01;
/// Lower limit of the energy exchanged, relative to the total energy: for a crane at rest it is only rounding.
const LEAST_EXCHANGED: f64 = 1e-9;

/// Largest error of the energy balance over the largest energy exchanged, or over `least`, J, if that is more.
pub fn imbalance(table: &Table, least: f64) -> f64 {
    let largest = |column: &Column, size: &dyn Fn(f64) -> f64| {
        table.values(&column.name).into_iter().flatten().map(size).fold(0.0, f64::max)
    };
    let (mut kinetic, mut error, mut exchanged) = (0.0, 0.0, 0.0_f64);
    for column in table.columns.iter().filter(|column| column.unit == "J") {
        match column.name.as_str() {
            // Only the kinetic energy has an absolute zero: a body that bounces may exchange all of it between two results.
            "kinetic_energy" => kinetic = largest(column, &|x| x),
            "energy_balance" => error = largest(column, &f64::abs),
            name => {
                let first = table.values(name).and_then(|mut values| values.next()).unwrap_or(0.0);
                exchanged = exchanged.max(largest(column, &|x| (x - first).abs().max(LEAST_EXCHANGED * x.abs())));
            }
        }
    }
    error / exchanged.max(kinetic).max(least).max(f64::MIN_POSITIVE)
}

/// Energy that gravity exchanges while coordinates move by the tolerance of a method with one, J: with less, a crane is at rest.
fn exchanged_within_tolerance(crane: &dyn DynCrane, start: &Start, settings: &dynamics::Settings) -> f64 {
    if !settings.method.is_adaptive() {
        return 0.0;
    }
    let state = start.state.clone();
    let forces = crane.bias_at(&state.q, &vec![0.0; state.q.len()]);
    settings.tolerance * forces.iter().map(|force| force.abs()).sum::<f64>()
}

/// Records every sample, and asks after every step whether to continue.
struct Recorder<'a, 'c> {
    recording: &'a mut Recording<'c>,
    proceed: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
}

impl Watch for Recorder<'_, '_> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.recording.push(sample);
        ControlFlow::Continue(())
    }

    fn step(&mut self, t: f64) -> ControlFlow<()> {
        (self.proceed)(t)
    }
}

/// The time now; none in WebAssembly, where the standard library has no clock and would panic.
pub(super) fn clock() -> Option<Instant> {
    (!cfg!(all(target_family = "wasm", target_os = "unknown"))).then(Instant::now)
}

/// Runs from `start` and records every result. `proceed` receives the time after every step, s, and may stop the run, which then keeps
/// its results so far.
///
/// # Errors
/// [`Reason::Stopped`].
pub fn record(
    crane: &dyn DynCrane,
    start: &Start,
    settings: &dynamics::Settings,
    proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Recorded, Failed> {
    record_by(crane, start, settings, |recording| {
        let mut recorder = Recorder { recording, proceed };
        dynamics::Simulation::with_events(crane, &results::QUANTITIES, start.state.clone(), settings)
            .watch(&mut recorder)
    })
}

/// The same with a given way to run.
pub(super) fn record_by(
    crane: &dyn DynCrane,
    start: &Start,
    settings: &dynamics::Settings,
    run: impl FnOnce(&mut Recording<'_>) -> Result<Run, Stopped>,
) -> Result<Recorded, Failed> {
    let begin = clock();
    let mut recording = Recording::new(crane);
    let run = run(&mut recording);
    let table = recording.into_table();
    let singular = cautions::near_singular(crane.description(), &table);
    let run = run.map_err(|stopped| {
        let limit = if settings.method.is_adaptive() { None } else { step_limit(crane, start) };
        let limit = limit.map(|Bound { t, limit }| {
            let cause = cause(crane.description(), &limit.mode);
            format!("the largest stable step is {:.3e} s, limited at t = {t} s by {cause}", limit.step)
        });
        Reason::Stopped { stopped, near_singular: singular.clone(), limit }.for_crane(&crane.description().name)
    })?;
    if let Some((cylinder, time)) = results::unassembled(crane.description(), &table) {
        return Err(Reason::Unassembled { cylinder, time }.for_crane(&crane.description().name));
    }
    let off = imbalance(&table, exchanged_within_tolerance(crane, start, settings));
    let unbalanced = (settings.audit && off > IMBALANCE).then(|| {
        format!(
            "the energy balance is off by {:.0} % of the energy exchanged: the steps may miss a short motion or an angle near ±90°, \
             or springs may be too stiff for rounding; use a smaller step or tolerance, a shorter interval of results, or \
             softer springs",
            100.0 * off
        )
    });
    let cautions = unbalanced.into_iter().collect();
    Ok(Recorded {
        start: start.what.clone(),
        run,
        table,
        wall: begin.map(|begin| begin.elapsed()),
        verification: None,
        cautions,
    })
}

/// As [`record`], with all cautions, the most important first, and with a second run to estimate the error if `verify`; `bend`: degrees by
/// which one section of a beam may rotate.
///
/// # Errors
/// [`Reason::Stopped`].
pub fn record_checked(
    crane: &dyn DynCrane,
    start: &Start,
    settings: &dynamics::Settings,
    (verify, bend): (bool, f64),
    proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Recorded, Failed> {
    let recorded = record(crane, start, settings, proceed)?;
    Ok(check(recorded, crane, start, settings, (verify, bend), proceed))
}

/// Events that do not happen in a run of a duration, s, and why.
fn left_out(description: &Description, table: &Table, end: f64) -> Vec<String> {
    let times = table.times_of_events(description);
    let without = description.events.iter().zip(times).filter(|(_, time)| time.is_none());
    let sentence = |(event, _): (&EventInfo, _)| match &event.moment {
        Moment::At(time) => format!("event {} at {time} s does not happen: the run ends at {end} s", event.name),
        Moment::When(condition) => {
            let Extremes { minimum, maximum, .. } = Extremes::of_column(table, &condition.result);
            let first = table.values(&condition.result).and_then(|mut values| values.next()).unwrap_or(f64::NAN);
            let (name, unit) = (&event.name, &condition.unit);
            if condition.is_met(first) {
                let side = if condition.above { "above" } else { "below" };
                format!(
                    "event {name} does not happen: it waits until {condition}, and starts {side} it, at {first:.6} {unit}: that has to cease first"
                )
            } else {
                let reached = if condition.above { maximum } else { minimum };
                format!(
                    "event {name} does not happen: it waits until {condition}, and the run only reaches {reached:.6} {unit}"
                )
            }
        }
    };
    without.map(sentence).collect()
}

/// Adds all cautions to a run, and the estimate of its error if `verify`, as [`record_checked`].
pub fn check(
    mut recorded: Recorded,
    crane: &dyn DynCrane,
    start: &Start,
    settings: &dynamics::Settings,
    (verify, bend): (bool, f64),
    proceed: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Recorded {
    let description = crane.description();
    let [loads, servos] = cautions::of_loads(crane, &recorded.table);
    let grows = !servos.is_empty();
    let of_run = cautions::of_run(crane, &recorded.table, bend);
    let of_energy = std::mem::take(&mut recorded.cautions);
    recorded.cautions.extend(left_out(description, &recorded.table, settings.duration));
    recorded.cautions.extend([loads, servos, of_run, of_energy].concat());
    if !settings.method.is_adaptive() {
        let limit = step_limit(crane, start).map_or(f64::INFINITY, |bound| bound.limit.step);
        recorded.cautions.extend(cautions::of_step(settings.step_taken(), limit));
    }
    if verify {
        let finer = dynamics::Settings { audit: false, ..verification::finer(settings) };
        // The wall time of the finer run is not reported.
        match record(crane, start, &finer, &mut |_| proceed(settings.duration)) {
            Ok(finer) => {
                let mut verification = Verification::new(&recorded.table, &finer.table, description.coordinates.len());
                if grows {
                    // An unstable loop makes small differences grow; this is not chaos.
                    verification.divergence = None;
                }
                recorded.cautions.extend(verification.cautions(&recorded.table));
                recorded.verification = Some(verification);
            }
            Err(failed) => {
                recorded
                    .cautions
                    .push(format!("the error of the run is unknown: a finer run ended early ({})", failed.reason));
            }
        }
    }
    recorded
}
