//! A recorded run.

use std::{
    ops::ControlFlow,
    time::{Duration, Instant},
};

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{self, Cause, Method, Run},
    modes::{self, DampedMode},
    results::{Recording, Table},
    stability::{Limit, cause, limit},
    statics::Settings,
};
use indicatif::{ProgressBar, ProgressStyle};

use crate::{
    arguments::{Limits, Step, Timing},
    cautions,
    problem::{Outcome, Problem},
    start::Start,
    verification::{self, Verification},
};

/// Most results of a run that are kept in memory and written.
const MOST_RESULTS: f64 = 1e6;

/// Most steps of a run: hours of waiting.
const MOST_STEPS: f64 = 1e10;

/// Poses along the manoeuvre at which the step is checked: 2 ms each for 25 coordinates.
pub const POSES: u16 = 10;

/// A finished run.
pub struct Recorded {
    /// What it started from.
    pub start: String,
    /// Steps and time.
    pub run: Run,
    /// All results.
    pub table: Table,
    /// Time it took.
    pub wall: Duration,
    /// How far off it may be, unless that was not asked for.
    pub verification: Option<Verification>,
    /// What the run did that the model or the method does not hold for.
    pub cautions: Vec<String>,
}

impl Recorded {
    /// Simulated time per time taken.
    pub fn real_time_factor(&self) -> f64 {
        self.run.time / self.wall.as_secs_f64()
    }
}

/// Part of the energy turned over by which a run may be off before that is said: a hundred times what usual steps and
/// tolerances leave.
const IMBALANCE: f64 = 0.01;
/// Energy turned over counts at least as this part of the energy there is: that of a crane at rest is rounding.
const LEAST_TURNED: f64 = 1e-9;

/// Greatest error of the energy balance over the greatest energy that was turned over.
pub fn imbalance(table: &Table) -> f64 {
    let column = |name: &str| table.values(name).map_or_else(Vec::new, Iterator::collect::<Vec<f64>>);
    let parts = ["kinetic", "gravity", "support", "element", "drive", "stop"].map(|part| format!("{part}_energy"));
    let turned = parts.iter().map(String::as_str).chain(["drive_work", "dissipated_energy"]).map(|name| {
        let values = column(name);
        let first = values.first().copied().unwrap_or(0.0);
        values.iter().map(|x| (x - first).abs().max(LEAST_TURNED * x.abs())).fold(0.0, f64::max)
    });
    let error = column("energy_balance").iter().map(|x| x.abs()).fold(0.0, f64::max);
    error / turned.fold(f64::MIN_POSITIVE, f64::max)
}

/// Least tolerance: rounding errors of coordinates of some metres and of their stiff springs.
const LEAST_TOLERANCE: f64 = 1e-12;

/// Greatest tolerance, m and rad: beyond it nothing is held any more.
const GREATEST_TOLERANCE: f64 = 1.0;

/// Shortest and longest run and interval of results, s: below a nanosecond steps are lost in rounding, and nobody waits for four
/// months of a crane.
const TIMES: (f64, f64) = (1e-9, 1e7);

/// Part of the largest stable step that `--step auto` takes: swinging moves the limit by some per cent.
pub const SAFE: f64 = 0.9;

impl Timing {
    /// Settings of a run from `start`: the crane's own unless given here, with a stable step unless forced.
    pub fn settings(&self, rig: &dyn DynCrane, start: &Start, default: Method) -> Outcome<dynamics::Settings> {
        let own = dynamics::Settings::of(rig.description());
        let method = self.method.unwrap_or(if self.step.is_some() { Method::Rk4 } else { default });
        let mut settings = dynamics::Settings { method, audit: true, ..own };
        let given = [("step", self.step.is_some(), false), ("tolerance", self.tolerance.is_some(), true)];
        if let Some((name, ..)) = given.into_iter().find(|&(_, given, of)| given && of != method.is_adaptive()) {
            let title = format!("`--{name}` means nothing to {method}, {}", method.title());
            let (option, other) =
                if method.is_adaptive() { ("tolerance", Method::Rk4) } else { ("step", Method::RECOMMENDED) };
            return Err(Problem::usage(title, format!("write `--{option}` or `--method {other}`")));
        }
        let limit = if method.is_adaptive() { None } else { step_limit(rig, start) };
        let step = match self.step {
            None => None,
            Some(Step::Seconds(step)) => Some(step),
            Some(Step::Auto) => limit.as_ref().map(|bound| SAFE * bound.limit.step),
        };
        for (name, given, value, what) in [
            ("step", step, &mut settings.step, "length of time"),
            ("duration", self.duration, &mut settings.duration, "length of time"),
            ("output", self.output, &mut settings.output, "length of time"),
            ("tolerance", self.tolerance, &mut settings.tolerance, "tolerance"),
        ] {
            *value = given.unwrap_or(*value);
            if !(value.is_finite() && *value > 0.0) {
                let help =
                    if what == "tolerance" { "number, such as 1e-4" } else { "number of seconds, such as 0.001" };
                return Err(Problem::usage(
                    format!("`--{name} {value}` is not a valid {what}"),
                    format!("write a positive {help}"),
                ));
            }
        }
        if self.output.is_some() && settings.output > settings.duration {
            let title = format!("results every {} s of a run of {} s", settings.output, settings.duration);
            return Err(Problem::usage(title, "write an `--output` no longer than the `--duration`"));
        }
        if settings.tolerance < LEAST_TOLERANCE {
            let title = format!("a tolerance of {:e} is below what rounding leaves", settings.tolerance);
            return Err(Problem::usage(title, format!("write {LEAST_TOLERANCE:e} or more, such as 1e-4")));
        }
        if settings.tolerance > GREATEST_TOLERANCE {
            let title =
                format!("a tolerance of {:e} holds nothing: no coordinate may be that far off", settings.tolerance);
            return Err(Problem::usage(title, format!("write {GREATEST_TOLERANCE} or less, such as 1e-4")));
        }
        for (name, value) in [("duration", settings.duration), ("output", settings.output)] {
            let (least, greatest) = TIMES;
            if !(least..=greatest).contains(&value) {
                return Err(Problem::usage(
                    format!("`--{name} {value:e}` is out of range"),
                    format!("write seconds from {least:e} to {greatest:e}"),
                ));
            }
        }
        if settings.duration / settings.output > MOST_RESULTS {
            return Err(Problem::usage(
                format!("results every {} s for {} s are more than a million", settings.output, settings.duration),
                "write a longer interval with `--output`, in s",
            ));
        }
        if !method.is_adaptive() && settings.duration / settings.step > MOST_STEPS {
            return Err(Problem::usage(
                format!("steps of {:e} s for {} s are more than ten billion", settings.step, settings.duration),
                "write a longer step with `--step`, in s",
            ));
        }
        match limit {
            // The step of a run is never longer than the interval of its results.
            Some(Bound { t, limit }) if settings.step.min(settings.output) > limit.step && !self.force => {
                Err(unstable(rig, settings.step, t, &limit))
            }
            _ => Ok(settings),
        }
    }
}

/// A step beyond the limit that holds at time `t`.
fn unstable(rig: &dyn DynCrane, step: f64, t: f64, limit: &Limit) -> Problem {
    let description = rig.description();
    Problem::failed(
        format!(
            "{}: a step of {step:e} s is unstable; {} takes at most {:.3e} s, limited at t = {t} s by {}",
            description.name,
            Method::Rk4,
            limit.step,
            cause(description, &limit.mode)
        ),
        format!(
            "`--step auto` takes {:.2e} s; `--method {}` needs no such steps; `--force` runs all the same",
            SAFE * limit.step,
            Method::RECOMMENDED
        ),
    )
}

/// Damped modes of a crane at a moment of its manoeuvre.
pub struct Pose {
    /// Time, s.
    pub t: f64,
    /// Modes about the pose at rest.
    pub modes: Vec<DampedMode>,
}

/// The least of the largest stable steps along a manoeuvre.
pub struct Bound {
    /// When it holds, s.
    pub t: f64,
    /// It, and what limits it.
    pub limit: Limit,
}

impl Bound {
    /// The least over some poses; `None` where nothing limits the step.
    pub fn of(poses: &[Pose], method: Method) -> Option<Self> {
        let bounds =
            poses.iter().filter_map(|pose| Some(Self { t: pose.t, limit: limit(&pose.modes, &method.stability())? }));
        bounds.min_by(|a, b| a.limit.step.total_cmp(&b.limit.step))
    }
}

/// The start and `count` further poses evenly in time, each where the crane would rest if its drives stopped there. As far
/// as there are such: without statics, or where the crane would fall, the poses end.
pub fn manoeuvre(rig: &dyn DynCrane, start: &Start, count: u16) -> Outcome<Vec<Pose>> {
    let description = rig.description();
    let mut q = start.q.clone();
    let mut poses = vec![Pose { t: 0.0, modes: modes::damped(&rig.small_motions_at(&q))? }];
    if start.rests {
        for index in 1..=count {
            let t = description.duration * f64::from(index) / f64::from(count);
            let equilibrium = rig.equilibrium_at(t, &q, &Settings::default());
            if !equilibrium.is_stable() {
                break;
            }
            q = equilibrium.q;
            poses.push(Pose { t, modes: modes::damped(&rig.small_motions_at(&q))? });
        }
    }
    Ok(poses)
}

/// What limits the step along the manoeuvre; `None` where nothing does or there are no modes.
fn step_limit(rig: &dyn DynCrane, start: &Start) -> Option<Bound> {
    Bound::of(&manoeuvre(rig, start, POSES).ok()?, Method::Rk4)
}

/// A progress bar in seconds of simulated time; hidden where standard error is not a terminal.
pub fn progress(seconds: f64) -> ProgressBar {
    /// Units of the bar a second.
    const MILLISECONDS: f64 = 1e3;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length for the eye")]
    let bar = ProgressBar::new((seconds * MILLISECONDS) as u64);
    styled(bar)
}

/// A progress bar in batches of cranes.
pub fn batches(count: usize) -> ProgressBar {
    styled(ProgressBar::new(count as u64))
}

/// A progress bar with times.
pub fn styled(bar: ProgressBar) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {elapsed} (left {eta})");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// Runs from `start` and records every result.
pub fn record(
    rig: &dyn DynCrane,
    start: &Start,
    settings: &dynamics::Settings,
    bar: &ProgressBar,
) -> Outcome<Recorded> {
    let name = &rig.description().name;
    let begin = Instant::now();
    let description = rig.description();
    let mut recording = Recording::new(rig);
    let mut shown = 0;
    let (mut singular, mut tilted) = (None, None);
    let run = rig
        .simulate(&start.state(), settings, &mut |sample| {
            recording.push(sample);
            singular = singular.take().or_else(|| description.near_singular(sample.q));
            tilted = tilted.take().or_else(|| description.large_tilt(sample.q));
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length for the eye")]
            let reached = (sample.t * 1e3) as u64;
            bar.inc(reached - shown);
            shown = reached;
            ControlFlow::Continue(())
        })
        .map_err(|stopped| {
            let limit = if settings.method.is_adaptive() { None } else { step_limit(rig, start) };
            let limit = limit.map_or_else(String::new, |Bound { t, limit }| {
                let cause = cause(rig.description(), &limit.mode);
                format!("; the largest stable step is {:.3e} s, limited at t = {t} s by {cause}", limit.step)
            });
            let other = if settings.method.is_explicit() {
                format!("; `--method {}` copes with stiff cranes", Method::RECOMMENDED)
            } else {
                String::new()
            };
            let light = match stopped.cause {
                Cause::Tolerance => {
                    "; a link of hardly any mass beside a heavy one swings faster than any step: give it the mass it has"
                }
                _ => "",
            };
            let near = singular.as_ref().map_or_else(String::new, |said| format!("; {said}"));
            Problem::failed(format!("{name}: {stopped}{near}"), stopped.advice() + light + &other + &limit)
        })?;
    let table = recording.into_table();
    let off = imbalance(&table);
    let unbalanced = (settings.audit && off > IMBALANCE).then(|| {
        format!(
            "energy is off by {:.0} % of what was turned over: steps miss something, such as a motion shorter than they are \
             or an angle near ±90°, or rounding moves springs that are too stiff; make step or tolerance smaller, the \
             interval of results shorter, springs softer",
            100.0 * off
        )
    });
    let cautions = singular.into_iter().chain(tilted).chain(unbalanced).collect();
    Ok(Recorded { start: start.what.clone(), run, table, wall: begin.elapsed(), verification: None, cautions })
}

/// Runs from `start`, once more to estimate the error if `verify`, and says what the run did that the model does not hold for.
pub fn record_checked(
    rig: &dyn DynCrane,
    start: &Start,
    settings: &dynamics::Settings,
    (verify, limits): (bool, Limits),
    bar: &ProgressBar,
) -> Outcome<Recorded> {
    let mut recorded = record(rig, start, settings, bar)?;
    let description = rig.description();
    recorded.cautions.extend(cautions::of_run(description, &recorded.table, limits.bend));
    if !settings.method.is_adaptive() {
        let limit = step_limit(rig, start).map_or(f64::INFINITY, |bound| bound.limit.step);
        recorded.cautions.extend(cautions::of_step(settings.step_taken(), limit));
    }
    if verify {
        let finer = dynamics::Settings { audit: false, ..verification::finer(settings) };
        match record(rig, start, &finer, &ProgressBar::hidden()) {
            Ok(finer) => {
                let found = Verification::new(&recorded.table, &finer.table, description.coordinates.len());
                recorded.cautions.extend(found.cautions(description, &recorded.table));
                recorded.verification = Some(found);
            }
            Err(problem) => recorded
                .cautions
                .push(format!("the error of the run is unknown: a finer run ended early ({})", problem.title())),
        }
    }
    Ok(recorded)
}
