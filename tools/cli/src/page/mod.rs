//! `crane report`: statics, motion and modes of a crane as one HTML page, which needs no network.
//!
//! The page itself is built from `tools/report` and committed; here its data are put in.

mod chart;
mod crane;
mod scene;
mod strength;
pub mod twin;

use std::{io::Write, path::Path};

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{Method, Settings},
    runs::{POSES, Recorded, Start, manoeuvre},
};
use serde_json::{Value, json};

use crate::{
    Registry,
    arguments::{Limits, Page},
    extremes::extremes,
    files, modes, own,
    problem::Outcome,
    refinement,
    report::Report,
    run::runs,
    simulate::summary,
    stability,
    statics::{Case, FLEXIBLE, RIGID, caution_of_runs, deflection, tables},
};

/// The page without data: script, style and licences in one file.
const PAGE: &str = include_str!("report.html");
/// Coordinates of the largest crane whose modes are computed at all [`POSES`] along the manoeuvre.
const AFFORDABLE: usize = 100;
/// Where the data go.
const PLACE: &str = "{\"data\":\"here\"}";

/// Computes a crane, and its rigid twin where there is one, and writes the page.
pub fn report(options: &Page, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let rig = options.crane.open(registry)?;
    let twin = twin::rigid(rig.as_ref(), registry);
    let cases = cases(rig.as_ref(), twin.as_deref());
    let (settings, runs) = runs(&cases, &options.timing, options.crane.limits, Method::RECOMMENDED)?;
    let chart = options.envelope.as_deref().map(chart::figures).transpose()?;
    write_with(&options.file, registry, (&cases, options.crane.limits), &settings, &runs, chart)?;
    writeln!(out, "{} written: open it in a browser", options.file.display())?;
    Ok(())
}

/// A crane and its rigid twin in equilibrium, the twin first.
pub fn cases<'a>(rig: &'a dyn DynCrane, twin: Option<&'a dyn DynCrane>) -> Vec<Case<'a>> {
    match twin {
        Some(twin) => vec![Case::new(RIGID, twin), Case::new(FLEXIBLE, rig)],
        None => vec![Case::new(&rig.description().name, rig)],
    }
}

/// Writes the page of cranes side by side; the last is the one it is about.
pub fn write(
    file: &Path,
    registry: &Registry,
    cases: (&[Case<'_>], Limits),
    settings: &[Settings],
    runs: &[Recorded],
) -> Outcome<()> {
    write_with(file, registry, cases, settings, runs, None)
}

/// As [`write`], with load charts.
fn write_with(
    file: &Path,
    registry: &Registry,
    cases: (&[Case<'_>], Limits),
    settings: &[Settings],
    runs: &[Recorded],
    chart: Option<Value>,
) -> Outcome<()> {
    let mut data = data(registry, cases, settings, runs)?;
    data["chart"] = chart.unwrap_or(Value::Null);
    let data = data.to_string();
    // No text of a spec ends the script element that holds the data.
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        files::folder(folder)?;
    }
    files::write_text(file, &PAGE.replacen(PLACE, &data.replace('<', "\\u003c"), 1))
}

fn data(
    registry: &Registry,
    (cases, limits): (&[Case<'_>], Limits),
    settings: &[Settings],
    runs: &[Recorded],
) -> Outcome<Value> {
    let mut cranes = Vec::new();
    for ((case, settings), run) in cases.iter().zip(settings).zip(runs) {
        let mut crane = crane::data(case, &registry.live(case.rig)?, run)?;
        crane["record"] = files::record(case.rig, settings, run);
        cranes.push(crane);
    }
    Ok(json!({
        "cranes": cranes,
        "tables": all_tables(registry, cases, limits, runs)?.page(),
        "command": own::typed(),
        "spec": cases.last().and_then(|case| registry.spec(&case.rig.description().name)),
    }))
}

fn all_tables(registry: &Registry, cases: &[Case<'_>], limits: Limits, runs: &[Recorded]) -> Outcome<Report> {
    let mut report = tables(cases, limits);
    caution_of_runs(&mut report, cases.iter().map(|case| case.label).zip(runs));
    if let [rigid, flexible] = cases {
        report.grid(deflection(rigid, flexible));
    }
    if let Some(case) = cases.last() {
        let labelled: Vec<(&str, &Recorded)> = cases.iter().map(|case| case.label).zip(runs).collect();
        report.grid(extremes(case.rig.description(), &labelled));
        report.grid(summary(&labelled));
        if case.equilibrium.is_stable() {
            let changes = refinement::changes(case, registry)?;
            report.caution(changes.as_deref().and_then(refinement::caution).as_deref());
            report.grid(modes::undamped_modes(case, changes.as_deref())?);
            let poses = manoeuvre(case.rig, &Start::of(case.rig)?, affordable_poses(case.rig.size()))?;
            report.grid(modes::damped_modes(case.rig.description(), poses.first().map_or(&[], |pose| &pose.modes)));
            report.grid(stability::limits(case.rig.description(), &poses));
        }
    }
    Ok(report)
}

/// Number of poses along the manoeuvre whose modes take no longer than all of them for a crane of [`AFFORDABLE`] coordinates: the
/// time of the eigenvalue iteration grows with n³.
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
