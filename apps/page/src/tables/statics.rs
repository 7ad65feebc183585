//! Cranes in equilibrium, one or several side by side.

use crane_model::{
    ConnectorInfo, CylinderInfo, DisplayUnit, DriveInfo, LoopEquationInfo, LoopJointInfo, SupportInfo,
    dyn_crane::DynCrane,
    results::{CylinderState, cautions, cylinders_at},
    runs::{Failed, Reason},
    statics::{Equilibrium, Settings},
};
use nalgebra::Vector3;
use serde_json::json;

use super::{Cell, Grid, Heading, Report, VALUE};

/// Label of a crane that is compared with itself with rigid beams.
pub const FLEXIBLE: &str = "flexible";
/// Label of a crane with rigid beams that is compared with itself with beams that bend.
pub const RIGID: &str = "rigid";

/// A crane in equilibrium.
pub struct Case<'a> {
    /// Heading of its column.
    pub label: &'a str,
    /// The crane.
    pub crane: &'a dyn DynCrane,
    /// Where it rests.
    pub equilibrium: Equilibrium,
}

impl<'a> Case<'a> {
    /// Solves statics.
    pub fn new(label: &'a str, crane: &'a dyn DynCrane) -> Self {
        Self { label, crane, equilibrium: crane.equilibrium(&Settings::default()) }
    }

    /// Whether the equilibrium is stable.
    ///
    /// # Errors
    /// It is not: what balances the crane is missing.
    pub fn stable(&self) -> Result<(), Failed> {
        if self.equilibrium.is_stable() {
            Ok(())
        } else {
            Err(Reason::no_equilibrium(self.crane, &self.equilibrium).for_crane(&self.crane.description().name))
        }
    }

    /// Velocity at rest.
    fn rest(&self) -> Vec<f64> {
        vec![0.0; self.equilibrium.q.len()]
    }
}

/// Reports how the statics of each crane ended, and for programs also whether all equilibria are stable.
pub fn verdicts(report: &mut Report, cases: &[Case<'_>]) {
    let mut cranes = Vec::new();
    let name_of = |case: &Case<'_>| case.crane.description().name.to_string();
    let are_one = cases.len() > 1 && cases.iter().all(|case| name_of(case) == name_of(&cases[0]));
    for case @ Case { label, equilibrium, .. } in cases {
        let (name, residual) = (name_of(case), equilibrium.residual());
        let shown = if are_one { format!("{name}, {label}") } else { name.clone() };
        report.line(shown, format!("{equilibrium}, relative residual {residual:.1e}"), "");
        cranes.push(json!({
            "label": label,
            "crane": name,
            "stable": equilibrium.is_stable(),
            "status": equilibrium.status.name(),
            "message": equilibrium.to_string(),
            "newton_steps": equilibrium.steps(),
            "load_steps": equilibrium.load_steps,
            "relative_residual": residual,
        }));
    }
    report.value("stable", cases.iter().all(|case| case.equilibrium.is_stable()));
    report.value("cranes", cranes);
}

/// Tables of cranes in equilibrium, one column each; `bend`: bending or torsion of a section that is cautioned about, degrees.
pub fn equilibria(cases: &[Case<'_>], bend: f64) -> Report {
    let mut report = Report::default();
    verdicts(&mut report, cases);
    for case in cases {
        let (equilibrium, guess) = (&case.equilibrium, case.crane.guess());
        // Where a search ended without an equilibrium, forces and positions mean nothing.
        let (q, prefix) = if equilibrium.rests() { (&equilibrium.q, "") } else { (&guess, "at the guess, ") };
        let label = if cases.len() > 1 { format!("{}: ", case.label) } else { String::new() };
        for caution in cautions::of_pose(case.crane, q, bend) {
            report.caution(Some(format!("{label}{prefix}{caution}")));
        }
    }
    let cases = if cases.iter().all(|case| case.equilibrium.rests()) { cases } else { &[] };
    report.grid(side_by_side(("drives", "Torques and forces of the drives"), &["drive"], &[VALUE], cases, drives));
    let optional = |report: &mut Report, grid: Grid| {
        if !grid.is_empty() {
            report.grid(grid);
        }
    };
    let named = ["cylinder", "quantity"];
    optional(&mut report, side_by_side(("cylinders", "Cylinders"), &named, &[VALUE], cases, cylinders));
    report.grid(side_by_side(("reactions", "Support reactions"), &["support"], AXES, cases, reactions));
    let on_ground = ("ground", "Pressure on the ground under the plates of supports");
    optional(&mut report, side_by_side(on_ground, &["support"], &[VALUE], cases, ground));
    let of_feet =
        "Friction of feet on the ground: lateral force over the largest that the ground holds; at 100 % a foot slides";
    optional(&mut report, side_by_side(("friction", of_feet), &["support"], &[VALUE], cases, friction));
    let of_connectors = "Connectors: lengths, and forces, positive in tension; slips of couplings, angles of pins";
    let named = ["connector", "quantity"];
    optional(&mut report, side_by_side(("connectors", of_connectors), &named, &[VALUE], cases, connectors));
    let (of_loops, named) = (("loop_joints", title_of_loops(cases)), ["joint", "quantity"]);
    optional(&mut report, side_by_side((of_loops.0, &of_loops.1), &named, &[VALUE], cases, loop_joints));
    report.grid(side_by_side(("points", "Points of interest"), &["point"], AXES, cases, points));
    report.excerpt(side_by_side(("pose", "Pose"), &["coordinate"], &[VALUE], cases, pose), 0);
    report
}

/// How far the points of the second crane are from those of the first with the same name; if the first is the same crane with rigid
/// beams, this is the deflection due to flexibility.
pub fn deflection(first: &Case<'_>, second: &Case<'_>) -> Grid {
    let title = if second.label == FLEXIBLE {
        format!("Deflection of the load points due to flexibility ({} − {})", second.label, first.label)
    } else {
        format!("Distances between the points of interest ({} − {})", second.label, first.label)
    };
    let mut grid = Grid::new("deflection", title, &["point", "x", "y", "z", "distance", "unit"]);
    let [from, to] = [first, second].map(|case| case.crane.points_at(&case.equilibrium.q));
    let names = &first.crane.description().points;
    for (name, to) in second.crane.description().points.iter().zip(&to) {
        let Some(from) = names.iter().zip(&from).find_map(|(other, from)| (other == name).then_some(from)) else {
            continue;
        };
        let displacement = to - from;
        let [x, y, z, distance] = [displacement.x, displacement.y, displacement.z, displacement.norm()]
            .map(|displacement| Cell::Shown(displacement, DisplayUnit::Millimetre));
        grid.row([name.as_str().into(), x, y, z, distance, Cell::ShownUnit(DisplayUnit::Millimetre)]);
    }
    grid
}

/// Columns of vectors.
const AXES: &[&str] = &["x", "y", "z"];

/// A row of a table of one crane: what it is about, its values, and their unit.
struct StaticsRow {
    words: Vec<String>,
    values: Vec<Cell>,
    unit: Cell,
}

impl StaticsRow {
    fn new(words: &[&str], value: Cell, unit: Cell) -> Self {
        StaticsRow { words: words.iter().map(ToString::to_string).collect(), values: vec![value], unit }
    }

    /// A number in SI units, as people read all numbers of the unit.
    fn of_unit(words: &[&str], value: f64, unit: &str) -> Self {
        StaticsRow::new(words, Cell::of_unit(value, unit), Cell::unit_of(unit))
    }

    /// A number in SI units that people read in a unit.
    fn shown(words: &[&str], value: Option<f64>, unit: &str) -> Self {
        let value = value.map_or(Cell::Empty, |value| Cell::shown(value, unit));
        StaticsRow::new(words, value, DisplayUnit::find(unit).map_or(unit.into(), Cell::ShownUnit))
    }

    fn vector<T: Into<Cell>>(word: &str, values: [T; 3], unit: &str) -> Self {
        StaticsRow { values: values.map(Into::into).into(), ..StaticsRow::new(&[word], Cell::Empty, unit.into()) }
    }

    /// Whether both are about one thing: what has one name in two cranes.
    fn is_about(&self, other: &StaticsRow) -> bool {
        self.words == other.words && self.unit.text() == other.unit.text()
    }
}

/// A table of cranes side by side, by the names of what they have: where one has no such thing, nothing stands.
fn side_by_side(
    (key, title): (&'static str, &str),
    words: &[&str],
    columns: &[&str],
    cases: &[Case<'_>],
    rows: impl Fn(&Case<'_>) -> Vec<StaticsRow>,
) -> Grid {
    let values = cases.iter().flat_map(|case| columns.iter().map(|column| Heading::about(case.label, column)));
    let headings = words.iter().map(|&word| word.into()).chain(values).chain(["unit".into()]).collect();
    let mut grid = Grid::with_headings(key, title, headings);
    let rows: Vec<Vec<StaticsRow>> = cases.iter().map(rows).collect();
    let mut all: Vec<&StaticsRow> = Vec::new();
    for of_case in &rows {
        let more: Vec<&StaticsRow> =
            of_case.iter().filter(|row| !all.iter().any(|other| other.is_about(row))).collect();
        all.extend(more);
    }
    for row in all {
        let of_case = |rows: &Vec<StaticsRow>| {
            let found = rows.iter().find(|other| other.is_about(row));
            found.map_or_else(|| vec![Cell::Empty; columns.len()], |found| found.values.clone())
        };
        let words = row.words.iter().map(|word| word.as_str().into());
        grid.row(words.chain(rows.iter().flat_map(of_case)).chain([row.unit.clone()]).collect::<Vec<Cell>>());
    }
    grid
}

fn pose(case: &Case<'_>) -> Vec<StaticsRow> {
    let coordinates = case.crane.description().coordinates.iter().zip(&case.equilibrium.q);
    coordinates.map(|(info, value)| StaticsRow::of_unit(&[&info.name], *value, info.kind.unit())).collect()
}

fn drives(case: &Case<'_>) -> Vec<StaticsRow> {
    let description = case.crane.description();
    let efforts = case.crane.drive_efforts_at_rest(&case.equilibrium.q);
    let row = |(drive, effort): (&DriveInfo, f64)| {
        let coordinate = &description.coordinates[drive.coordinate];
        StaticsRow::new(&[&coordinate.name], effort.into(), coordinate.kind.force_unit().into())
    };
    description.drives.iter().zip(efforts).map(row).collect()
}

/// Lengths, forces and pressures of the cylinders.
fn cylinders(case: &Case<'_>) -> Vec<StaticsRow> {
    let (q, description) = (&case.equilibrium.q, case.crane.description());
    let states = cylinders_at(case.crane, q, &case.rest(), &case.crane.drive_efforts_at_rest(q));
    let of_one = |(info, state): (&CylinderInfo, CylinderState)| {
        let kind = description.coordinates[description.drives[info.drive].coordinate].kind;
        let oil = format!("{}/{}", kind.force_unit(), kind.unit());
        let row = |quantity, value, unit: &str| StaticsRow::shown(&[&info.name, quantity], value, unit);
        let mut rows = vec![
            row("length", Some(state.length), "m"),
            row("extended", Some(state.extension(info) / info.stroke), "%"),
            row("force", Some(state.force), "N"),
            row("pressure, piston's side", Some(state.pressures[0]), "bar"),
            row("pressure, rod's side", Some(state.pressures[1]), "bar"),
        ];
        if info.bulk_modulus.is_some() {
            rows.push(row("stiffness of its oil", state.oil_stiffness(info), &oil));
        }
        rows
    };
    description.cylinders.iter().zip(states).flat_map(of_one).collect()
}

fn reactions(case: &Case<'_>) -> Vec<StaticsRow> {
    let (crane, q) = (case.crane, &case.equilibrium.q);
    let description = crane.description();
    let reactions = crane.support_reactions_at(q, &case.rest());
    let named = description.supports.iter().zip(&reactions);
    let mut rows: Vec<StaticsRow> =
        named.map(|(support, force)| StaticsRow::vector(&support.name, <[f64; 3]>::from(*force), "N")).collect();
    if !rows.is_empty() {
        rows.push(StaticsRow::vector("Σ supports", <[f64; 3]>::from(reactions.iter().sum::<Vector3<f64>>()), "N"));
        rows.push(StaticsRow::vector("weight", crane.weight_at(q), "N"));
        if !description.loads.is_empty() || description.connectors.iter().any(ConnectorInfo::holds_to_world) {
            rows.push(StaticsRow::vector("applied loads", crane.applied_force_at(0.0, q), "N"));
        }
    }
    rows
}

/// The pressure of plates on the ground.
fn ground(case: &Case<'_>) -> Vec<StaticsRow> {
    let reactions = case.crane.support_reactions_at(&case.equilibrium.q, &case.rest());
    let plates = case.crane.description().supports.iter().zip(reactions);
    let plates = plates.filter(|(support, _)| support.plate_area.is_some());
    let row = |(support, force): (&SupportInfo, Vector3<f64>)| {
        let pressure = support.pressure(force.z).map_or(Cell::Empty, |pressure| Cell::of_unit(pressure, "Pa"));
        StaticsRow::new(&[&support.name], pressure, Cell::unit_of("Pa"))
    };
    plates.map(row).collect()
}

/// How much of its friction each foot on the ground uses.
fn friction(case: &Case<'_>) -> Vec<StaticsRow> {
    let description = case.crane.description();
    if !description.has_feet() {
        return Vec::new();
    }
    let used = case.crane.friction_utilisations_at(&case.equilibrium.q);
    let feet = description.supports.iter().enumerate().filter(|(_, support)| support.one_sided);
    let row = |(index, support): (usize, &SupportInfo)| {
        let used = used.iter().find(|(foot, _)| *foot == index).map(|(_, used)| used.min(1.0));
        StaticsRow::shown(&[&support.name], used, "%")
    };
    feet.map(row).collect()
}

/// Lengths and forces of connectors.
fn connectors(case: &Case<'_>) -> Vec<StaticsRow> {
    let (q, rest) = (&case.equilibrium.q, case.rest());
    let values = case.crane.connector_lengths_at(q, &rest).into_iter().zip(case.crane.tensions_at_rest(0.0, q));
    let of_one = |(connector, ([length, _], tension)): (&ConnectorInfo, ([f64; 2], f64))| {
        let row = |quantity, value, unit| StaticsRow::of_unit(&[&connector.name, quantity], value, unit);
        let kind = connector.kind;
        // At rest, nothing rubs.
        let force = (!connector.is_pin()).then(|| row(kind.force_name(), tension, kind.force_unit()));
        [row(connector.strain().name(), length, kind.unit())].into_iter().chain(force)
    };
    case.crane.description().connectors.iter().zip(values).flat_map(of_one).collect()
}

fn title_of_loops(cases: &[Case<'_>]) -> String {
    let of_joints =
        "Joints that close loops: what `to` exerts on `from`, in the axes of `from`; rods are positive in tension";
    let of_couplings = "Rigid couplings: what resists the coordinate that follows";
    let [joints, couplings] = [false, true].map(|couplings| {
        cases.iter().flat_map(|case| case.crane.loop_joints()).any(|joint| joint.is_coupling() == couplings)
    });
    match (joints, couplings) {
        (true, true) => format!("{of_joints}. {of_couplings}"),
        (_, true) => of_couplings.to_owned(),
        (_, false) => of_joints.to_owned(),
    }
}

/// Forces and moments of the joints that close loops and of rigid couplings.
fn loop_joints(case: &Case<'_>) -> Vec<StaticsRow> {
    let joints = case.crane.loop_joints().iter();
    let equations = joints.flat_map(|joint| joint.equations.iter().map(move |equation| (joint, equation)));
    let row = |((joint, equation), force): ((&LoopJointInfo, &LoopEquationInfo), f64)| {
        let quantity = format!("{} {}", equation.what(), equation.direction);
        StaticsRow::new(&[&joint.name, quantity.trim_end()], force.into(), equation.force_unit().into())
    };
    equations.zip(case.crane.loop_forces_at_rest(&case.equilibrium.q)).map(row).collect()
}

fn points(case: &Case<'_>) -> Vec<StaticsRow> {
    let positions = case.crane.points_at(&case.equilibrium.q);
    let named = case.crane.description().points.iter().zip(positions);
    named.map(|(name, position)| StaticsRow::vector(name, <[f64; 3]>::from(position), "m")).collect()
}
