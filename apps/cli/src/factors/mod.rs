//! `crane factors`: dynamic factors, what a manoeuvre makes of what the crane carries at rest along it.

mod tabulated;

use std::io::Write;

use crane_codegen::presets::hoisting_factor;
use crane_model::{
    ColumnKind, Cut, Description, DisplayUnit, SectionModuli, Wrench,
    dyn_crane::DynCrane,
    results::{Column, Extremes, Instant, ROUNDING, Table, instants},
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
    // Of what differs by rounding the first: a drive stands before its joint.
    let greatest = rows
        .iter()
        .filter_map(|row| Some((row, row.factor?)))
        .reduce(|known, other| if other.1 > known.1 * (1.0 + ROUNDING) { other } else { known });
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
    fn new(name: impl Into<String>, unit: &str, extremes: [Extremes; 2]) -> Self {
        Self { name: name.into(), unit: unit.to_owned(), shown: None, extremes, factor: None }
    }

    /// The largest size at rest, and in motion.
    fn sizes(&self) -> [f64; 2] {
        self.extremes.each_ref().map(Extremes::size)
    }
}

/// All forces, moments, pressures, what joints transmit, and the stress of each beam.
fn rows(crane: &dyn DynCrane, (run, rest): (&Table, &Table), at_rest: &[Instant]) -> Vec<FactorRow> {
    let moving = instants(crane, run.rows.iter());
    let description = crane.description();
    let is_load = |unit: &str| ["N", "N m", "Pa"].contains(&unit);
    let loads = run.columns.iter().filter(|column| column.kind.has_peaks() && is_load(&column.unit));
    let mut columns: Vec<FactorRow> = loads
        .clone()
        .map(|Column { name, unit, .. }| {
            FactorRow::new(name, unit, [rest, run].map(|table| Extremes::of_column(table, name)))
        })
        .collect();
    set_factors(&mut columns);
    let components = components(run);
    for (row, column) in columns.iter_mut().zip(loads) {
        if components.iter().any(|(_, of_joint)| of_joint.contains(&column)) {
            row.factor = None;
        }
    }
    let mut joints = of_joints(description, [at_rest, &moving]);
    joints.extend(components.iter().map(|(name, columns)| {
        let extremes = [rest, run].map(|table| magnitude(table, columns));
        FactorRow::new(name, &columns[0].unit, extremes)
    }));
    set_factors(&mut joints);
    let moduli = crane.section_moduli_at();
    let beams = description.beams().into_iter().filter_map(|beam| {
        let stresses = [at_rest, &moving].map(|instants| {
            let stress = |instant: &Instant| Some((instant.t, greatest_stress(description, &moduli, beam, instant)?));
            instants.iter().filter_map(stress).collect::<Vec<_>>()
        });
        let is_known = !stresses[1].is_empty();
        let extremes = stresses.map(|stresses| Extremes::over(stresses.into_iter()));
        let [rest, run] = extremes.each_ref().map(Extremes::size);
        let factor = (rest > ROUNDING * run).then(|| run / rest);
        let row = FactorRow::new(format!("stress of {beam}"), "Pa", extremes);
        is_known.then_some(FactorRow { shown: Some(DisplayUnit::Megapascal), factor, ..row })
    });
    columns.into_iter().chain(joints).chain(beams).collect()
}

/// Sets the factors of quantities that are comparable where they have the same unit.
fn set_factors(rows: &mut [FactorRow]) {
    let size = |unit: &str| {
        let of_unit = rows.iter().filter(|row| row.unit == unit);
        of_unit.map(|row| row.sizes()[0]).fold(0.0, f64::max)
    };
    let hardly: Vec<f64> = rows.iter().map(|row| HARDLY * size(&row.unit)).collect();
    for (row, hardly) in rows.iter_mut().zip(hardly) {
        let [rest, run] = row.sizes();
        row.factor = (rest > hardly.max(ROUNDING * run)).then(|| run / rest);
    }
}

/// What a joint that closes a loop transmits in several directions: a name for its magnitude, and its components. A component alone depends on the axes, and so on
/// the joint at which a loop is closed.
fn components(run: &Table) -> Vec<(String, Vec<&Column>)> {
    let mut found: Vec<(String, Vec<&Column>)> = Vec::new();
    for column in &run.columns {
        let what = match column.kind {
            ColumnKind::LoopForce => "force",
            ColumnKind::LoopMoment => "moment",
            _ => continue,
        };
        let name = format!("{what} of joint {}", column.part());
        match found.iter_mut().find(|(known, _)| *known == name) {
            Some((_, columns)) => columns.push(column),
            None => found.push((name, vec![column])),
        }
    }
    found.retain(|(_, columns)| columns.len() > 1);
    found
}

/// Extremes of the magnitude of components.
fn magnitude(table: &Table, components: &[&Column]) -> Extremes {
    let mut squares = vec![0.0; table.rows.len()];
    for values in components.iter().filter_map(|column| table.values(&column.name)) {
        squares.iter_mut().zip(values).for_each(|(sum, value)| *sum += value * value);
    }
    Extremes::over(table.rows.iter().zip(squares).map(|(row, square)| (row[0], square.sqrt())))
}

/// Magnitudes of what the joints of the tree transmit, at rest and in motion.
fn of_joints(description: &Description, instants: [&[Instant]; 2]) -> Vec<FactorRow> {
    let of_joint = |(index, cut): (usize, &Cut)| {
        let Cut::Joint { body } = cut else { return None };
        let link = &description.bodies[*body].link;
        let row = |what: &str, unit: &str, size: fn(&Wrench) -> f64| {
            let extremes = instants.map(|instants| {
                let size = |instant: &Instant| (instant.t, instant.wrenches.get(index).map_or(0.0, size));
                Extremes::over(instants.iter().map(size))
            });
            FactorRow::new(format!("{what} of joint {link}"), unit, extremes)
        };
        Some([row("force", "N", |wrench| wrench.force.norm()), row("moment", "N m", |wrench| wrench.moment.norm())])
    };
    description.cuts().iter().enumerate().filter_map(of_joint).flatten().collect()
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
