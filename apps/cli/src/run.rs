//! `crane run`: everything about one crane, printed and written into a folder.

use std::io::Write;

use crane_model::dynamics::Method;
use crane_page::tables::{add_runs, caution_of_runs, deflection, equilibria, extremes};

use crate::{
    arguments::Run,
    files,
    integration::{prepare, runs},
    page::{cases, twin, write_page},
    problem::Outcome,
    selection::Registry,
    simulate::{Trace, file_list, write_figures, write_run},
};

/// Statics and motion of a crane, compared with its rigid twin if there is one; results, figures and the report.
pub fn run_crane(options: &Run, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.analysis.crane.open(registry)?;
    let (crane, twin) = (crane.as_ref(), twin::rigid(crane.as_ref(), registry));
    let cases = cases(crane, twin.as_deref());
    let mut report = equilibria(&cases, options.analysis.crane.limits.bend);
    if let [rigid, flexible] = cases.as_slice() {
        report.grid(deflection(rigid, flexible));
    }
    let prepared = prepare(&registry.console, &cases, &options.timing, Method::RECOMMENDED)?;
    let (settings, runs) = runs(&registry.console, &cases, &options.timing, options.analysis.crane.limits, prepared)?;
    let labels = cases.iter().map(|case| case.label);

    let folder = &options.folder.out;
    files::folder(folder)?;
    let mut written = Vec::new();
    for ((case, settings), run) in cases.iter().zip(&settings).zip(&runs) {
        written.extend(write_run(&registry.console, folder, case.crane, settings, run)?);
    }
    let traces = labels.clone().zip(&runs).enumerate();
    let traces: Vec<Trace<'_>> = traces
        .map(|(index, (label, run))| Trace { label, table: &run.table, dashed: index + 1 < cases.len() })
        .collect();
    caution_of_runs(&mut report, labels.clone().zip(&runs));
    let description = crane.description();
    written.extend(write_figures(&registry.console, folder, &format!("{}_", description.name), description, &traces)?);
    let page = format!("{}.html", description.name);
    write_page(&folder.join(&page), registry, (&cases, options.analysis.crane.limits), &settings, &runs)?;
    written.push(page);

    let labelled: Vec<_> = labels.zip(&runs).collect();
    report.grid_first(extremes(&labelled));
    let of_runs = cases.iter().zip(&runs).map(|(case, run)| (case.label, case.crane, run));
    add_runs(&mut report, &of_runs.collect::<Vec<_>>());
    report.grid(file_list(folder, &written));
    report.show_all(options.analysis.all);
    options.analysis.format.print(&report, &registry.console, out)
}
