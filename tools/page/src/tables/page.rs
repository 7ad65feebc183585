//! All tables of a page.

use crane_model::runs::{Failed, POSES, Reason, Recorded, Start, manoeuvre};

use super::{
    Case, Report, caution_of_runs, damped_modes, deflection, equilibria, extremes, stable_steps, summary,
    undamped_modes,
};

/// Coordinates of the largest crane whose modes are computed at all [`POSES`] along the manoeuvre.
const AFFORDABLE: usize = 100;

/// The tables of cranes in equilibrium, of their runs, if there are any, and of the modes of the last crane, which the page is about.
///
/// `bend`: bending or torsion of a section that is cautioned about, degrees; `changes`: of the lowest frequencies with twice the sections.
///
/// # Errors
/// The modes of the last crane cannot be computed.
pub fn of_page(cases: &[Case<'_>], runs: &[&Recorded], bend: f64, changes: Option<&[f64]>) -> Result<Report, Failed> {
    let mut report = equilibria(cases, bend);
    let labelled: Vec<(&str, &Recorded)> = cases.iter().map(|case| case.label).zip(runs.iter().copied()).collect();
    caution_of_runs(&mut report, labelled.iter().copied());
    if let [rigid, flexible] = cases {
        report.grid(deflection(rigid, flexible));
    }
    let Some(case) = cases.last() else { return Ok(report) };
    let description = case.crane.description();
    if !labelled.is_empty() {
        report.grid(extremes(description, &labelled));
        report.grid(summary(&labelled));
    }
    if case.equilibrium.is_stable() {
        let modes = undamped_modes(case, changes).map_err(|error| Reason::Modes(error).of(&description.name))?;
        report.grid(modes);
        let poses = manoeuvre(case.crane, &Start::of(case.crane)?, affordable_poses(case.crane.size()))?;
        report.grid(damped_modes(description, poses.first().map_or(&[], |pose| &pose.modes)));
        report.grid(stable_steps(description, &poses));
    }
    Ok(report)
}

/// Number of poses along the manoeuvre whose modes take no longer than those at all [`POSES`] for a crane of [`AFFORDABLE`]
/// coordinates: the time of the eigenvalue iteration grows with n³.
fn affordable_poses(coordinates: usize) -> u16 {
    let most = usize::from(POSES) * AFFORDABLE.pow(3) / coordinates.saturating_pow(3).max(1);
    u16::try_from(most).map_or(POSES, |most| most.min(POSES))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_cranes_have_fewer_poses() {
        assert_eq!([1, 100, 101, 125, 215, 216, usize::MAX].map(affordable_poses), [10, 10, 9, 5, 1, 0, 0]);
    }
}
