//! Every method for its steps or tolerances: the cost and the error of a run.

use indicatif::ProgressBar;

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{Method, Run, Settings, Statistics},
};

use crane_cli::toolbox::{Cell, Grid};

use super::trace::{Errors, Timed, Trace, timed};

/// A series ends when a run takes longer than this, s: the rest would cost more than it is worth.
const LONG: f64 = 2.0;
/// A series ends when the error of the load path is below this: rounding and the error of the reference come next.
const EXACT: f64 = 1e-10;
/// Maximum number of runs of one setting.
pub const REPEATS: usize = 5;

/// A run of a method with one setting.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// Name of the method.
    pub method: &'static str,
    /// Its step, s, or its tolerance, m and rad.
    pub setting: Setting,
    /// Wall time, the median over repeated runs, s.
    pub wall: f64,
    /// Steps, evaluations, factorisations.
    pub statistics: Statistics,
    /// Distance to the reference.
    pub errors: Errors,
}

/// The setting of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// A constant step, s.
    Step(f64),
    /// A tolerance, m and rad.
    Tolerance(f64),
}

impl Setting {
    /// The step.
    pub fn step(self) -> Option<f64> {
        if let Setting::Step(step) = self { Some(step) } else { None }
    }

    /// The tolerance.
    pub fn tolerance(self) -> Option<f64> {
        if let Setting::Tolerance(tolerance) = self { Some(tolerance) } else { None }
    }

    /// As an option of `crane simulate`.
    pub fn option(self) -> String {
        match self {
            Setting::Step(step) => format!("--step {step:.3e}"),
            Setting::Tolerance(tolerance) => format!("--tolerance {tolerance:.1e}"),
        }
    }
}

/// Settings of a method from coarse to fine: the largest safe step halved repeatedly, or tolerances.
pub fn settings(method: Method, safe: f64, quick: bool) -> Vec<Setting> {
    /// Maximum number of halvings of the step; a series ends earlier when it is exact or takes long.
    const HALVINGS: i32 = 16;
    if !method.is_adaptive() {
        return (0..HALVINGS).map(|k| Setting::Step(safe * 0.5_f64.powi(k))).collect();
    }
    let tolerances: &[f64] = if quick { &[1e-3, 1e-5] } else { &TOLERANCES };
    tolerances.iter().copied().map(Setting::Tolerance).collect()
}

/// Three per decade in the range that matters to engineers, fewer below.
const TOLERANCES: [f64; 18] =
    [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11];

/// Settings of a run.
pub fn with(base: &Settings, method: Method, setting: Setting) -> Settings {
    let step = setting.step().unwrap_or(base.step);
    let tolerance = setting.tolerance().unwrap_or(base.tolerance);
    Settings { method, step, tolerance, ..*base }
}

/// Runs of every method with every setting, except those that fail.
pub fn series(
    crane: &dyn DynCrane,
    start: &[f64],
    base: &Settings,
    reference: &Trace,
    safe: f64,
    quick: bool,
    bar: &ProgressBar,
) -> Vec<Measurement> {
    let repeats = if quick { 1 } else { REPEATS };
    let mut points = Vec::new();
    for method in Method::ALL {
        bar.set_message(method.name());
        for setting in settings(method, safe, quick) {
            // The run failed, because its step is too long or its motion grows: the next setting is finer.
            let Ok(Timed { trace, run: Run { statistics, .. }, wall }) =
                timed(crane, start, &with(base, method, setting), repeats)
            else {
                continue;
            };
            let errors = reference.errors(&trace);
            points.push(Measurement { method: method.name(), setting, wall, statistics, errors });
            bar.tick();
            if wall > LONG || errors.path < EXACT || quick && !method.is_adaptive() {
                break;
            }
        }
    }
    points
}

/// All runs as a table.
pub fn table(points: &[Measurement]) -> Grid {
    let headers = [
        "method",
        "step s",
        "tolerance",
        "load path",
        "torques",
        "energy",
        "wall ms",
        "evaluations",
        "factorisations",
        "steps",
        "rejected",
    ];
    let title = "Errors relative to the size of the motion, and what the runs took";
    let mut grid = Grid::new("methods", title, &headers);
    for Measurement { method, setting, wall, statistics, errors } in points {
        grid.row([
            (*method).into(),
            setting.step().into(),
            setting.tolerance().map_or(Cell::Empty, Cell::Error),
            Cell::Error(errors.path),
            errors.efforts.map_or(Cell::Empty, Cell::Error),
            Cell::Error(errors.energy),
            (1e3 * wall).into(),
            statistics.evaluations.into(),
            statistics.factorisations.into(),
            statistics.steps.into(),
            statistics.rejections.into(),
        ]);
    }
    grid
}

/// Errors that users ask for: of the load path, relative to its size.
pub const TARGETS: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// The shortest time in which each method meets each error that users ask for.
pub fn least(points: &[Measurement], duration: f64) -> Grid {
    let headers = ["load path", "method", "step s", "tolerance", "wall ms", "times real time", "times rk4"];
    let mut grid = Grid::new("least", "Shortest time for an error of the load path, relative to its size", &headers);
    for target in TARGETS {
        let best = |method: &str| {
            let meets = points.iter().filter(|point| point.method == method && point.errors.path <= target);
            meets.min_by(|a, b| a.wall.total_cmp(&b.wall))
        };
        let classical = best(Method::Rk4.name()).map(|point| point.wall);
        let mut names: Vec<&str> = points.iter().map(|point| point.method).collect();
        names.dedup();
        for point in names.into_iter().filter_map(best) {
            grid.row([
                Cell::Error(target),
                point.method.into(),
                point.setting.step().into(),
                point.setting.tolerance().map_or(Cell::Empty, Cell::Error),
                (1e3 * point.wall).into(),
                (duration / point.wall).into(),
                classical.map(|wall| wall / point.wall).into(),
            ]);
        }
    }
    grid
}
