//! `--combinations` of `crane statics` and `crane strength`: all combinations of a spec side by side, and the worst case of each part.

use std::io::Write;

use crane_live::LiveCrane;
use crane_model::{
    Cut,
    results::{Instant, cylinders_at},
    sections::StressedSection,
    tipping::governing,
};
use crane_page::tables::{Case, Cell, Grid, Report, Scale, equilibria, verdicts};

use crate::{
    arguments::{Analysis, Choice},
    problem::{Outcome, Problem},
    selection::Registry,
};

/// The combinations of a crane's spec, by name.
struct Combinations(Vec<(String, LiveCrane)>);

impl Combinations {
    fn open(choice: &Choice, registry: &Registry) -> Outcome<Self> {
        let crane = choice.open(registry)?;
        let names = registry.combinations(crane.description().name.as_str())?;
        let each = names.into_iter().map(|name| {
            let combined = registry.live_combined(crane.as_ref(), &name)?;
            Ok((name, combined))
        });
        each.collect::<Outcome<_>>().map(Self)
    }

    fn cases(&self) -> Vec<Case<'_>> {
        self.0.iter().map(|(name, crane)| Case::new(name, crane)).collect()
    }
}

/// An error for the first combination without a stable pose.
fn all_stable(cases: &[Case<'_>]) -> Outcome<()> {
    match cases.iter().find(|case| !case.equilibrium.is_stable()) {
        Some(case) => {
            let title = format!("with combination `{}`, the crane does not rest: {}", case.label, case.equilibrium);
            Err(Problem::failed(title, "the other combinations are printed above"))
        }
        None => Ok(()),
    }
}

/// Prints the equilibrium with each combination.
pub fn statics(options: &Analysis, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let combinations = Combinations::open(&options.crane, registry)?;
    let cases = combinations.cases();
    let mut report = equilibria(&cases, options.crane.limits.bend);
    report.show_all(options.all);
    options.format.print(&report, out)?;
    all_stable(&cases)
}

/// Prints stresses and tipping with each combination, and which of them governs each part.
pub fn strength(options: &Analysis, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let combinations = Combinations::open(&options.crane, registry)?;
    let cases = combinations.cases();
    let mut report = Report::default();
    verdicts(&mut report, &cases);
    let resting: Vec<(&Case<'_>, Instant)> = (cases.iter().filter(|case| case.equilibrium.is_stable()))
        .map(|case| (case, Instant::at_rest(case.crane, &case.equilibrium.q)))
        .collect();
    report.grid(overview(&cases, &resting));
    report.grid(worst(&resting));
    report.show_all(options.all);
    options.format.print(&report, out)?;
    all_stable(&cases)
}

/// All places of beams whose stresses are known.
fn stressed(case: &Case<'_>, rest: &Instant) -> Vec<StressedSection> {
    rest.stressed_sections(case.crane.description(), &case.crane.section_moduli_at())
}

/// One row per combination.
fn overview(cases: &[Case<'_>], resting: &[(&Case<'_>, Instant)]) -> Grid {
    let headers = ["combination", "status", "utilisation", "stress [MPa]", "place", "tipping margin", "line"];
    let mut grid = Grid::new(
        "combinations",
        "Combinations at rest: where beams are used most, and the least tipping margin",
        &headers,
    );
    for case in cases {
        let description = case.crane.description();
        let rest = resting.iter().find(|(other, _)| other.label == case.label).map(|(_, rest)| rest);
        let section = rest.and_then(|rest| stressed(case, rest).into_iter().max_by(StressedSection::by_use));
        let line = rest.and_then(|rest| governing(&rest.lines));
        let feet = line.map(|line| line.feet.map(|foot| description.supports[foot].name.as_str()).join(" – "));
        let stress = section.map(|section| Cell::Shown(section.stress.equivalent, Scale::Megapascal));
        grid.row([
            case.label.into(),
            case.equilibrium.status.name().into(),
            section.and_then(|section| section.utilisation).into(),
            stress.unwrap_or(Cell::Empty),
            section.map_or(Cell::Empty, |section| section.location(description).into()),
            line.map(crane_model::tipping::TippingLine::margin).into(),
            feet.map_or(Cell::Empty, Cell::from),
        ]);
    }
    grid
}

/// A number of each combination.
struct Series {
    what: String,
    quantity: &'static str,
    unit: &'static str,
    values: Vec<f64>,
}

/// Least and greatest value of each quantity, and with which combination.
fn worst(resting: &[(&Case<'_>, Instant)]) -> Grid {
    let headers = ["part", "quantity", "least", "with combination", "greatest", "with the combination", "unit"];
    let mut grid = Grid::new(
        "worst_cases",
        "Least and greatest value of each part, and the combination with which it is",
        &headers,
    );
    for Series { what, quantity, unit, values } in series(resting) {
        let with = |index: usize| resting[index].0.label;
        let order = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let indices = || 0..values.len();
        let (Some(least), Some(greatest)) = (indices().min_by(order), indices().rev().max_by(order)) else { continue };
        grid.row([
            what.into(),
            quantity.into(),
            Cell::shown(values[least], unit),
            with(least).into(),
            Cell::shown(values[greatest], unit),
            with(greatest).into(),
            Scale::of(unit).map_or(unit.into(), Cell::ShownUnit),
        ]);
    }
    grid
}

/// The quantities of beams, joints, supports, cylinders, connectors and drives.
fn series(resting: &[(&Case<'_>, Instant)]) -> Vec<Series> {
    let Some((first, _)) = resting.first() else { return Vec::new() };
    let description = first.crane.description();
    let mut all = Vec::new();
    let mut add = |what: &str, quantity, unit, values: Vec<f64>| {
        all.push(Series { what: what.to_owned(), quantity, unit, values });
    };
    let each = |of: &dyn Fn(&Case<'_>, &Instant) -> f64| {
        resting.iter().map(|(case, rest)| of(case, rest)).collect::<Vec<f64>>()
    };
    for beam in description.beams() {
        let greatest = |of: &dyn Fn(&StressedSection) -> Option<f64>| {
            each(&|case, rest| {
                let sections = stressed(case, rest);
                sections
                    .iter()
                    .filter(|section| section.beam(description) == beam)
                    .filter_map(of)
                    .fold(f64::NAN, f64::max)
            })
        };
        for (quantity, unit, values) in [
            ("utilisation", "", greatest(&|section| section.utilisation)),
            ("equivalent stress", "MPa", greatest(&|section| Some(section.stress.equivalent))),
        ] {
            if values.iter().all(|value| value.is_finite()) {
                add(beam, quantity, unit, values);
            }
        }
    }
    for (index, cut) in description.cuts().iter().enumerate() {
        let name = match cut {
            Cut::Ground => "ground",
            Cut::Joint { body } => description.bodies[*body].link.as_str(),
            Cut::Body { .. } | Cut::Inside { .. } => continue,
        };
        add(name, "force of the joint", "N", each(&|_, rest| rest.wrenches[index].force.norm()));
        add(name, "moment of the joint", "N m", each(&|_, rest| rest.wrenches[index].moment.norm()));
    }
    let at_rest = |case: &Case<'_>| vec![0.0; case.equilibrium.q.len()];
    for (index, support) in description.supports.iter().enumerate() {
        let values = each(&|case, _| case.crane.support_reactions_at(&case.equilibrium.q, &at_rest(case))[index].z);
        add(&support.name, "vertical force", "N", values);
    }
    for (index, cylinder) in description.cylinders.iter().enumerate() {
        let state = |case: &Case<'_>| {
            let q = &case.equilibrium.q;
            cylinders_at(case.crane, q, &at_rest(case), &case.crane.drive_efforts_at_rest(q)).into_iter().nth(index)
        };
        add(&cylinder.name, "force", "N", each(&|case, _| state(case).map_or(f64::NAN, |state| state.force)));
        let pressure = |side: usize| each(&|case, _| state(case).map_or(f64::NAN, |state| state.pressures[side]));
        add(&cylinder.name, "pressure, piston's side", "bar", pressure(0));
        add(&cylinder.name, "pressure, rod's side", "bar", pressure(1));
    }
    for (index, connector) in description.connectors.iter().enumerate().filter(|(_, connector)| !connector.is_pin()) {
        let values =
            each(&|case, _| case.crane.connector_tensions_at(0.0, &case.equilibrium.q, &at_rest(case))[index].force);
        add(&connector.name, "force", connector.kind.force_unit(), values);
    }
    for (index, drive) in description.drives.iter().enumerate() {
        let coordinate = &description.coordinates[drive.coordinate];
        let values = each(&|case, _| case.crane.drive_efforts_at_rest(&case.equilibrium.q)[index]);
        add(&coordinate.name, "effort", coordinate.kind.force_unit(), values);
    }
    all
}
