//! `crane factors`: dynamic factors, what a manoeuvre makes of what the crane carries at rest along it.

mod tabulated;

use std::io::Write;

use crane_codegen::presets::hoisting_factor;
use crane_model::{
    Description, DisplayUnit, SectionModuli,
    dyn_crane::DynCrane,
    results::{Column, Extremes, Instant, Table, instants},
    runs::QuasiStatic,
};
use crane_page::tables::{Case, Cell, Grid, Report, VALUE, verdicts};

use crate::{
    arguments,
    integration::show,
    problem::{Outcome, Problem},
    selection::Registry,
    strength,
};

/// Poses at rest along the manoeuvre, at most.
const POSES: usize = 200;
/// What is less than this part of the largest of its unit at rest has no factor: it is not what the crane carries.
const HARDLY: f64 = 0.05;
/// What is less than this part of its size in the run is rounding at rest.
const NOTHING: f64 = 1e-9;

/// Prints the factors of everything that a crane carries.
pub fn factors(options: &arguments::Factors, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.analysis.crane.open(registry)?;
    let crane = crane.as_ref();
    let case = Case::new(VALUE, crane);
    let mut report = Report::default();
    verdicts(&mut report, std::slice::from_ref(&case));
    if !case.equilibrium.is_stable() {
        options.analysis.format.print(&report, &registry.console, out)?;
        return Ok(case.stable()?);
    }
    let timing = (&options.timing, options.analysis.crane.limits);
    let (start, recorded) = strength::record_manoeuvre(&registry.console, timing, crane, &mut report)?;
    let bar = registry.console.progress(recorded.run.time);
    let rest = QuasiStatic::along(crane, &start, &recorded.table, POSES, &mut show(&bar));
    bar.finish_and_clear();
    if rest.instants.is_empty() {
        return Err(Problem::failed("the crane does not rest at any time of the manoeuvre", ""));
    }
    if let (Some(first), Some(last)) = (rest.restless.first(), rest.restless.last()) {
        report.caution(Some(format!(
            "at {} of {} times from {first} to {last} s the crane does not rest: what it carries there has no part in the values at rest",
            rest.restless.len(),
            rest.restless.len() + rest.instants.len()
        )));
    }
    let rows = rows(crane, (&recorded.table, &rest.table), &rest.instants);
    if rows.is_empty() {
        report.line("factors", "none: no drive, support, connector or beam with known stresses carries anything", "");
    }
    let greatest = rows.iter().filter_map(|row| Some((row, row.factor?))).max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((row, factor)) = greatest {
        report.fact("greatest factor", factor, "");
        report.fact_as("part_of_the_greatest_factor", "of", row.name.as_str(), "");
    }
    if let Some(class) = options.hoisting_class {
        let speed = options.hoisting_speed.unwrap_or_default();
        let (class, factor) = (class.name(), hoisting_factor(class.name(), speed));
        report.fact_as("tabulated_factor", format!("φ₂ of class {class} at {speed} m/s, EN 1991-3"), factor, "");
    }
    report.grid(table(&rows));
    if options.tabulated {
        report.grid(tabulated::table());
    }
    report.show_all(options.analysis.all);
    options.analysis.format.print(&report, &registry.console, out)
}

/// A quantity, and its extremes.
struct FactorRow {
    name: String,
    unit: String,
    /// In which it is shown, if not in that of all quantities of its unit.
    shown: Option<DisplayUnit>,
    /// At rest and in motion.
    extremes: [Extremes; 2],
    factor: Option<f64>,
}

impl FactorRow {
    /// The largest size at rest, and in motion.
    fn sizes(&self) -> [f64; 2] {
        self.extremes.each_ref().map(|extremes| extremes.minimum.abs().max(extremes.maximum.abs()))
    }
}

/// All forces, moments, pressures, and the stress of each beam.
fn rows(crane: &dyn DynCrane, (run, rest): (&Table, &Table), at_rest: &[Instant]) -> Vec<FactorRow> {
    let is_load = |unit: &str| ["N", "N m", "Pa"].contains(&unit);
    let loads = run.columns.iter().filter(|column| column.kind.has_peaks() && is_load(&column.unit));
    let mut rows: Vec<FactorRow> = loads
        .map(|Column { name, unit, .. }| FactorRow {
            name: name.clone(),
            unit: unit.clone(),
            shown: None,
            extremes: [rest, run].map(|table| Extremes::of_column(table, name)),
            factor: None,
        })
        .collect();
    let size = |unit: &str| {
        let of_unit = rows.iter().filter(|row| row.unit == unit);
        of_unit.map(|row| row.sizes()[0]).fold(0.0, f64::max)
    };
    let hardly = rows.iter().map(|row| HARDLY * size(&row.unit)).collect::<Vec<f64>>();
    let (description, moduli) = (crane.description(), crane.section_moduli_at());
    let moving = instants(crane, run.rows.iter());
    let of_beams = description.beams().into_iter().filter_map(|beam| {
        let mut stresses = Table::default();
        stresses.add("t", "s");
        stresses.add("stress", "Pa");
        let extremes = [at_rest, &moving].map(|instants| {
            let stress =
                |instant: &Instant| Some(vec![instant.t, greatest_stress(description, &moduli, beam, instant)?]);
            stresses.rows = instants.iter().filter_map(stress).collect();
            Extremes::of_column(&stresses, "stress")
        });
        let known = !stresses.rows.is_empty();
        let (name, unit, shown) = (format!("stress of {beam}"), "Pa".to_owned(), Some(DisplayUnit::Megapascal));
        known.then_some(FactorRow { name, unit, shown, extremes, factor: None })
    });
    rows.extend(of_beams);
    for (index, row) in rows.iter_mut().enumerate() {
        let [rest, run] = row.sizes();
        let least = hardly.get(index).copied().unwrap_or(0.0).max(NOTHING * run);
        row.factor = (rest > least).then(|| run / rest);
    }
    rows
}

/// The greatest equivalent stress of a beam at an instant, Pa.
fn greatest_stress(description: &Description, moduli: &[SectionModuli], beam: &str, instant: &Instant) -> Option<f64> {
    let sections = instant.stressed_sections(description, moduli).into_iter();
    let own = sections.filter(|section| section.beam(description) == beam);
    own.map(|section| section.stress.equivalent).max_by(f64::total_cmp)
}

fn table(rows: &[FactorRow]) -> Grid {
    let title = "Dynamic factors: the largest size of each quantity in the run, over its largest size at rest along the same motion; times in s";
    let headers = [
        "quantity",
        "minimum at rest",
        "minimum",
        "time of minimum",
        "maximum at rest",
        "maximum",
        "time of maximum",
        "factor",
        "unit",
    ];
    let mut grid = Grid::new("factors", title, &headers);
    for FactorRow { name, unit, shown, extremes: [rest, run], factor } in rows {
        let number = |value| shown.map_or_else(|| Cell::of_unit(value, unit), |shown| Cell::Shown(value, shown));
        grid.row([
            name.as_str().into(),
            number(rest.minimum),
            number(run.minimum),
            Cell::instant(run.time_of_minimum),
            number(rest.maximum),
            number(run.maximum),
            Cell::instant(run.time_of_maximum),
            (*factor).into(),
            shown.map_or_else(|| Cell::unit_of(unit), Cell::ShownUnit),
        ]);
    }
    grid
}
