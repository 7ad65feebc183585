//! `--combinations` of `crane statics` and `crane strength`: all combinations of a spec side by side, and the worst case of each part.

use std::io::Write;

use crane_live::LiveCrane;
use crane_model::{
    Cut, DisplayUnit,
    nalgebra::Vector3,
    results::{CylinderState, Instant, KeyFigure, cautions, cylinders_at},
    sections::StressedSection,
    tipping::governing,
};
use crane_page::tables::{Case, Cell, Grid, Report, equilibria, verdicts};

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
    options.format.print(&report, &registry.console, out)?;
    all_stable(&cases)
}

/// Prints stresses and tipping with each combination, and which of them governs each part.
pub fn strength(options: &Analysis, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let combinations = Combinations::open(&options.crane, registry)?;
    let cases = combinations.cases();
    let mut report = Report::default();
    verdicts(&mut report, &cases);
    let stable = cases.iter().filter(|case| case.equilibrium.is_stable());
    let resting: Vec<Resting<'_>> = stable.map(Resting::new).collect();
    for Resting { case, .. } in &resting {
        let of_pose = cautions::of_pose(case.crane, &case.equilibrium.q, options.crane.limits.bend);
        for caution in of_pose.into_iter().chain(cautions::of_strength(case.crane)) {
            report.caution(Some(format!("{}: {caution}", case.label)));
        }
    }
    report.grid(overview(&cases, &resting));
    report.grid(worst(&resting));
    report.show_all(options.all);
    options.format.print(&report, &registry.console, out)?;
    all_stable(&cases)
}

/// What a crane carries at rest with a combination.
struct Resting<'a> {
    case: &'a Case<'a>,
    instant: Instant,
    /// All places of beams whose stresses are known.
    sections: Vec<StressedSection>,
    reactions: Vec<Vector3<f64>>,
    cylinders: Vec<CylinderState>,
    tensions: Vec<f64>,
    efforts: Vec<f64>,
}

impl<'a> Resting<'a> {
    fn new(case: &'a Case<'a>) -> Self {
        let (crane, q) = (case.crane, &case.equilibrium.q);
        let still = vec![0.0; q.len()];
        let instant = Instant::at_rest(crane, q);
        let efforts = crane.drive_efforts_at_rest(q);
        Self {
            case,
            sections: instant.stressed_sections(crane.description(), &crane.section_moduli_at()),
            instant,
            reactions: crane.support_reactions_at(q, &still),
            cylinders: cylinders_at(crane, q, &still, &efforts),
            tensions: crane.tensions_at_rest(0.0, q),
            efforts,
        }
    }
}

/// One row per combination.
fn overview(cases: &[Case<'_>], resting: &[Resting<'_>]) -> Grid {
    let headers = ["combination", "status", "utilisation", "stress [MPa]", "place", "tipping margin", "line"];
    let mut grid = Grid::new(
        "combinations",
        "Combinations at rest: where beams are used most, and the least tipping margin",
        &headers,
    );
    for case in cases {
        let description = case.crane.description();
        let rest = resting.iter().find(|rest| rest.case.label == case.label);
        let section = rest.and_then(|rest| rest.sections.iter().max_by(|a, b| StressedSection::by_use(a, b)));
        let line = rest.and_then(|rest| governing(&rest.instant.lines));
        let feet = line.map(|line| line.feet.map(|foot| description.supports[foot].name.as_str()).join(" – "));
        let stress = section.map(|section| Cell::Shown(section.stress.equivalent, DisplayUnit::Megapascal));
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
fn worst(resting: &[Resting<'_>]) -> Grid {
    let headers = ["part", "quantity", "least", "with combination", "greatest", "with the combination", "unit"];
    let mut grid = Grid::new(
        "worst_cases",
        "Least and greatest value of each part, and the combination with which it is",
        &headers,
    );
    for Series { what, quantity, unit, values } in series(resting) {
        let with = |index: usize| resting[index].case.label;
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
            DisplayUnit::find(unit).map_or(unit.into(), Cell::ShownUnit),
        ]);
    }
    grid
}

/// The quantities of beams, joints, supports, cylinders, connectors and drives.
fn series(resting: &[Resting<'_>]) -> Vec<Series> {
    let Some(first) = resting.first() else { return Vec::new() };
    let description = first.case.crane.description();
    let mut all = Vec::new();
    let mut add = |what: &str, quantity, unit, values: Vec<f64>| {
        all.push(Series { what: what.to_owned(), quantity, unit, values });
    };
    let each = |of: &dyn Fn(&Resting<'_>) -> f64| resting.iter().map(of).collect::<Vec<f64>>();
    for beam in description.beams() {
        let greatest = |of: &dyn Fn(&StressedSection) -> Option<f64>| {
            each(&|rest| {
                let own = rest.sections.iter().filter(|section| section.beam(description) == beam);
                own.filter_map(of).fold(f64::NAN, f64::max)
            })
        };
        for (figure, values) in [
            (KeyFigure::UTILISATION, greatest(&|section| section.utilisation)),
            (KeyFigure::EQUIVALENT_STRESS, greatest(&|section| Some(section.stress.equivalent))),
        ] {
            if values.iter().all(|value| value.is_finite()) {
                add(beam, figure.name, figure.shown, values);
            }
        }
    }
    for (index, cut) in description.cuts().iter().enumerate() {
        let name = match cut {
            Cut::Ground => "ground",
            Cut::Joint { body } => description.bodies[*body].link.as_str(),
            Cut::Body { .. } | Cut::Inside { .. } => continue,
        };
        add(name, "force of the joint", "N", each(&|rest| rest.instant.wrenches[index].force.norm()));
        add(name, "moment of the joint", "N m", each(&|rest| rest.instant.wrenches[index].moment.norm()));
    }
    for (index, support) in description.supports.iter().enumerate() {
        add(&support.name, "vertical force", "N", each(&|rest| rest.reactions[index].z));
    }
    for (index, cylinder) in description.cylinders.iter().enumerate() {
        let state = |rest: &Resting<'_>| rest.cylinders.get(index).map(|state| (state.force, state.pressures));
        add(&cylinder.name, "force", "N", each(&|rest| state(rest).map_or(f64::NAN, |(force, _)| force)));
        let pressure = |side: usize| each(&|rest| state(rest).map_or(f64::NAN, |(_, pressures)| pressures[side]));
        add(&cylinder.name, "pressure, piston's side", "bar", pressure(0));
        add(&cylinder.name, "pressure, rod's side", "bar", pressure(1));
    }
    for (index, connector) in description.connectors.iter().enumerate().filter(|(_, connector)| !connector.is_pin()) {
        add(&connector.name, "force", connector.kind.force_unit(), each(&|rest| rest.tensions[index]));
    }
    for (index, drive) in description.drives.iter().enumerate() {
        let coordinate = &description.coordinates[drive.coordinate];
        add(&coordinate.name, "effort", coordinate.kind.force_unit(), each(&|rest| rest.efforts[index]));
    }
    all
}
