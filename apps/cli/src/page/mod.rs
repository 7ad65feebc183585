//! `crane report`: statics, motion and modes of a crane as one HTML page, which needs no network.
//!
//! `crane-page` makes the page; this module adds tables, load charts and the rigid crane to compare a flexible one with.

mod chart;
pub mod twin;

use std::{io::Write, path::Path};

use chart::LoadCharts;
use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{Method, Settings},
    runs::Recorded,
};
use crane_page::{
    Subject, Texts, page,
    tables::{Case, FLEXIBLE, RIGID, Report, of_page},
};

use serde_json::Value;

use crate::{
    arguments::{Action, Limits, Page},
    book, compiled, fatigue, files,
    integration::{prepare, runs},
    problem::Outcome,
    refinement,
    selection::Registry,
    sensitivity::moves_of_page,
};

/// Computes a crane, and its rigid twin if there is one, and writes the page.
pub fn report(options: &Page, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.crane.open(registry)?;
    let twin = twin::rigid(crane.as_ref(), registry);
    let cases = cases(crane.as_ref(), twin.as_deref());
    let chart = options
        .envelope
        .as_deref()
        .map(|table| chart::read_chart(&registry.console, table, crane.as_ref()))
        .transpose()?;
    let moves = if options.sensitivity { moves(crane.as_ref(), registry)? } else { Value::Null };
    let fatigue = options.fatigue.as_ref().map(|text| fatigue_of(options, text, registry)).transpose()?;
    let instrument = options.instrument.as_deref();
    let extras = Extras { chart: chart.unwrap_or_default(), moves, instrument, fatigue };
    let prepared = prepare(&registry.console, &cases, &options.timing, Method::RECOMMENDED)?;
    let (settings, runs) = runs(&registry.console, &cases, &options.timing, options.crane.limits, prepared)?;
    write_with(&options.file, registry, (&cases, options.crane.limits), &settings, &runs, extras)?;
    writeln!(out, "{} written: open it in a browser", options.file.display())?;
    Ok(())
}

/// What a page shows only if it is asked for.
#[derive(Default)]
struct Extras<'a> {
    chart: LoadCharts,
    /// What moves what.
    moves: Value,
    /// Address of the page as an instrument.
    instrument: Option<&'a str>,
    /// Facts and tables of fatigue.
    fatigue: Option<Report>,
}

/// Fatigue of the crane of a page, with options of `crane fatigue`.
fn fatigue_of(options: &Page, text: &str, registry: &Registry) -> Outcome<Report> {
    book::check_options(text)?;
    let words = ["crane", "fatigue", &options.crane.name].map(str::to_owned).into_iter().chain(book::words_of(text)?);
    match book::parsed(&words.collect::<Vec<_>>())?.action {
        Some(Action::Fatigue(mut asked)) => {
            asked.analysis.crane = options.crane.clone();
            fatigue::report(&asked, registry)
        }
        _ => Ok(Report::default()),
    }
}

/// What moves what at rest.
fn moves(crane: &dyn DynCrane, registry: &Registry) -> Outcome<Value> {
    Ok(moves_of_page(&registry.live(crane)?, registry.checked(&crane.description().name)?))
}

/// A crane and its rigid twin in equilibrium, the twin first.
pub fn cases<'a>(crane: &'a dyn DynCrane, twin: Option<&'a dyn DynCrane>) -> Vec<Case<'a>> {
    match twin {
        Some(twin) => vec![Case::new(RIGID, twin), Case::new(FLEXIBLE, crane)],
        None => vec![Case::new(&crane.description().name, crane)],
    }
}

/// Writes the page of cranes side by side. The last crane is the subject; the others are shown for comparison.
pub fn write_page(
    file: &Path,
    registry: &Registry,
    cases: (&[Case<'_>], Limits),
    settings: &[Settings],
    runs: &[Recorded],
) -> Outcome<()> {
    write_with(file, registry, cases, settings, runs, Extras::default())
}

/// As [`write_page`], with what is asked for besides.
fn write_with(
    file: &Path,
    registry: &Registry,
    cases: (&[Case<'_>], Limits),
    settings: &[Settings],
    runs: &[Recorded],
    extras: Extras<'_>,
) -> Outcome<()> {
    let (cases, limits) = cases;
    let lives = cases.iter().map(|case| registry.live(case.crane)).collect::<Outcome<Vec<_>>>()?;
    let subjects: Vec<Subject<'_>> = cases
        .iter()
        .zip(&lives)
        .zip(settings.iter().zip(runs))
        .map(|((case, live), run)| Subject {
            label: case.label,
            crane: case.crane,
            live,
            equilibrium: &case.equilibrium,
            run: Some(run),
        })
        .collect();
    let Extras { chart: LoadCharts { figures, facts }, moves, instrument, fatigue } = extras;
    let mut tables = all_tables(registry, cases, limits, runs)?;
    tables.append(fatigue.unwrap_or_default());
    let texts = Texts {
        moves,
        tables: Some(tables),
        chart: figures,
        load_chart: facts,
        command: Some(compiled::typed(&registry.console)),
        spec: cases.last().and_then(|case| registry.spec(&case.crane.description().name)),
        instrument,
    };
    registry.console.write_text(file, &page(&subjects, texts, files::PROGRAM)?)
}

fn all_tables(registry: &Registry, cases: &[Case<'_>], limits: Limits, runs: &[Recorded]) -> Outcome<Report> {
    let changes = match cases.last().filter(|case| case.equilibrium.is_stable()) {
        Some(case) => refinement::changes(case, registry)?,
        None => None,
    };
    let mut report = of_page(cases, &runs.iter().collect::<Vec<_>>(), limits.bend, changes.as_deref())?;
    report.caution(changes.as_deref().and_then(refinement::caution).as_deref());
    registry.console.note(&report);
    Ok(report)
}
