//! `crane statics`: the pose at rest.

use std::io::Write;

use crane_model::{Description, Text, statics::Equilibrium};
use crane_page::tables::{Case, Grid, Report, VALUE, equilibria};
use serde_json::{Map, Value, json};

use crate::{
    arguments::{Analysis, Format},
    problem::Outcome,
    refinement,
    selection::Registry,
};

/// Prints the equilibrium of a crane.
pub fn statics(options: &Analysis, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.crane.open(registry)?;
    let case = Case::new(VALUE, crane.as_ref());
    let mut report = equilibria(std::slice::from_ref(&case), options.crane.limits.bend);
    if let Some(changes) = refinement::changes_of_points(&case, registry) {
        mesh(&mut report, crane.description(), changes);
    }
    if options.format == Format::Json {
        report.grid(history(&case.equilibrium));
    }
    report.show_all(options.all);
    options.format.print(&report, &registry.console, out)?;
    Ok(case.stable()?)
}

/// What the mesh leaves out of the positions of points: for people the largest number; or why that is not known.
fn mesh(report: &mut Report, description: &Description, changes: Result<Vec<f64>, &str>) {
    const WORDS: &str = "change of positions with twice the sections";
    let changes = match changes {
        Ok(changes) => changes,
        Err(why) => return report.line(WORDS, format!("not computed: {why}"), ""),
    };
    let names = description.points.iter().map(Text::as_str);
    let Some((name, most)) = names.clone().zip(&changes).max_by(|(_, a), (_, b)| a.total_cmp(b)) else { return };
    report.line(WORDS, format!("{:.2} (of {name})", 1e3 * most), "mm");
    let each: Map<String, Value> = names.map(str::to_owned).zip(changes.iter().map(|change| json!(change))).collect();
    report.value("changes_of_positions_with_twice_the_sections", each);
}

fn history(equilibrium: &Equilibrium) -> Grid {
    let mut grid = Grid::new("history", "Newton iterations", &["step", "residual", "fraction"]);
    for (step, iteration) in equilibrium.history.iter().enumerate() {
        grid.row([step.into(), iteration.residual.into(), iteration.fraction.into()]);
    }
    grid
}
