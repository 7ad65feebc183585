//! All tables of a page.

use crane_model::runs::{Failed, POSES, Reason, Recorded, Start, manoeuvre};

use super::{
    Case, Report, VALUE, add_runs, caution_of_runs, damped_modes, deflection, equilibria, extremes, stable_steps,
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
    // The page is about a single crane as a whole, not a column of each table.
    let unnamed = match cases {
        [Case { crane, equilibrium, .. }] => {
            vec![Case { label: VALUE, crane: *crane, equilibrium: equilibrium.clone() }]
        }
        _ => Vec::new(),
    };
    let cases = if unnamed.is_empty() { cases } else { &unnamed };
    let mut report = equilibria(cases, bend);
    let labelled: Vec<(&str, &Recorded)> = cases.iter().map(|case| case.label).zip(runs.iter().copied()).collect();
    caution_of_runs(&mut report, labelled.iter().copied());
    if let [rigid, flexible] = cases {
        report.grid(deflection(rigid, flexible));
    }
    let Some(case) = cases.last() else { return Ok(report) };
    let description = case.crane.description();
    if !labelled.is_empty() {
        report.grid(extremes(&labelled));
        let of_runs = cases.iter().zip(runs).map(|(case, run)| (case.label, case.crane, *run));
        add_runs(&mut report, &of_runs.collect::<Vec<_>>());
    }
    if case.equilibrium.is_stable() {
        let modes = undamped_modes(case, changes).map_err(|error| Reason::Modes(error).for_crane(&description.name))?;
        report.grid(modes);
        let poses = manoeuvre(case.crane, &Start::new(case.crane)?, affordable_poses(case.crane.size()))?;
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
    use crane_model::dyn_crane::DynCrane;
    use serde_json::json;

    use super::*;

    /// The page is about the crane: its name in every heading would push the numbers off the screen.
    #[test]
    fn tables_of_a_single_crane_do_not_repeat_its_name() {
        let crane = crate::tests::live("eight_link_rigid");
        let crane: &dyn DynCrane = &crane;
        let page = |cases: &[Case<'_>]| {
            let report = of_page(cases, &[], 1.0, None).unwrap_or_else(|failed| panic!("{failed}")).page();
            let grids = report["grids"].as_array().cloned().unwrap_or_default();
            let headers = |key: &str| grids.iter().find(|grid| grid["key"] == key).map(|grid| grid["headers"].clone());
            ["reactions", "points", "drives"].map(|key| headers(key).unwrap_or_default())
        };
        let name = crane.description().name.as_str();
        let alone = page(&[Case::new(name, crane)]);
        assert_eq!(alone[0], json!(["support", "x", "y", "z", "unit"]));
        assert_eq!(alone[1], json!(["point", "x", "y", "z", "unit"]));
        assert_eq!(alone[2], json!(["drive", "value", "unit"]));
        let [_, points, _] = page(&[Case::new("one", crane), Case::new("other", crane)]);
        assert_eq!(points, json!(["point", "one x", "one y", "one z", "other x", "other y", "other z", "unit"]));
    }

    #[test]
    fn large_cranes_have_fewer_poses() {
        assert_eq!([1, 100, 101, 125, 215, 216, usize::MAX].map(affordable_poses), [10, 10, 9, 5, 1, 0, 0]);
    }
}
