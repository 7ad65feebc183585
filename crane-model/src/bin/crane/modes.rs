//! `crane modes`: small vibrations about the static pose.

use std::io::Write;

use crane_model::{
    Description,
    dynamics::rk4,
    modes::{damped, undamped},
};

use crate::{
    arguments::Analysis,
    problem::Outcome,
    report::{Cell, Grid, Report},
    run::largest_step,
    statics::Case,
};

/// Prints undamped and damped modes and the largest stable step.
pub fn modes(options: &Analysis, out: &mut dyn Write) -> Outcome<()> {
    let rig = options.crane.open()?;
    let description = rig.description();
    let case = Case::new(description.name, rig.as_ref());
    case.stable()?;
    let q = &case.equilibrium.q;
    let motions = rig.small_motions(q);

    let mut natural = Grid::new("undamped", "Undamped modes", &["mode", "frequency Hz", "omega rad/s", "dominated by"]);
    for (index, mode) in undamped(&motions)?.iter().enumerate() {
        let omega = mode.frequency().map(|_| mode.omega_squared.sqrt());
        let names = names(description, &mode.dominating);
        natural.row([(index + 1).into(), mode.frequency().into(), omega.into(), names]);
    }
    let mut real = Grid::new(
        "damped",
        "Damped modes (ratio 1: creeps back without swinging)",
        &["mode", "frequency Hz", "damping ratio", "re 1/s", "im 1/s", "stable step s", "dominated by"],
    );
    for (index, mode) in damped(&motions)?.iter().enumerate() {
        let (re, im) = (mode.eigenvalue.re, mode.eigenvalue.im);
        real.row([
            (index + 1).into(),
            mode.frequency().into(),
            mode.damping_ratio().into(),
            re.into(),
            im.into(),
            rk4::largest_step(re, im).into(),
            names(description, &mode.dominating),
        ]);
    }
    let mut report = Report::default();
    report.fact("crane", description.name, "");
    report.fact("largest stable step", Cell::from(largest_step(rig.as_ref(), q)), "s");
    report.grid(natural);
    report.grid(real);
    report.print(options.format, out)
}

fn names(description: &Description, coordinates: &[usize]) -> Cell {
    let names: Vec<&str> = coordinates.iter().map(|&index| description.coordinates[index].name).collect();
    names.join(", ").into()
}
