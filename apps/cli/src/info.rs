//! `crane info` and `crane list`: the contents of a crane, and the shipped cranes.

use std::io::Write;

use crane_codegen::chain::Chain;
use crane_model::runs::{EQUILIBRIUM, GUESS};
use crane_model::{Description, Moment};
use crane_page::tables::{Cell, Grid, Report};

use crate::{
    arguments::{Analysis, Format},
    problem::Outcome,
    selection::Registry,
};

/// Prints the available cranes.
pub fn list(format: Format, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let mut grid = Grid::new("cranes", "Cranes", &["name", "coordinates", "title"]);
    for crane in registry.all() {
        let crane = crane?;
        let description = crane.description();
        grid.row([
            description.name.as_str().into(),
            description.coordinates.len().into(),
            description.title.as_str().into(),
        ]);
    }
    let mut report = Report::default();
    report.grid(grid);
    format.print(&report, &registry.console, out)
}

/// Prints the parts of a crane.
pub fn info(options: &Analysis, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.crane.open(registry)?;
    let description = crane.description();
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    report.fact("title", description.title.as_str(), "");
    report.fact("spec hash", description.spec_hash.as_str(), "");
    report.fact("coordinates", description.coordinates.len(), "");
    report.fact("start", if description.statics { EQUILIBRIUM } else { GUESS }, "");
    report.fact("duration", description.duration, "s");
    report.fact("step", description.step, "s");
    report.fact("output", description.output, "s");

    let mut parameters =
        Grid::new("parameters", "Live parameters (`--set name=value`)", &["name", "value", "default", "unit", "about"]);
    for (index, parameter) in description.parameters.iter().enumerate() {
        parameters.row([
            parameter.name.as_str().into(),
            crane.parameter(index).into(),
            parameter.default.into(),
            parameter.unit.as_str().into(),
            parameter.about.as_str().into(),
        ]);
    }
    report.grid(parameters);

    if !description.inputs.is_empty() {
        let headers = ["name", "set to", "otherwise", "unit", "about"];
        let mut inputs = Grid::new("inputs", "Inputs (`--input name=value`)", &headers);
        for (index, input) in description.inputs.iter().enumerate() {
            let otherwise = input.default.map_or("a motion".into(), Cell::from);
            let (unit, about) = (input.unit.as_str().into(), input.about.as_str().into());
            inputs.row([input.name.as_str().into(), crane.input(index).into(), otherwise, unit, about]);
        }
        report.grid(inputs);
    }

    let mut coordinates = Grid::new("q", "Coordinates", &["index", "name", "unit", "role", "guess"]);
    let guess = crane.guess();
    for (index, coordinate) in description.coordinates.iter().enumerate() {
        coordinates.row([
            index.into(),
            coordinate.name.as_str().into(),
            coordinate.kind.unit().into(),
            coordinate.role.name().into(),
            guess[index].into(),
        ]);
    }
    report.grid(coordinates);

    let mut bodies = Grid::new("bodies", "Bodies", &["name", "link", "mass [kg]", "length [m]", "degrees of freedom"]);
    for (body, [mass, length]) in description.bodies.iter().zip(crane.body_sizes_at()) {
        let length = (length > 0.0).then_some(length);
        bodies.row([
            body.name.as_str().into(),
            body.link.as_str().into(),
            mass.into(),
            length.into(),
            body.degrees_of_freedom.into(),
        ]);
    }
    report.grid(bodies);

    let mut supports = Grid::new("supports", "Supports", &["name", "x [m]", "y [m]", "z [m]"]);
    for (support, place) in description.supports.iter().zip(crane.support_places_at()) {
        let [x, y, z] = <[f64; 3]>::from(place).map(Cell::from);
        supports.row([support.name.as_str().into(), x, y, z]);
    }
    report.grid(supports);

    let mut drives = Grid::new("drives", "Drives at t = 0", &["coordinate", "position", "unit"]);
    for (drive, [position, _]) in description.drives.iter().zip(crane.drive_motions_at(0.0)) {
        let coordinate = &description.coordinates[drive.coordinate];
        drives.row([coordinate.name.as_str().into(), position.into(), coordinate.kind.unit().into()]);
    }
    report.grid(drives);

    let mut points = Grid::new("points", "Points of interest", &["name"]);
    for point in &description.points {
        points.row([point.as_str().into()]);
    }
    report.grid(points);
    report.grid(combinations(registry.live(crane.as_ref())?.chain()));
    report.grid(events(description));
    options.format.print(&report, &registry.console, out)
}

/// What events of a run set.
fn events(description: &Description) -> Grid {
    let headings = ["event", "at [s]", "when", "parameter", "value", "unit"];
    let mut grid = Grid::new("events", "Events of runs: values of parameters from then on", &headings);
    for event in &description.events {
        let [at, when] = match &event.moment {
            Moment::At(time) => [(*time).into(), Cell::Empty],
            Moment::When(condition) => [Cell::Empty, condition.to_string().into()],
        };
        for &(parameter, value) in &event.changes {
            let info = &description.parameters[parameter];
            let [name, of, unit] = [&event.name, &info.name, &info.unit].map(|text| text.as_str().into());
            grid.row([name, at.clone(), when.clone(), of, value.into(), unit]);
        }
    }
    grid
}

/// The partial factors of combinations of weights and loads.
fn combinations(chain: &Chain) -> Grid {
    let mut grid = Grid::new("combinations", "Combinations of weights and loads", &["combination", "of", "factor"]);
    for combination in &chain.combinations {
        let masses = combination.masses.iter().map(|(mass, factor)| (chain.parameters[mass.0].name.as_str(), *factor));
        let loads = combination.loads.iter().map(|(load, factor)| (chain.loads[*load].name.as_str(), *factor));
        for (of, factor) in [("weight", combination.weight)].into_iter().chain(masses).chain(loads) {
            grid.row([combination.name.as_str().into(), of.into(), factor.into()]);
        }
    }
    grid
}
