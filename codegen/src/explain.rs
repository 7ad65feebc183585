//! A chain in words: bodies, coordinates, what is left out and why, what each function costs.

use std::fmt::Write;

use crate::chain::{Axis, BodyId, Chain, CoordinateKind, Step};
use crate::mechanics::left_out;
use crate::report::Report;

/// Everything about a chain as text for a terminal; with a report also what each function costs.
#[must_use]
pub fn explain(chain: &Chain, report: Option<&Report>) -> String {
    let mut text = format!("{}: {}\nspec hash {}\n", chain.name, chain.title, chain.spec_hash);
    for section in [bodies(chain), coordinates(chain), without(chain, report)].into_iter().chain(report.map(costs)) {
        text.push('\n');
        text.push_str(&section);
    }
    text
}

fn bodies(chain: &Chain) -> String {
    let defaults = chain.parameter_defaults();
    let heading = if chain.has_branches() { "path from the body it is on" } else { "path from the previous body" };
    let mut text = format!("{:<20} {:>12} {:>6}  {heading}\n", "body", "mass [kg]", "n_dof");
    for (p, body) in chain.bodies.iter().enumerate() {
        let mass = body.inertia.as_ref().map_or(0.0, |inertia| inertia.mass.at(&defaults));
        let carrier = body.parent.filter(|_| chain.has_branches()).map(|BodyId(parent)| &chain.bodies[parent].name);
        let steps = body.path.iter().map(|step| describe(chain, step, &defaults));
        let path: Vec<String> = carrier.map(|name| format!("{name}:")).into_iter().chain(steps).collect();
        let degrees = chain.degrees_of_freedom(BodyId(p));
        let _ = writeln!(text, "{:<20} {mass:>12.3} {degrees:>6}  {}", body.name, path.join(" "));
        for part in body.parts.iter().filter(|part| part.name != body.link) {
            let _ = writeln!(text, "  {:<18} {:>12.3}", part.name, part.mass.at(&defaults));
        }
    }
    text
}

fn describe(chain: &Chain, step: &Step, parameters: &[f64]) -> String {
    match step {
        Step::Translate(by) => {
            let [x, y, z] = [0, 1, 2].map(|i| by[i].at(parameters));
            format!("T({x:.4}, {y:.4}, {z:.4})")
        }
        Step::Rotate { axis, sin, cos } => {
            let angle = sin.at(parameters).atan2(cos.at(parameters)).to_degrees();
            format!("R{}({angle:.2}°)", letter(*axis))
        }
        Step::RotationVector(ids) => {
            let names = ids.map(|id| chain.coordinates[id.0].name.as_str());
            format!("exp({})", names.join(", "))
        }
        Step::Move(id) => {
            let coordinate = &chain.coordinates[id.0];
            let motion = if coordinate.kind == CoordinateKind::Rotation { "R" } else { "T" };
            format!("{motion}{}({})", letter(coordinate.axis), coordinate.name)
        }
    }
}

fn letter(axis: Axis) -> &'static str {
    ["x", "y", "z"][axis.index()]
}

fn coordinates(chain: &Chain) -> String {
    let mut text = format!("{:>4}  {:<24} {:<6} {:>12}\n", "q", "coordinate", "unit", "start");
    for (i, coordinate) in chain.coordinates.iter().enumerate() {
        let unit = if coordinate.kind == CoordinateKind::Rotation { "rad" } else { "m" };
        let _ = writeln!(text, "{i:>4}  {:<24} {unit:<6} {:>12.6}", coordinate.name, chain.guess[i]);
    }
    text
}

/// What is left out, and why.
fn without(chain: &Chain, report: Option<&Report>) -> String {
    let mut text = String::from("left out\n");
    let left_out = report.map_or_else(|| left_out(chain, chain.analyses), |report| report.left_out.clone());
    if left_out.is_empty() {
        text.push_str("  nothing: the crane needs everything\n");
    }
    for (what, why) in &left_out {
        let _ = writeln!(text, "  {what}: {why}");
    }
    text
}

fn costs(report: &Report) -> String {
    let mut text = format!(
        "{:<30} {:>8} {:>8} {:>8} {:>6} {:>8} {:>14}\n",
        "function", "total", "add", "mul", "div", "sin_cos", "unsimplified"
    );
    for cost in &report.costs {
        let c = &cost.operations;
        let _ = writeln!(
            text,
            "{:<30} {:>8} {:>8} {:>8} {:>6} {:>8} {:>14}",
            cost.function,
            c.total(),
            c.additions,
            c.multiplications,
            c.divisions,
            c.angles,
            cost.verbatim.total()
        );
    }
    text
}

/// Operations per function and crane as a Markdown table; a cell is empty if the crane does not need the function.
#[must_use]
pub fn operations_table(reports: &[(String, Report)]) -> String {
    let mut functions: Vec<&str> = Vec::new();
    for cost in reports.iter().flat_map(|(_, report)| &report.costs) {
        if !functions.contains(&cost.function.as_str()) {
            functions.push(&cost.function);
        }
    }
    let names: Vec<String> = reports.iter().map(|(name, _)| format!("`{name}`")).collect();
    let mut text = format!("| function | {} |\n|---|{}\n", names.join(" | "), "---:|".repeat(reports.len()));
    for function in functions {
        let cell = |report: &Report| {
            let cost = report.costs.iter().find(|cost| cost.function == function);
            cost.map(|cost| cost.operations.total().to_string()).unwrap_or_default()
        };
        let cells: Vec<String> = reports.iter().map(|(_, report)| cell(report)).collect();
        let _ = writeln!(text, "| `{function}` | {} |", cells.join(" | "));
    }
    text
}
