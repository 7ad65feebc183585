//! Runs as the command takes them: settings from arguments, progress on screen.

use std::{ops::ControlFlow, thread};

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{self, Method},
    runs::{self, Bound, Recorded, SAFE, Start, step_limit},
    stability::{Limit, cause},
};
use crane_page::tables::Case;
use indicatif::{ProgressBar, ProgressStyle};

use crate::{
    arguments::{Limits, Step, Timing},
    problem::{Outcome, Problem},
    screen::Console,
};

impl Timing {
    /// Settings of a run from `start`: the crane's own unless given here, with a stable step unless forced.
    ///
    /// # Errors
    /// An option has a value that cannot be used.
    pub fn settings(&self, crane: &dyn DynCrane, start: &Start, default: Method) -> Outcome<dynamics::Settings> {
        let defaults = dynamics::Settings::from_description(crane.description());
        let method = self.method.unwrap_or(if self.step.is_some() { Method::Rk4 } else { default });
        let mut settings = dynamics::Settings { method, audit: true, ..defaults };
        let given = [("step", self.step.is_some(), false), ("tolerance", self.tolerance.is_some(), true)];
        if let Some((name, ..)) = given.into_iter().find(|&(_, given, of)| given && of != method.is_adaptive()) {
            let title = format!("`--{name}` has no effect with {method}, {}", method.title());
            let (option, other) =
                if method.is_adaptive() { ("tolerance", Method::Rk4) } else { ("step", Method::RECOMMENDED) };
            return Err(Problem::usage(title, format!("write `--{option}` or `--method {other}`")));
        }
        let limit = if method.is_adaptive() { None } else { step_limit(crane, start) };
        let step = match self.step {
            None => None,
            Some(Step::Seconds(step)) => Some(step),
            Some(Step::Auto) => limit.as_ref().map(|bound| SAFE * bound.limit.step),
        };
        for (name, given, value, what) in [
            ("step", step, &mut settings.step, "length of time"),
            ("duration", self.duration, &mut settings.duration, "length of time"),
            ("interval", self.interval, &mut settings.output, "length of time"),
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
        if self.interval.is_some() && settings.output > settings.duration {
            let title = format!("results every {} s in a run of {} s", settings.output, settings.duration);
            return Err(Problem::usage(title, "write an `--interval` that is not longer than `--duration`"));
        }
        let (least, greatest) = dynamics::Settings::TOLERANCES;
        if settings.tolerance < least {
            let title = format!("a tolerance of {:e} is below the rounding errors", settings.tolerance);
            return Err(Problem::usage(title, format!("write {least:e} or more, such as 1e-4")));
        }
        if settings.tolerance > greatest {
            let title = format!("a tolerance of {:e} is too large to be meaningful", settings.tolerance);
            return Err(Problem::usage(title, format!("write {greatest} or less, such as 1e-4")));
        }
        for (name, value) in [("duration", settings.duration), ("interval", settings.output)] {
            let (least, greatest) = dynamics::Settings::TIMES;
            if !(least..=greatest).contains(&value) {
                return Err(Problem::usage(
                    format!("`--{name} {value:e}` is out of range"),
                    format!("write a number of seconds from {least:e} to {greatest:e}"),
                ));
            }
        }
        if settings.duration / settings.output > dynamics::Settings::MOST_RESULTS {
            return Err(Problem::usage(
                format!(
                    "one result every {} s for {} s makes more than a million results",
                    settings.output, settings.duration
                ),
                "write a longer `--interval`, in s",
            ));
        }
        if !method.is_adaptive() && settings.duration / settings.step > dynamics::Settings::MOST_STEPS {
            return Err(Problem::usage(
                format!(
                    "a run of {} s with steps of {:e} s has more than ten billion steps",
                    settings.duration, settings.step
                ),
                "write a longer `--step`, in s",
            ));
        }
        let effort = if self.force { None } else { runs::large_effort(crane, start, &settings) };
        match limit {
            // The step of a run is never longer than the interval of its results.
            Some(Bound { t, limit }) if settings.step.min(settings.output) > limit.step && !self.force => {
                Err(unstable(crane, settings.step, t, &limit))
            }
            _ => match effort {
                Some(effort) => Err(Problem::failed(
                    format!("{}: a run of {} s takes {effort}", crane.description().name, settings.duration),
                    format!(
                        "`--method {}` takes longer steps; a very stiff spring or a point far away makes steps short; `--force` runs anyway",
                        Method::RECOMMENDED
                    ),
                )),
                None => Ok(settings),
            },
        }
    }
}

/// A step beyond the limit that holds at time `t`.
fn unstable(crane: &dyn DynCrane, step: f64, t: f64, limit: &Limit) -> Problem {
    let description = crane.description();
    Problem::failed(
        format!(
            "{}: a step of {step:e} s is unstable; {} is stable up to {:.3e} s, limited at t = {t} s by {}",
            description.name,
            Method::Rk4,
            limit.step,
            cause(description, &limit.mode)
        ),
        format!(
            "`--step auto` uses {:.2e} s; `--method {}` can use longer steps; `--force` runs anyway",
            SAFE * limit.step,
            Method::RECOMMENDED
        ),
    )
}

impl Console {
    /// A progress bar in seconds of simulated time; hidden where standard error is not a terminal.
    pub fn progress(&self, seconds: f64) -> ProgressBar {
        /// Units of the bar per second.
        const MILLISECONDS: f64 = 1e3;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length for the eye")]
        let bar = ProgressBar::new((seconds * MILLISECONDS) as u64);
        self.styled(bar)
    }

    /// A progress bar in batches of cranes.
    pub fn batches(&self, count: usize) -> ProgressBar {
        self.styled(ProgressBar::new(count as u64))
    }

    /// A progress bar with times.
    fn styled(&self, bar: ProgressBar) -> ProgressBar {
        if self.is_quiet() {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3} %  {elapsed} (left {eta})");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar
    }
}

/// Advances a bar with the time of a run.
pub fn show(bar: &ProgressBar) -> impl FnMut(f64) -> ControlFlow<()> {
    let mut shown = 0;
    move |t| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a length for the eye")]
        let reached = ((t * 1e3) as u64).max(shown);
        bar.inc(reached - shown);
        shown = reached;
        ControlFlow::Continue(())
    }
}

/// Runs from `start`, once more to estimate the error if `verify`: [`runs::record_checked`].
pub fn record_checked(
    crane: &dyn DynCrane,
    start: &Start,
    settings: &dynamics::Settings,
    (verify, limits): (bool, Limits),
    (console, bar): (&Console, &ProgressBar),
) -> Outcome<Recorded> {
    let mut recorded = runs::record_checked(crane, start, settings, (verify, limits.bend), &mut show(bar))?;
    recorded.wall = recorded.wall.filter(|_| !console.is_reproducible());
    Ok(recorded)
}

/// The start and the settings of the run of each crane; `default`: the method unless one is asked for.
///
/// # Errors
/// An option has a value that cannot be used.
pub fn prepare(
    console: &Console,
    cases: &[Case<'_>],
    timing: &Timing,
    default: Method,
) -> Outcome<(Vec<Start>, Vec<dynamics::Settings>)> {
    // The last crane is the one that the arguments refer to.
    let starts = cases.iter().enumerate();
    let starts = starts
        .map(|(index, case)| timing.start(console, case.crane, index + 1 < cases.len()))
        .collect::<Outcome<Vec<_>>>()?;
    let settings = cases
        .iter()
        .zip(&starts)
        .map(|(case, start)| timing.settings(case.crane, start, default))
        .collect::<Outcome<Vec<_>>>()?;
    Ok((starts, settings))
}

/// Runs cranes side by side, each as it was prepared.
pub fn runs(
    console: &Console,
    cases: &[Case<'_>],
    timing: &Timing,
    limits: Limits,
    (starts, settings): (Vec<Start>, Vec<dynamics::Settings>),
) -> Outcome<(Vec<dynamics::Settings>, Vec<Recorded>)> {
    let bar = console.progress(settings.iter().map(|settings| settings.duration).sum());
    bar.set_message("simulating");
    let results: Vec<Outcome<Recorded>> = thread::scope(|scope| {
        let runs: Vec<_> = cases
            .iter()
            .zip(&starts)
            .zip(&settings)
            .map(|((case, start), settings)| {
                scope
                    .spawn(|| record_checked(case.crane, start, settings, (!timing.no_verify, limits), (console, &bar)))
            })
            .collect();
        let broken = |_| Err(Problem::failed("a simulation crashed", "please report this as a bug"));
        runs.into_iter().map(|run| run.join().unwrap_or_else(broken)).collect()
    });
    bar.finish_and_clear();
    Ok((settings, results.into_iter().collect::<Outcome<_>>()?))
}
