//! `crane stability`: the largest stable step of every method, and what limits it.

use std::io::Write;

use crane_model::{
    Description,
    dynamics::Method,
    modes::DampedMode,
    results::cautions,
    runs::{Pose, Start, manoeuvre},
    stability::{cause, limit},
};
use crane_page::tables::{Grid, Report, damped_modes, stable_steps};

use crate::{
    arguments::Stability,
    figures::{BLUE, Curve, Mark, Panel, VERMILLION},
    files,
    problem::Outcome,
    selection::Registry,
    simulate::{file_list, write_figure},
};

/// Prints limits and modes, and draws the regions.
pub fn stability(options: &Stability, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.analysis.crane.open(registry)?;
    let crane = crane.as_ref();
    let description = crane.description();
    let start = Start::new(crane)?;
    let poses = manoeuvre(crane, &start, options.along)?;
    let modes = poses.first().map_or(&[][..], |pose| &pose.modes);

    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.fact("start", start.what.as_str(), "");
    if start.rests {
        for caution in cautions::of_servos(crane, 0.0, &start.q) {
            report.caution(Some(caution));
        }
    }
    report.grid(stable_steps(description, &poses));
    if poses.len() > 1 {
        report.grid(along(description, &poses));
    }
    report.grid(damped_modes(description, modes));

    files::folder(&options.out)?;
    let file = format!("{}_stability.svg", description.name);
    write_figure(&registry.console, &options.out.join(&file), &regions(modes, description.step), 1)?;
    report.grid(file_list(&options.out, &[file]));
    options.analysis.format.print(&report, &registry.console, out)
}

/// Limits at every pose, one method after the other.
fn along(description: &Description, poses: &[Pose]) -> Grid {
    let title = "During the manoeuvre, with the drives stopped at each time";
    let mut grid = Grid::new("along", title, &["method", "t [s]", "step [s]", "limited by"]);
    for method in Method::ALL {
        for pose in poses {
            if let Some(limit) = limit(&pose.modes, &method.stability()) {
                let why = cause(description, &limit.mode);
                grid.row([method.name().into(), pose.t.into(), limit.step.into(), why.into()]);
            }
        }
    }
    grid
}

/// The stability region of every explicit method, with hλ of every mode at its largest stable step, or the spec's if none limits it.
fn regions(modes: &[DampedMode], crane_limit: f64) -> Vec<Panel> {
    let panel = |method: Method| {
        let function = method.stability();
        let boundary = function.boundary().iter().map(|z| (z.re, z.im)).collect();
        let largest = limit(modes, &function).map_or(crane_limit, |limit| limit.step);
        let marks = |h: f64| {
            let pair = |mode: &DampedMode| {
                let z = mode.eigenvalue * h;
                [(z.re, z.im), (z.re, -z.im)]
            };
            modes.iter().flat_map(pair).collect()
        };
        let curve = |label: String, colour, points, mark| Curve { label, colour, mark, points };
        Panel {
            x: format!("Re hλ; {method}, h = {largest:.3e} s"),
            y: "Im hλ".to_owned(),
            equal: true,
            logarithmic: false,
            curves: vec![
                curve("|R(hλ)| = 1".to_owned(), BLUE, boundary, Mark::Solid),
                curve(
                    "hλ of the crane at its largest stable step h".to_owned(),
                    VERMILLION,
                    marks(largest),
                    Mark::Dots,
                ),
            ],
        }
    };
    Method::ALL.into_iter().filter(|method| method.is_explicit()).map(panel).collect()
}
