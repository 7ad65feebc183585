//! A recorded run.

use std::{
    io,
    io::Write,
    ops::ControlFlow,
    time::{Duration, Instant},
};

use crane_model::{
    dynamics::{self, Run, rk4},
    modes,
    results::{Recording, Table},
    rig::Rig,
};
use indicatif::{ProgressBar, ProgressStyle};

use crate::{
    arguments::Timing,
    problem::{Outcome, Problem},
    statics::Case,
};

/// Most results of a run that are kept in memory and written.
const MOST_RESULTS: f64 = 1e6;

/// Most steps of a run: hours of waiting.
const MOST_STEPS: f64 = 1e10;

/// Start of a crane whose spec asks for statics.
pub const EQUILIBRIUM: &str = "static equilibrium, at rest";

/// Start of a crane whose spec does not.
pub const GUESS: &str = "guess, at rest";

/// Pose from which a run starts, at rest.
pub struct Start {
    /// The pose, m and rad.
    pub q: Vec<f64>,
    /// Which one: [`EQUILIBRIUM`] or [`GUESS`].
    pub what: &'static str,
}

impl Start {
    /// The static equilibrium where the crane's spec asks for statics, otherwise its guess.
    pub fn of(rig: &dyn Rig) -> Outcome<Self> {
        let description = rig.description();
        if description.statics {
            Case::new(description.name, rig).start()
        } else {
            Ok(Self { q: rig.guess(), what: GUESS })
        }
    }
}

/// A finished run.
pub struct Recorded {
    /// What it started from.
    pub start: &'static str,
    /// Steps and time.
    pub run: Run,
    /// All results.
    pub table: Table,
    /// Time it took.
    pub wall: Duration,
}

impl Recorded {
    /// Simulated time per time taken.
    pub fn real_time_factor(&self) -> f64 {
        self.run.time / self.wall.as_secs_f64()
    }
}

impl Timing {
    /// Settings of a run: the crane's own unless given here.
    pub fn settings(&self, rig: &dyn Rig) -> Outcome<dynamics::Settings> {
        let mut settings = dynamics::Settings { audit: true, ..dynamics::Settings::of(rig.description()) };
        for (name, given, value) in [
            ("step", self.step, &mut settings.step),
            ("duration", self.duration, &mut settings.duration),
            ("output", self.output, &mut settings.output),
        ] {
            *value = given.unwrap_or(*value);
            if !(value.is_finite() && *value > 0.0) {
                let title = format!("`--{name} {value}` is no length of time");
                return Err(Problem::usage(title, "write a positive number of seconds, such as 0.001"));
            }
        }
        if settings.duration / settings.output > MOST_RESULTS {
            return Err(Problem::usage(
                format!("results every {} s for {} s are more than a million", settings.output, settings.duration),
                "write a longer interval with `--output`, in s",
            ));
        }
        if settings.duration / settings.step > MOST_STEPS {
            return Err(Problem::usage(
                format!("steps of {:e} s for {} s are more than ten billion", settings.step, settings.duration),
                "write a longer step with `--step`, in s",
            ));
        }
        Ok(settings)
    }
}

/// A progress bar in seconds of simulated time; hidden where standard error is no terminal.
pub fn progress(seconds: f64) -> ProgressBar {
    /// Units of the bar a second.
    const MILLISECONDS: f64 = 1e3;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length for the eye")]
    let bar = ProgressBar::new((seconds * MILLISECONDS) as u64);
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {elapsed} (left {eta})");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// Runs from `start` and records every result; says before if the step will not do.
pub fn record(rig: &dyn Rig, start: &Start, settings: &dynamics::Settings, bar: &ProgressBar) -> Outcome<Recorded> {
    let limit = largest_step(rig, &start.q);
    let name = rig.description().name;
    if let Some(limit) = limit.filter(|limit| settings.step > *limit) {
        let step = settings.step;
        // Not eprintln: it panics where standard error is closed.
        let _ = writeln!(
            io::stderr(),
            "warning: {name}: a step of {step:e} s is beyond the largest stable one about the start, {limit:.2e} s"
        );
    }
    let begin = Instant::now();
    let mut recording = Recording::new(rig);
    let mut shown = 0;
    let run = rig
        .simulate(&start.q, settings, &mut |sample| {
            recording.push(sample);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length for the eye")]
            let reached = (sample.t * 1e3) as u64;
            bar.inc(reached - shown);
            shown = reached;
            ControlFlow::Continue(())
        })
        .map_err(|stopped| {
            let limit = limit.map_or_else(String::new, |limit| {
                format!("; the largest stable step about the start is {limit:.2e} s")
            });
            Problem::failed(format!("{name}: {stopped}"), stopped.advice() + &limit)
        })?;
    Ok(Recorded { start: start.what, run, table: recording.into_table(), wall: begin.elapsed() })
}

/// Largest stable step of small motions about pose `q`, s; `None` where nothing limits it or there are no modes.
pub fn largest_step(rig: &dyn Rig, q: &[f64]) -> Option<f64> {
    let modes = modes::damped(&rig.small_motions(q)).ok()?;
    modes.iter().filter_map(|mode| rk4::largest_step(mode.eigenvalue.re, mode.eigenvalue.im)).reduce(f64::min)
}
