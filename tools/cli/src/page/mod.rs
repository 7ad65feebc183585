//! `crane report`: statics, motion and modes of a crane as one HTML page, which needs no network.
//!
//! `crane-page` makes the page; this module adds tables, load charts and the rigid crane to compare a flexible one with.

mod chart;
pub mod twin;

use std::{io::Write, path::Path};

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{Method, Settings},
    runs::{POSES, Recorded, Start, manoeuvre},
};
use crane_page::{Subject, Texts, page};
use serde_json::Value;

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

/// Coordinates of the largest crane whose modes are computed at all [`POSES`] along the manoeuvre.
const AFFORDABLE: usize = 100;

/// Computes a crane, and its rigid twin if there is one, and writes the page.
pub fn report(options: &Page, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.crane.open(registry)?;
    let twin = twin::rigid(crane.as_ref(), registry);
    let cases = cases(crane.as_ref(), twin.as_deref());
    let (settings, runs) = runs(&cases, &options.timing, options.crane.limits, Method::RECOMMENDED)?;
    let chart = options.envelope.as_deref().map(chart::figures).transpose()?;
    write_with(&options.file, registry, (&cases, options.crane.limits), &settings, &runs, chart)?;
    writeln!(out, "{} written: open it in a browser", options.file.display())?;
    Ok(())
}

/// A crane and its rigid twin in equilibrium, the twin first.
pub fn cases<'a>(crane: &'a dyn DynCrane, twin: Option<&'a dyn DynCrane>) -> Vec<Case<'a>> {
    match twin {
        Some(twin) => vec![Case::new(RIGID, twin), Case::new(FLEXIBLE, crane)],
        None => vec![Case::new(&crane.description().name, crane)],
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
    let (cases, limits) = cases;
    let lives = cases.iter().map(|case| registry.live(case.crane)).collect::<Outcome<Vec<_>>>()?;
    let subjects: Vec<Subject<'_>> = cases
        .iter()
        .zip(&lives)
        .zip(settings.iter().zip(runs))
        .map(|((case, live), run)| Subject {
            label: case.label,
            rig: case.crane,
            live,
            equilibrium: &case.equilibrium,
            run: Some(run),
        })
        .collect();
    let texts = Texts {
        tables: all_tables(registry, cases, limits, runs)?.page(),
        chart: chart.unwrap_or_default(),
        command: Some(own::typed()),
        spec: cases.last().and_then(|case| registry.spec(&case.crane.description().name)),
    };
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        files::folder(folder)?;
    }
    files::write_text(file, &page(&subjects, texts, files::PROGRAM)?)
}

fn all_tables(registry: &Registry, cases: &[Case<'_>], limits: Limits, runs: &[Recorded]) -> Outcome<Report> {
    let mut report = tables(cases, limits);
    caution_of_runs(&mut report, cases.iter().map(|case| case.label).zip(runs));
    if let [rigid, flexible] = cases {
        report.grid(deflection(rigid, flexible));
    }
    if let Some(case) = cases.last() {
        let labelled: Vec<(&str, &Recorded)> = cases.iter().map(|case| case.label).zip(runs).collect();
        report.grid(extremes(case.crane.description(), &labelled));
        report.grid(summary(&labelled));
        if case.equilibrium.is_stable() {
            let changes = refinement::changes(case, registry)?;
            report.caution(changes.as_deref().and_then(refinement::caution).as_deref());
            report.grid(modes::undamped_modes(case, changes.as_deref())?);
            let poses = manoeuvre(case.crane, &Start::of(case.crane)?, affordable_poses(case.crane.size()))?;
            report.grid(modes::damped_modes(case.crane.description(), poses.first().map_or(&[], |pose| &pose.modes)));
            report.grid(stability::limits(case.crane.description(), &poses));
        }
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
