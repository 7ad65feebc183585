//! `crane modes`: small vibrations about the static pose.

use std::io::Write;

use crane_model::{
    Description,
    dynamics::Method,
    modes::{DampedMode, damped, undamped},
    runs::limiting_modes,
    stability::limit,
};

use crate::{
    Registry,
    arguments::Modes,
    linearisation,
    problem::Outcome,
    refinement,
    report::{Cell, Grid, Report},
    statics::Case,
};

/// Number of lowest modes that are printed by default.
const LOWEST: usize = 10;

/// Prints undamped and damped modes and the largest stable step.
pub fn modes(options: &Modes, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let Modes { analysis: options, matrices } = options;
    let crane = options.crane.open(registry)?;
    let description = crane.description();
    let case = Case::new(&description.name, crane.as_ref());
    case.stable()?;
    let motions = crane.small_motions_at(&case.equilibrium.q);
    let modes = damped(&motions)?;
    if let Some(file) = matrices {
        linearisation::write(file, description, &case.equilibrium.q, &motions)?;
    }
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    let limiting = limiting_modes(crane.as_ref(), 0.0, &case.equilibrium.q, &modes);
    let step = limit(&limiting, &Method::Rk4.stability()).map(|limit| limit.step);
    report.value("stable", true);
    report.fact("largest stable step", Cell::from(step), "s");
    let changes = refinement::changes(&case, registry)?;
    report.caution(changes.as_deref().and_then(refinement::caution).as_deref());
    report.excerpt(undamped_modes(&case, changes.as_deref())?, LOWEST);
    report.excerpt(damped_modes(description, &modes), 0);
    report.show_all(options.all);
    report.print(options.format, out)
}

/// Undamped modes about an equilibrium as a table; `changes`: those of the lowest frequencies with twice the sections.
pub fn undamped_modes(case: &Case<'_>, changes: Option<&[f64]>) -> Outcome<Grid> {
    let mut headers = vec!["mode", "frequency [Hz]", "omega [rad/s]", "dominated by"];
    if changes.is_some() {
        headers.insert(2, "with twice the sections [%]");
    }
    let mut grid = Grid::new("undamped", "Undamped modes", &headers);
    for (index, mode) in undamped(&case.crane.small_motions_at(&case.equilibrium.q))?.iter().enumerate() {
        let omega = mode.frequency().map(|_| mode.omega_squared.sqrt());
        let names = names(case.crane.description(), &mode.dominating);
        let mut row = vec![(index + 1).into(), mode.frequency().into(), omega.into(), names];
        if let Some(changes) = changes {
            row.insert(2, changes.get(index).map_or(Cell::Empty, |change| Cell::Change(100.0 * change)));
        }
        grid.row(row);
    }
    Ok(grid)
}

/// Damped modes as a table.
pub fn damped_modes(description: &Description, modes: &[DampedMode]) -> Grid {
    let mut grid = Grid::new(
        "damped",
        "Damped modes (frequency |λ|/2π; ratio 1: returns without oscillating)",
        &["mode", "frequency [Hz]", "damping ratio", "re [1/s]", "im [1/s]", "stable step [s]", "dominated by"],
    );
    for (index, mode) in modes.iter().enumerate() {
        grid.row([
            (index + 1).into(),
            // An overdamped mode has no frequency.
            (mode.eigenvalue.im != 0.0).then(|| mode.frequency()).into(),
            mode.damping_ratio().into(),
            mode.eigenvalue.re.into(),
            mode.eigenvalue.im.into(),
            Method::Rk4.stability().largest_step(mode.eigenvalue).into(),
            names(description, &mode.dominating),
        ]);
    }
    grid
}

/// Names of coordinates in a table.
pub fn names(description: &Description, coordinates: &[usize]) -> Cell {
    Cell::Names(coordinates.iter().map(|&index| description.coordinates[index].name.to_string()).collect())
}
