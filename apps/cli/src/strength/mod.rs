//! `crane strength`: what joints, sections and the ground carry, stresses of beams, and how far the crane is from tipping.

mod history;
mod loads;
mod stresses;
mod tables;

use std::io::Write;

use serde_json::Value;

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::Method,
    results::{KeyFigure, cautions},
    runs::{Recorded, Start},
    tipping::governing,
};
use crane_page::history::{Instant, instants};
use crane_page::tables::{Case, Report, VALUE, add_events, verdicts};

use crate::{
    arguments::{Limits, Strength, Timing},
    integration::record_checked,
    problem::{Outcome, Problem},
    refinement,
    screen::Console,
    selection::Registry,
};

pub use history::column;
use history::least_margin;
pub use loads::parameter as load_parameter;

/// Prints loads and stability at rest, and along the manoeuvre if asked for.
pub fn strength(options: &Strength, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    if options.results.is_some() && !options.run {
        return Err(Problem::usage("`--file` needs `--run` or `--range`", "add one of them, or leave `--file` out"));
    }
    let mut crane = options.analysis.crane.open(registry)?;
    let load = loads::parameter(crane.as_ref(), options.load.as_deref())?;
    let case = Case::new(VALUE, crane.as_ref());
    let q = case.equilibrium.q.clone();
    let mut report = Report::default();
    verdicts(&mut report, std::slice::from_ref(&case));
    if !case.equilibrium.is_stable() {
        options.analysis.format.print(&report, &registry.console, out)?;
        return Ok(case.stable()?);
    }
    let rest = Instant::at_rest(crane.as_ref(), &q);
    verdict(&mut report, crane.as_ref(), &rest, "");
    let moduli = crane.section_moduli_at();
    stresses::verdict(&mut report, crane.description(), &moduli, std::slice::from_ref(&rest), "");
    let changes =
        refinement::changes_of_stress(&case, &rest, registry).map(|changes| stresses::mesh(&mut report, changes));
    let timing = (&options.timing, options.analysis.crane.limits);
    let history = if options.run { Some(along(&registry.console, timing, crane.as_ref(), &mut report)?) } else { None };
    for caution in cautions::of_pose(crane.as_ref(), &q, options.analysis.crane.limits.bend) {
        report.caution(Some(caution));
    }
    for caution in cautions::of_strength(crane.as_ref()) {
        report.caution(Some(caution));
    }
    if let Some(index) = load {
        loads::critical(&mut report, crane.as_mut(), index)?;
    }
    let crane = crane.as_ref();
    if options.buckling {
        let live = registry.live(crane)?;
        loads::factor(&mut report, &live);
        loads::orders(&mut report, &live);
    }
    report.grid(stresses::table(crane.description(), &moduli, &rest, changes.flatten().as_deref()));
    report.grid(tables::tipping(crane.description(), &rest.lines));
    if let Some(history) = &history {
        let table = history::table(crane.description(), &moduli, history);
        report.grid(tables::extremes_of_joints(crane.description(), &table));
        report.grid(tables::extremes_of_sections(crane.description(), &rest.x, &table));
        if let Some(file) = &options.results {
            registry.console.write_csv(file, &table)?;
        }
    }
    report.grid(tables::joints(crane.description(), &rest.wrenches));
    report.excerpt(tables::sections(crane.description(), &rest), 0);
    report.show_all(options.analysis.all);
    options.analysis.format.print(&report, &registry.console, out)
}

/// Loads and stability along the manoeuvre, one entry per result.
fn along(
    console: &Console,
    timing: (&Timing, Limits),
    crane: &dyn DynCrane,
    report: &mut Report,
) -> Outcome<Vec<Instant>> {
    let history = history(console, timing, crane, report)?;
    let worst = least_margin(&history).ok_or_else(|| Problem::failed("the run has no results", ""))?;
    verdict(report, crane, worst, " of the run");
    stresses::verdict(report, crane.description(), &crane.section_moduli_at(), &history, " of the run");
    if !worst.lines.is_empty() {
        report.fact_as("time_of_the_least_tipping_margin", "time of the minimum tipping margin", worst.t, "s");
    }
    Ok(history)
}

/// Loads along the manoeuvre, one entry per result, with the cautions of the run.
fn history(
    console: &Console,
    timing: (&Timing, Limits),
    crane: &dyn DynCrane,
    report: &mut Report,
) -> Outcome<Vec<Instant>> {
    let (_, recorded) = record_manoeuvre(console, timing, crane, report)?;
    Ok(instants(crane, recorded.table.rows.iter()))
}

/// Runs the manoeuvre from its start, and reports its cautions and events.
pub fn record_manoeuvre(
    console: &Console,
    (timing, limits): (&Timing, Limits),
    crane: &dyn DynCrane,
    report: &mut Report,
) -> Outcome<(Start, Recorded)> {
    let start = timing.start(console, crane, false)?;
    let settings = timing.settings(crane, &start, Method::RECOMMENDED)?;
    let bar = console.progress(settings.duration);
    let recorded = record_checked(crane, &start, &settings, (!timing.no_verify, limits), (console, &bar))?;
    bar.finish_and_clear();
    for caution in &recorded.cautions {
        report.caution(Some(caution.as_str()));
    }
    add_events(report, &[(VALUE, crane, &recorded.table)]);
    Ok((start, recorded))
}

/// How far the crane is from tipping.
fn verdict(report: &mut Report, crane: &dyn DynCrane, instant: &Instant, of: &str) {
    let (description, figure) = (crane.description(), KeyFigure::TIPPING_MARGIN);
    let Some(line) = governing(&instant.lines) else {
        let why = if description.supports.is_empty() {
            "not computed: the crane has no supports"
        } else {
            "not computed: the supports do not form a polygon"
        };
        report.line(format!("{}{of}", figure.name), why, "");
        report.value(&format!("{}{}", figure.key, of.replace(' ', "_")), Value::Null);
        return;
    };
    let [from, to] = line.feet.map(|foot| description.supports[foot].name.as_str());
    let margin = line.margin();
    report.fact(format!("{}{of}", figure.name), margin, figure.shown);
    report.fact(format!("governing line{of}"), format!("{from} – {to}"), "");
}
