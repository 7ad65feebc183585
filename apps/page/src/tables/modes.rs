//! Small vibrations, and the largest stable steps.

use crane_model::{
    Description,
    dynamics::Method,
    modes::{DampedMode, NoModes, undamped},
    runs::{Bound, Pose, SAFE},
    stability::cause,
};

use super::{Case, Cell, Grid};

/// Undamped modes about an equilibrium as a table; `changes`: those of the lowest frequencies with twice the sections.
///
/// # Errors
/// They cannot be computed.
pub fn undamped_modes(case: &Case<'_>, changes: Option<&[f64]>) -> Result<Grid, NoModes> {
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
            row.insert(2, changes.get(index).map_or(Cell::Empty, |change| Cell::Change(*change)));
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
        let mut row = damped_mode(index, mode);
        row.extend([
            Method::Rk4.stability().largest_step(mode.eigenvalue).into(),
            names(description, &mode.dominating),
        ]);
        grid.row(row);
    }
    grid
}

/// Number, frequency, damping ratio and eigenvalue of a damped mode.
pub fn damped_mode(index: usize, mode: &DampedMode) -> Vec<Cell> {
    vec![
        (index + 1).into(),
        // An overdamped mode has no frequency.
        (mode.eigenvalue.im != 0.0).then(|| mode.frequency()).into(),
        mode.damping_ratio().into(),
        mode.eigenvalue.re.into(),
        mode.eigenvalue.im.into(),
    ]
}

/// The largest stable step of every method over some poses, and what limits it.
pub fn stable_steps(description: &Description, poses: &[Pose]) -> Grid {
    let headers = ["method", "order", "step [s]", "safe step [s]", "at t [s]", "limited by"];
    let title = match poses.len() {
        0 | 1 => "Largest stable steps at the static pose".to_owned(),
        count => format!("Largest stable steps, the smallest of {count} poses during the manoeuvre"),
    };
    let mut grid = Grid::new("limits", title, &headers);
    for method in Method::ALL {
        let bound = Bound::smallest(poses, method);
        let step = bound.as_ref().map(|bound| bound.limit.step);
        let why = bound.as_ref().map_or_else(|| "nothing".to_owned(), |bound| cause(description, &bound.limit.mode));
        grid.row([
            method.name().into(),
            method.order().into(),
            step.into(),
            step.map(|step| SAFE * step).into(),
            bound.map(|bound| bound.t).into(),
            why.into(),
        ]);
    }
    grid
}

/// Names of coordinates in a table.
pub fn names(description: &Description, coordinates: &[usize]) -> Cell {
    Cell::Names(coordinates.iter().map(|&index| description.coordinates[index].name.to_string()).collect())
}
