//! `crane statics`: the pose at rest.

use std::io::Write;

use crane_model::statics::Equilibrium;
use crane_page::tables::{Case, Grid, VALUE, equilibria};

use crate::{
    arguments::{Analysis, Format},
    problem::Outcome,
    selection::Registry,
};

/// Prints the equilibrium of a crane.
pub fn statics(options: &Analysis, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.crane.open(registry)?;
    let case = Case::new(VALUE, crane.as_ref());
    let mut report = equilibria(std::slice::from_ref(&case), options.crane.limits.bend);
    if options.format == Format::Json {
        report.grid(history(&case.equilibrium));
    }
    report.show_all(options.all);
    options.format.print(&report, out)?;
    Ok(case.stable()?)
}

fn history(equilibrium: &Equilibrium) -> Grid {
    let mut grid = Grid::new("history", "Newton iterations", &["step", "residual", "fraction"]);
    for (step, iteration) in equilibrium.history.iter().enumerate() {
        grid.row([step.into(), iteration.residual.into(), iteration.fraction.into()]);
    }
    grid
}
