//! Figures of errors, both axes logarithmic.

pub use crane_cli::toolbox::Panel;
use crane_model::dynamics::Method;

use super::{
    methods::Measurement,
    sections::{Limit, Variant},
};
use crane_cli::toolbox::{Curve, Mark, PALETTE};

fn panel(x: &str, y: &str, curves: Vec<Curve>) -> Panel {
    Panel { x: x.to_owned(), y: y.to_owned(), equal: false, logarithmic: true, curves }
}

fn curves(labelled: impl Iterator<Item = (String, Vec<(f64, f64)>)>) -> Vec<Curve> {
    let coloured = labelled.zip(PALETTE.into_iter().cycle());
    coloured.map(|((label, points), colour)| Curve { label, colour, mark: Mark::Both, points }).collect()
}

/// Errors of the methods over time, evaluations and steps.
pub fn methods(points: &[Measurement]) -> Vec<Panel> {
    let mut names: Vec<&str> = points.iter().map(|point| point.method).collect();
    names.dedup();
    let over = |x: &str, y: &str, of: &dyn Fn(&Measurement) -> (f64, f64)| {
        let curve =
            |name: &&str| (name.to_string(), points.iter().filter(|point| point.method == *name).map(of).collect());
        panel(x, y, curves(names.iter().map(curve)))
    };
    let (path, wall) = ("error of the load path [1]", "wall time [ms]");
    vec![
        over(wall, path, &|point| (1e3 * point.wall, point.errors.path)),
        over(wall, "error of drive torques [1]", &|point| (1e3 * point.wall, point.errors.efforts.unwrap_or(f64::NAN))),
        over(wall, "error of energy [1]", &|point| (1e3 * point.wall, point.errors.energy)),
        over("evaluations [1]", path, &|point| (point.statistics.evaluations as f64, point.errors.path)),
        over("steps [1]", path, &|point| (point.statistics.steps as f64, point.errors.path)),
    ]
}

/// Errors of the model over the number of sections.
pub fn sections(variants: &[Variant], limit: &Limit) -> Vec<Panel> {
    let labels = ["static deflection", "frequencies", "peak torques", "load path"];
    let curve = |(which, label): (usize, &str)| {
        let points = variants.iter().map(|variant| (variant.sections as f64, limit.errors(variant)[which]));
        (label.to_owned(), points.collect())
    };
    vec![panel("sections [1]", "error of the model [1]", curves(labels.into_iter().enumerate().map(curve)))]
}

/// Errors of model and method together over time, for some numbers of sections.
pub fn times(variants: &[Variant], limit: &Limit) -> Vec<Panel> {
    // At most as many curves as there are colours.
    let every = variants.len().div_ceil(PALETTE.len());
    let curve = |variant: &Variant| {
        (format!("{} sections, {}", variant.sections, Method::RECOMMENDED), limit.curve(variant, Method::RECOMMENDED))
    };
    let chosen = variants.iter().step_by(every).map(curve);
    vec![panel("wall time [ms]", "error of the load path [1]", curves(chosen))]
}
