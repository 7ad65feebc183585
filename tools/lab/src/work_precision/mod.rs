//! `crane-lab work-precision`: error against run time, of the methods and of the model.

mod figures;
mod methods;
mod page;
mod reference;
mod sections;
mod trace;
#[cfg(feature = "yardstick")]
mod yardstick;

use std::io::Write;

use crane_codegen::{SourceFile, chain::Chain};

use crane_model::{
    Description,
    dyn_crane::DynCrane,
    dynamics::{Method, Settings},
    runs::{Bound, POSES, SAFE, Start, manoeuvre},
};

use crane_cli::{
    Console, Registry, files, refinement,
    toolbox::{Grid, Library, Outcome, Problem, Report, file_list, load, run_with, write_figure},
};

use crate::arguments::WorkPrecision;
use methods::{REPEATS, least, series, table};
use reference::reference;
use sections::{Limit, Variant, announce, variant};

/// The library that programs of compiled cranes run.
const LIBRARY: Library = Library {
    name: "crane-lab",
    folder: env!("CARGO_MANIFEST_DIR"),
    features: if cfg!(feature = "yardstick") { &["yardstick"] } else { &[] },
};

/// Finds a reference, times every method and every number of sections, and writes tables and figures.
pub fn work_precision(options: &WorkPrecision, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let choice = &options.analysis.crane;
    let (crane, text) = if let Some(file) = choice.file() {
        let (Chain { name, .. }, text) = load(&registry.console, file, options.analysis.crane.strict)?;
        (name, text)
    } else {
        let name = registry.crane(&choice.name)?.description().name.to_string();
        let text = registry.spec(&name).unwrap_or_default().to_owned();
        (name, text)
    };
    let counts = options.sections.0.as_slice();
    let known = registry.names();
    let missing = counts.iter().any(|&count| !known.contains(&refinement::name(&crane, count).as_str()));
    let flexible = if missing { others(&crane, &text, counts) } else { Vec::new() };
    // Times are those of machine code, except with `--quick`.
    if flexible.is_empty() && choice.file().is_none() && registry.is_compiled(&crane) {
        return study(options, &crane, if missing { &[] } else { counts }, registry, out);
    }
    if options.quick {
        let counts = if missing && flexible.is_empty() { &[] } else { counts };
        let mut live = registry.empty();
        for (name, text) in [vec![(crane.clone(), text)], flexible].concat() {
            live.add(&name, text);
        }
        return study(options, &crane, counts, &live, out);
    }
    let hash = SourceFile::new(&crane, &text).hash();
    let listed: Vec<String> = counts.iter().map(ToString::to_string).collect();
    let package = match flexible.len() {
        0 => format!("crane-{crane}-{hash}"),
        _ => format!("crane-{crane}-{hash}-{}", listed.join("-")),
    };
    let cranes = [vec![(crane, text)], flexible].concat();
    run_with(&registry.console, &LIBRARY, &package, choice.name.as_ref(), &cranes)
}

/// Names and specs of a crane with other numbers of sections; empty for a crane without flexible links.
fn others(crane: &str, text: &str, counts: &[usize]) -> Vec<(String, String)> {
    let other = |&count: &usize| Some((refinement::name(crane, count), refinement::spec(crane, text, count)?));
    counts.iter().filter_map(other).collect()
}

/// The results, with everything that is written to files.
struct Found<'a> {
    description: &'a Description,
    facts: Report,
    grids: Vec<Grid>,
    figures: Vec<(&'a str, Vec<figures::Panel>)>,
}

/// The study itself, with the cranes of a registry.
fn study(
    options: &WorkPrecision,
    name: &str,
    counts: &[usize],
    registry: &Registry,
    out: &mut dyn Write,
) -> Outcome<()> {
    let crane = options.analysis.crane.parameters.crane(name, options.analysis.crane.strict, registry)?;
    let crane = crane.as_ref();
    let description = crane.description();
    let start = start(crane)?;
    let base = base(options, description)?;
    let bar = registry.console.progress(0.0);
    bar.set_message("reference");
    let poses = manoeuvre(crane, &start, POSES)?;
    let safe =
        Bound::smallest(&poses, Method::Rk4).map_or(base.output, |bound| SAFE * bound.limit.step).min(base.output);
    let reference = reference(crane, &start.q, &base, safe)?;
    let repeats = if options.quick { 1 } else { REPEATS };
    let points = series(crane, &start.q, &base, &reference.solution.trace, safe, options.quick, &bar);
    #[cfg(feature = "yardstick")]
    let points = [points, yardstick::series(crane, &start.q, &base, &reference.solution.trace, repeats)].concat();

    let mut facts = Report::default();
    facts.fact("crane", description.name.as_str(), "");
    facts.fact("code", if registry.is_compiled(name) { "compiled" } else { "interpreted" }, "");
    facts.fact("start", start.what.as_str(), "");
    facts.fact("duration", base.duration, "s");
    let size = reference.solution.trace.size();
    facts.fact_as("longest_way_of_a_point", "largest distance of a point from its start", size, "m");
    let (tolerance, step) = reference.settings;
    facts.fact("reference", format!("dopri5, tolerance {tolerance:.0e}; rk4, step {step:.3e} s"), "");
    let agreement = format!("{:.1e}, {:.1e}", reference.agreement.path, reference.agreement.of_forces());
    facts.fact("they differ by", agreement, "of the load path, of torques and energy");
    let mut found = Found {
        description,
        facts,
        grids: vec![least(&points, base.duration), table(&points)],
        figures: vec![("work_precision", figures::methods(&points))],
    };
    if !counts.is_empty() {
        let variants = counts.iter().map(|&count| {
            announce(&bar, count);
            let crane = options.analysis.crane.parameters.crane(
                &refinement::name(&description.name, count),
                false,
                registry,
            )?;
            variant(crane.as_ref(), &self::start(crane.as_ref())?, &base, count, repeats)
        });
        let variants: Vec<Variant> = variants.collect::<Outcome<_>>()?;
        if let Some(limit) = Limit::new(&variants) {
            let grids = [limit.advice(&variants, base.duration), limit.table(&variants), limit.runs(&variants)];
            found.grids.extend(grids);
            found.figures.push(("sections", figures::sections(&variants, &limit)));
            found.figures.push(("sections_time", figures::times(&variants, &limit)));
        }
    }
    bar.finish_and_clear();
    deliver(options, found, &registry.console, out)
}

/// Where runs start: at rest in equilibrium, or at the guess if there is no drive to move the crane out of equilibrium.
fn start(crane: &dyn DynCrane) -> Outcome<Start> {
    if crane.description().drives.is_empty() { Ok(Start::guess(crane)) } else { Ok(Start::new(crane)?) }
}

/// The run to be studied.
fn base(options: &WorkPrecision, description: &Description) -> Outcome<Settings> {
    let defaults = Settings::from_description(description);
    let duration = options.duration.unwrap_or(defaults.duration);
    if !(duration.is_finite() && duration > 0.0) {
        return Err(Problem::usage(
            format!("`--duration {duration}` is not a duration"),
            "write a positive number of seconds, such as 2",
        ));
    }
    Ok(Settings { duration, output: defaults.output.min(duration), ..defaults })
}

/// Writes tables and figures, and prints the results.
fn deliver(options: &WorkPrecision, found: Found<'_>, console: &Console, out: &mut dyn Write) -> Outcome<()> {
    let name = &found.description.name;
    files::folder(&options.out)?;
    let mut written = Vec::new();
    for grid in &found.grids {
        let file = format!("{name}_{}.csv", grid.key());
        let (headers, rows) = grid.fields();
        console.write_fields(&options.out.join(&file), headers, rows)?;
        written.push(file);
    }
    for (what, panels) in &found.figures {
        let file = format!("{name}_{what}.svg");
        write_figure(console, &options.out.join(&file), panels, 2)?;
        written.push(file);
    }
    if let Some(file) = &options.page {
        page::write_page(console, file, &found)?;
        written.push(file.display().to_string());
    }
    let mut report = found.facts;
    found.grids.into_iter().for_each(|grid| report.grid(grid));
    report.grid(file_list(&options.out, &written));
    options.analysis.format.print(&report, console, out)
}
