//! `crane drives`: what drives, cylinders and the pump must be able to do over the manoeuvre, and parts of lists that can.

mod parts;

use std::io::Write;

use crane_model::{DisplayUnit, results::Duties};
use crane_page::tables::{Case, Cell, Grid, Report, VALUE, add_duties, verdicts};

use crate::{arguments, problem::Outcome, selection::Registry, strength};
use parts::{Checked, List, Need};

/// Rows of the table of parts that people see unless they ask for all.
const ROWS: usize = 40;

/// Prints duties and parts.
pub fn drives(options: &arguments::Drives, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.analysis.crane.open(registry)?;
    let crane = crane.as_ref();
    let lists = options.parts.iter().map(|file| List::read(&registry.console, file)).collect::<Outcome<Vec<List>>>()?;
    let case = Case::new(VALUE, crane);
    let mut report = Report::default();
    verdicts(&mut report, std::slice::from_ref(&case));
    if !case.equilibrium.is_stable() {
        options.analysis.format.print(&report, &registry.console, out)?;
        return Ok(case.stable()?);
    }
    let timing = (&options.timing, options.analysis.crane.limits);
    let (_, recorded) = strength::record_manoeuvre(&registry.console, timing, crane, &mut report)?;
    let duties = Duties::new(crane.description(), &recorded.table);
    let needs = parts::needs(&duties, crane.description());
    if needs.is_empty() {
        report.line("drives", "none: nothing in the spec drives the crane", "");
    }
    for list in &lists {
        if !needs.iter().any(|need| need.kind == list.kind) {
            report.caution(Some(format!("{} lists {}, but nothing needs one", list.name(), list.kind.plural())));
        }
    }
    add_duties(&mut report, &[(VALUE, crane, &recorded)]);
    let grid = table(&needs, &lists, &mut report)?;
    if !lists.is_empty() {
        report.excerpt(grid, ROWS);
    }
    report.show_all(options.analysis.all);
    options.analysis.format.print(&report, &registry.console, out)
}

/// A row per need and part of its kind: those that suffice first, the most used one first of all.
fn table(needs: &[Need<'_>], lists: &[List], report: &mut Report) -> Outcome<Grid> {
    let title = "Parts: what is used most of what each can do; those that suffice first";
    let headers = ["for", "part", "suffices", "used [%]", "of", "short of", "pressure [bar]", "flow [l/min]"];
    let mut grid = Grid::new("parts", title, &headers);
    for need in needs {
        let own = lists.iter().filter(|list| list.kind == need.kind);
        let mut checked = own.map(|list| list.check(need)).collect::<Outcome<Vec<_>>>()?.concat();
        if checked.is_empty() {
            continue;
        }
        checked.sort_by(|a, b| b.suffices().cmp(&a.suffices()).then(a.order().total_cmp(&b.order())));
        let enough = checked.iter().filter(|part| part.suffices()).count();
        let best = checked.first().filter(|part| part.suffices());
        let best = best.map_or_else(String::new, |part| format!("; {} is used most", part.name));
        let name = format!("{} for {}", need.kind.plural(), need.name);
        report.line(name, format!("{enough} of {} suffice{best}", checked.len()), "");
        for Checked { name, used, of, short, pressure, flow } in &checked {
            let shown = |number: &Option<f64>, unit| number.map_or(Cell::Empty, |number| Cell::Shown(number, unit));
            grid.row([
                need.name.into(),
                name.as_str().into(),
                if short.is_empty() { "yes" } else { "no" }.into(),
                Cell::Shown(*used, DisplayUnit::Percent),
                of.as_str().into(),
                Cell::Names(short.clone()),
                shown(pressure, DisplayUnit::Bar),
                shown(flow, DisplayUnit::LitrePerMinute),
            ]);
        }
    }
    Ok(grid)
}
