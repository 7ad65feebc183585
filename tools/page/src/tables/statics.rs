//! Cranes in equilibrium, one or several side by side.

use crane_model::{
    ConnectorInfo, CoordinateInfo, Description, DisplayUnit, Tension,
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
            Err(Reason::no_equilibrium(self.crane, &self.equilibrium).of(&self.crane.description().name))
        }
    }

    fn coordinates(&self) -> &[CoordinateInfo] {
        &self.crane.description().coordinates
    }

    /// Velocity at rest.
    fn rest(&self) -> Vec<f64> {
        vec![0.0; self.equilibrium.q.len()]
    }

    /// Value of `values`, one per coordinate, at the coordinate of this name.
    fn value(&self, name: &str, values: &[f64]) -> Option<f64> {
        self.coordinates().iter().position(|coordinate| coordinate.name == name).map(|index| values[index])
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
    report.grid(drives(cases));
    if let Some(grid) = cylinders(cases) {
        report.grid(grid);
    }
    report.grid(reactions(cases));
    if let Some(grid) = ground(cases) {
        report.grid(grid);
    }
    if let Some(grid) = friction(cases) {
        report.grid(grid);
    }
    if let Some(grid) = connectors(cases) {
        report.grid(grid);
    }
    if let Some(grid) = loop_joints(cases) {
        report.grid(grid);
    }
    report.grid(points(cases));
    report.excerpt(pose(cases), 0);
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

/// Headings: `first`, a value per case, `unit`.
fn headings(first: &str, cases: &[Case<'_>]) -> Vec<Heading> {
    let values = cases.iter().map(|case| Heading::of(case.label, VALUE));
    [first.into()].into_iter().chain(values).chain(["unit".into()]).collect()
}

/// The case with the most coordinates, which has all names.
fn widest<'c, 'a>(cases: &'c [Case<'a>]) -> Option<&'c Case<'a>> {
    cases.iter().max_by_key(|case| case.coordinates().len())
}

fn pose(cases: &[Case<'_>]) -> Grid {
    let mut grid = Grid::with_headings("pose", "Pose", headings("coordinate", cases));
    for coordinate in widest(cases).map_or(&[][..], Case::coordinates) {
        let unit = coordinate.kind.unit();
        let value = |case: &Case<'_>| case.value(&coordinate.name, &case.equilibrium.q);
        let values = cases.iter().map(|case| value(case).map_or(Cell::Empty, |value| Cell::of_unit(value, unit)));
        let name = Cell::from(coordinate.name.as_str());
        let row: Vec<Cell> = [name].into_iter().chain(values).chain([Cell::unit_of(unit)]).collect();
        grid.row(row);
    }
    grid
}

fn drives(cases: &[Case<'_>]) -> Grid {
    let mut grid = Grid::with_headings("drives", "Torques and forces of the drives", headings("drive", cases));
    let efforts: Vec<Vec<f64>> =
        cases.iter().map(|case| case.crane.drive_efforts_at_rest(&case.equilibrium.q)).collect();
    let Some(first) = cases.first() else { return grid };
    for (index, drive) in first.crane.description().drives.iter().enumerate() {
        let coordinate = &first.coordinates()[drive.coordinate];
        let values = efforts.iter().map(|efforts| Cell::from(efforts.get(index).copied()));
        let unit = coordinate.kind.force_unit();
        let row: Vec<Cell> = [coordinate.name.as_str().into()].into_iter().chain(values).chain([unit.into()]).collect();
        grid.row(row);
    }
    grid
}

/// Lengths, forces and pressures of the cylinders.
fn cylinders(cases: &[Case<'_>]) -> Option<Grid> {
    let first = cases.iter().find(|case| !case.crane.description().cylinders.is_empty())?;
    let headings = headings("cylinder", cases);
    let [name, others @ ..] = headings.as_slice() else { return None };
    let headings = [&[name.clone(), "quantity".into()], others].concat();
    let mut grid = Grid::with_headings("cylinders", "Cylinders", headings);
    let of = |case: &Case<'_>| {
        let q = &case.equilibrium.q;
        cylinders_at(case.crane, q, &case.rest(), &case.crane.drive_efforts_at_rest(q))
    };
    let states: Vec<Vec<CylinderState>> = cases.iter().map(of).collect();
    for (index, info) in first.crane.description().cylinders.iter().enumerate() {
        let kind = first.coordinates()[first.crane.description().drives[info.drive].coordinate].kind;
        let oil = format!("{}/{}", kind.force_unit(), kind.unit());
        let mut row = |quantity: &str, unit: &str, value: &dyn Fn(&CylinderState) -> Option<f64>| {
            let values = states.iter().map(|states| states.get(index).and_then(value));
            let values = values.map(|value| value.map_or(Cell::Empty, |value| Cell::shown(value, unit)));
            let named: [Cell; 2] = [info.name.as_str().into(), quantity.into()];
            let unit = DisplayUnit::of(unit).map_or(unit.into(), Cell::ShownUnit);
            grid.row(named.into_iter().chain(values).chain([unit]).collect::<Vec<Cell>>());
        };
        row("length", "m", &|state| Some(state.length));
        row("extended", "%", &|state| Some(state.extension(info) / info.stroke));
        row("force", "N", &|state| Some(state.force));
        row("pressure, piston's side", "bar", &|state| Some(state.pressures[0]));
        row("pressure, rod's side", "bar", &|state| Some(state.pressures[1]));
        if info.bulk_modulus.is_some() {
            row("stiffness of its oil", &oil, &|state| state.oil_stiffness(info));
        }
    }
    Some(grid)
}

fn reactions(cases: &[Case<'_>]) -> Grid {
    let mut grid = vectors("reactions", "Support reactions", "support", cases);
    let reactions: Vec<_> =
        cases.iter().map(|case| case.crane.support_reactions_at(&case.equilibrium.q, &case.rest())).collect();
    let supports = cases.first().map_or(&[][..], |case| case.crane.description().supports.as_slice());
    for (index, support) in supports.iter().enumerate() {
        let forces = reactions.iter().map(|of| of.get(index).map_or([None; 3], |force| (*force).map(Some).into()));
        grid.row(vector_row(&support.name, forces, "N"));
    }
    if !supports.is_empty() {
        let sums = reactions.iter().map(|of| <[f64; 3]>::from(of.iter().sum::<Vector3<f64>>()));
        grid.row(vector_row("Σ supports", sums, "N"));
        grid.row(vector_row("weight", cases.iter().map(|case| case.crane.weight_at(&case.equilibrium.q)), "N"));
        let is_loaded = |description: &Description| {
            !description.loads.is_empty() || description.connectors.iter().any(ConnectorInfo::holds_to_world)
        };
        if cases.iter().any(|case| is_loaded(case.crane.description())) {
            let loads = cases.iter().map(|case| case.crane.applied_force_at(0.0, &case.equilibrium.q));
            grid.row(vector_row("applied loads", loads, "N"));
        }
    }
    grid
}

/// The pressure of plates on the ground.
fn ground(cases: &[Case<'_>]) -> Option<Grid> {
    let supports = cases.first()?.crane.description().supports.as_slice();
    supports.iter().find_map(|support| support.plate_area)?;
    let mut grid = Grid::with_headings(
        "ground",
        "Pressure on the ground under the plates of supports",
        headings("support", cases),
    );
    let reactions: Vec<_> =
        cases.iter().map(|case| case.crane.support_reactions_at(&case.equilibrium.q, &case.rest())).collect();
    for (index, support) in supports.iter().enumerate().filter(|(_, support)| support.plate_area.is_some()) {
        let pressure = |of: &Vec<Vector3<f64>>| support.pressure(of.get(index)?.z);
        let cells =
            reactions.iter().map(|of| pressure(of).map_or(Cell::Empty, |pressure| Cell::of_unit(pressure, "Pa")));
        let name: Cell = support.name.as_str().into();
        grid.row([name].into_iter().chain(cells).chain([Cell::unit_of("Pa")]).collect::<Vec<Cell>>());
    }
    Some(grid)
}

/// How much of its friction each foot on the ground uses.
fn friction(cases: &[Case<'_>]) -> Option<Grid> {
    let description = cases.iter().map(|case| case.crane.description()).find(|description| description.has_feet())?;
    let title =
        "Friction of feet on the ground: lateral force over the largest that the ground holds; at 100 % a foot slides";
    let unit = || DisplayUnit::of("%").map_or("%".into(), Cell::ShownUnit);
    let mut grid = Grid::with_headings("friction", title, headings("support", cases));
    let used: Vec<_> = cases.iter().map(|case| case.crane.friction_utilisations_at(&case.equilibrium.q)).collect();
    for (index, support) in description.supports.iter().enumerate().filter(|(_, support)| support.one_sided) {
        let of_case = |used: &Vec<(usize, f64)>| {
            used.iter()
                .find(|(foot, _)| *foot == index)
                .map_or(Cell::Empty, |(_, used)| Cell::shown(used.min(1.0), "%"))
        };
        let name: Cell = support.name.as_str().into();
        grid.row([name].into_iter().chain(used.iter().map(of_case)).chain([unit()]).collect::<Vec<Cell>>());
    }
    Some(grid)
}

/// Lengths and forces of connectors.
fn connectors(cases: &[Case<'_>]) -> Option<Grid> {
    let first = cases.iter().find(|case| !case.crane.description().connectors.is_empty())?;
    let mut headings = headings("connector", cases);
    headings.insert(1, "quantity".into());
    let title = "Connectors: lengths, and forces, positive in tension; slips of couplings, angles of pins";
    let mut grid = Grid::with_headings("connectors", title, headings);
    let at_rest = |case: &Case<'_>| {
        let (q, rest) = (&case.equilibrium.q, case.rest());
        let lengths = case.crane.connector_lengths_at(q, &rest).into_iter().map(|[length, _]| length);
        lengths.zip(case.crane.connector_tensions_at(0.0, q, &rest)).collect::<Vec<_>>()
    };
    let values: Vec<_> = cases.iter().map(at_rest).collect();
    for (index, connector) in first.crane.description().connectors.iter().enumerate() {
        let mut row = |quantity: &str, unit: &str, of: fn(&(f64, Tension)) -> f64| {
            let cell = |values: &Vec<_>| values.get(index).map_or(Cell::Empty, |value| Cell::of_unit(of(value), unit));
            let words = [connector.name.as_str().into(), quantity.into()];
            let cells = values.iter().map(cell);
            grid.row(words.into_iter().chain(cells).chain([Cell::unit_of(unit)]).collect::<Vec<_>>());
        };
        row(connector.strain().name(), connector.kind.unit(), |(length, _)| *length);
        // At rest, nothing rubs.
        if !connector.is_pin() {
            row("force", connector.kind.force_unit(), |(_, tension)| tension.force);
        }
    }
    Some(grid)
}

/// Forces and moments of the joints that close loops and of rigid couplings.
fn loop_joints(cases: &[Case<'_>]) -> Option<Grid> {
    let first = cases.iter().find(|case| !case.crane.loop_joints().is_empty())?;
    let mut headings = headings("joint", cases);
    headings.insert(1, "quantity".into());
    let of_joints =
        "Joints that close loops: what `to` exerts on `from`, in the axes of `from`; rods are positive in tension";
    let of_couplings = "Rigid couplings: what resists the coordinate that follows";
    let [joints, couplings] =
        [false, true].map(|couplings| first.crane.loop_joints().iter().any(|joint| joint.is_coupling() == couplings));
    let title = match (joints, couplings) {
        (true, true) => format!("{of_joints}. {of_couplings}"),
        (_, true) => of_couplings.to_owned(),
        (_, false) => of_joints.to_owned(),
    };
    let mut grid = Grid::with_headings("loop_joints", title, headings);
    let values: Vec<_> = cases.iter().map(|case| case.crane.loop_forces_at_rest(&case.equilibrium.q)).collect();
    let joints = first.crane.loop_joints().iter();
    let equations = joints.flat_map(|joint| joint.equations.iter().map(move |equation| (joint, equation)));
    for (index, (joint, equation)) in equations.enumerate() {
        let quantity = format!("{} {}", equation.what(), equation.direction);
        let cells = values.iter().map(|values| Cell::from(values.get(index).copied()));
        let words = [joint.name.as_str().into(), quantity.trim_end().to_owned().into()];
        grid.row(words.into_iter().chain(cells).chain([equation.force_unit().into()]).collect::<Vec<_>>());
    }
    Some(grid)
}

fn points(cases: &[Case<'_>]) -> Grid {
    let mut grid = vectors("points", "Points of interest", "point", cases);
    let positions: Vec<_> = cases.iter().map(|case| case.crane.points_at(&case.equilibrium.q)).collect();
    for (index, name) in
        cases.first().map_or(&[][..], |case| case.crane.description().points.as_slice()).iter().enumerate()
    {
        let places =
            positions.iter().map(|of| of.get(index).map_or([None; 3], |position| (*position).map(Some).into()));
        grid.row(vector_row(name, places, "m"));
    }
    grid
}

/// A table of vectors, three columns per case.
fn vectors(key: &'static str, title: &str, first: &str, cases: &[Case<'_>]) -> Grid {
    let axes = cases.iter().flat_map(|case| ["x", "y", "z"].map(|axis| Heading::of(case.label, axis)));
    Grid::with_headings(key, title, [first.into()].into_iter().chain(axes).chain(["unit".into()]).collect())
}

fn vector_row<T: Into<Cell>>(name: &str, vectors: impl Iterator<Item = [T; 3]>, unit: &str) -> Vec<Cell> {
    let cells = vectors.flatten().map(Into::into);
    [name.into()].into_iter().chain(cells).chain([unit.into()]).collect()
}
