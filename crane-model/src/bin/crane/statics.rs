//! `crane statics`: the pose at rest, of one crane or of several side by side.

use std::io::Write;

use crane_model::{
    CoordinateInfo, CoordinateKind, CoordinateRole,
    rig::Rig,
    statics::{Equilibrium, Settings},
};

use crate::{
    arguments::{Analysis, Format},
    problem::{Outcome, Problem},
    report::{Cell, Grid, Report},
};

/// A crane in equilibrium.
pub struct Case<'a> {
    /// Heading of its column.
    pub label: &'a str,
    /// The crane.
    pub rig: &'a dyn Rig,
    /// Where it rests.
    pub equilibrium: Equilibrium,
}

impl<'a> Case<'a> {
    /// Solves statics.
    pub fn new(label: &'a str, rig: &'a dyn Rig) -> Self {
        Self { label, rig, equilibrium: rig.equilibrium(&Settings::default()) }
    }

    /// A problem unless the equilibrium is stable.
    pub fn stable(&self) -> Outcome<()> {
        if self.equilibrium.is_stable() {
            Ok(())
        } else {
            Err(Problem::equilibrium(self.rig.description().name, &self.equilibrium))
        }
    }

    fn coordinates(&self) -> &'static [CoordinateInfo] {
        self.rig.description().coordinates
    }

    /// Velocity at rest.
    fn rest(&self) -> Vec<f64> {
        vec![0.0; self.equilibrium.q.len()]
    }

    /// Value of `values`, one a coordinate, at the coordinate of this name.
    fn value(&self, name: &str, values: &[f64]) -> Option<f64> {
        self.coordinates().iter().position(|coordinate| coordinate.name == name).map(|index| values[index])
    }

    /// Gravity along the base's translations: the weight, as far as the base can yield to it. N.
    fn weight(&self) -> [Option<f64>; 3] {
        let forces = self.rig.bias(&self.equilibrium.q, &self.rest());
        ["_x", "_y", "_z"].map(|axis| {
            let index = self.coordinates().iter().position(|coordinate| {
                coordinate.role == CoordinateRole::Base
                    && coordinate.kind == CoordinateKind::Translation
                    && coordinate.name.ends_with(axis)
            })?;
            Some(forces[index])
        })
    }
}

/// Prints the equilibrium of a crane.
pub fn statics(options: &Analysis, out: &mut dyn Write) -> Outcome<()> {
    let rig = options.crane.open()?;
    let case = Case::new("value", rig.as_ref());
    let mut report = tables(std::slice::from_ref(&case));
    if options.format == Format::Json {
        report.grid(history(&case.equilibrium));
    }
    report.print(options.format, out)?;
    case.stable()
}

/// Tables of cranes in equilibrium, a column each.
pub fn tables(cases: &[Case<'_>]) -> Report {
    let mut report = Report::default();
    for case in cases {
        let Equilibrium { status, history, .. } = &case.equilibrium;
        let steps = case.equilibrium.steps();
        let residual = history.last().map_or(f64::NAN, |last| last.residual);
        report.fact(
            case.rig.description().name,
            format!("{status}; {steps} Newton steps, {residual:.1e} of the forces left over"),
            "",
        );
    }
    report.grid(pose(cases));
    report.grid(drives(cases));
    report.grid(reactions(cases));
    report.grid(points(cases));
    report
}

/// How far the points of the second crane are from those of the first.
pub fn deflection(rigid: &Case<'_>, flexible: &Case<'_>) -> Grid {
    let title = format!("Deflection of the load points due to flexibility ({} − {})", flexible.label, rigid.label);
    let mut grid = Grid::new("deflection", title, &["point", "x", "y", "z", "distance", "unit"]);
    let [from, to] = [rigid, flexible].map(|case| case.rig.points(&case.equilibrium.q));
    for (name, (from, to)) in flexible.rig.description().points.iter().zip(from.iter().zip(&to)) {
        let way = (to - from) * 1e3;
        grid.row([(*name).into(), way.x.into(), way.y.into(), way.z.into(), way.norm().into(), "mm".into()]);
    }
    grid
}

/// Headings: `first`, the labels, `unit`.
fn headers<'a>(first: &[&'a str], cases: &[Case<'a>]) -> Vec<&'a str> {
    first.iter().copied().chain(cases.iter().map(|case| case.label)).chain(["unit"]).collect()
}

/// The case with most coordinates: it has all names.
fn widest<'c, 'a>(cases: &'c [Case<'a>]) -> Option<&'c Case<'a>> {
    cases.iter().max_by_key(|case| case.coordinates().len())
}

fn pose(cases: &[Case<'_>]) -> Grid {
    let mut grid = Grid::new("pose", "Pose", &headers(&["coordinate"], cases));
    for coordinate in widest(cases).map_or(&[][..], Case::coordinates) {
        let values = cases.iter().map(|case| Cell::from(case.value(coordinate.name, &case.equilibrium.q)));
        let row: Vec<Cell> =
            [coordinate.name.into()].into_iter().chain(values).chain([coordinate.kind.unit().into()]).collect();
        grid.row(row);
    }
    grid
}

fn drives(cases: &[Case<'_>]) -> Grid {
    let mut grid = Grid::new("drives", "Torques and forces of the drives", &headers(&["drive"], cases));
    let efforts: Vec<Vec<f64>> =
        cases.iter().map(|case| case.rig.drive_efforts(0.0, &case.equilibrium.q, &case.rest())).collect();
    let Some(first) = cases.first() else { return grid };
    for (index, drive) in first.rig.description().drives.iter().enumerate() {
        let coordinate = &first.coordinates()[drive.coordinate];
        let values = efforts.iter().map(|efforts| Cell::from(efforts.get(index).copied()));
        let unit = coordinate.kind.force_unit();
        let row: Vec<Cell> = [coordinate.name.into()].into_iter().chain(values).chain([unit.into()]).collect();
        grid.row(row);
    }
    grid
}

fn reactions(cases: &[Case<'_>]) -> Grid {
    let mut grid = Grid::new("reactions", "Support reactions", &headers(&["support", "axis"], cases));
    let Some(first) = cases.first() else { return grid };
    let reactions: Vec<_> =
        cases.iter().map(|case| case.rig.support_reactions(&case.equilibrium.q, &case.rest())).collect();
    let weights: Vec<_> = cases.iter().map(Case::weight).collect();
    let supports = first.rig.description().supports;
    if supports.is_empty() {
        return grid;
    }
    let mut row = |name: &str, axis: usize, value: &dyn Fn(usize) -> Option<f64>| {
        let cells = [name.into(), ["x", "y", "z"][axis].into()].into_iter();
        grid.row(
            cells.chain((0..cases.len()).map(|case| value(case).into())).chain(["N".into()]).collect::<Vec<Cell>>(),
        );
    };
    for (index, support) in supports.iter().enumerate() {
        for axis in 0..3 {
            row(support.name, axis, &|case| reactions[case].get(index).map(|force| force[axis]));
        }
    }
    for axis in 0..3 {
        row("Σ supports", axis, &|case| Some(reactions[case].iter().map(|force| force[axis]).sum()));
    }
    for axis in 0..3 {
        row("weight", axis, &|case| weights[case][axis]);
    }
    grid
}

fn points(cases: &[Case<'_>]) -> Grid {
    let mut grid = Grid::new("points", "Points of interest", &headers(&["point", "axis"], cases));
    let positions: Vec<_> = cases.iter().map(|case| case.rig.points(&case.equilibrium.q)).collect();
    let Some(first) = cases.first() else { return grid };
    for (index, name) in first.rig.description().points.iter().enumerate() {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let values = positions.iter().map(|of| Cell::from(of.get(index).map(|position| position[axis])));
            let row: Vec<Cell> =
                [(*name).into(), letter.into()].into_iter().chain(values).chain(["m".into()]).collect();
            grid.row(row);
        }
    }
    grid
}

fn history(equilibrium: &Equilibrium) -> Grid {
    let mut grid = Grid::new("history", "Newton iterations", &["step", "residual", "fraction"]);
    for (step, iteration) in equilibrium.history.iter().enumerate() {
        grid.row([step.into(), iteration.residual.into(), iteration.fraction.into()]);
    }
    grid
}
