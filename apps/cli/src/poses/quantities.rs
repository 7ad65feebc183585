//! Quantities of a crane at rest in one pose: a row of the table.

use std::collections::BTreeSet;

use crane_live::{LiveCrane, Reach};
use crane_model::{
    CoordinateKind, Description,
    dyn_crane::{DynCrane, Functions},
    envelope::{Axes, Condition, Limits, Varied, only_mass, range_of_loads},
    modes::{Vibration, vibrations},
    results::{KeyFigure, cylinders_at},
    statics,
};
use crane_page::tables::{Cell, Grid};

use super::posed;
use crate::{
    envelope,
    figures::{Curve, Mark, PALETTE, Panel},
    problem::Outcome,
    selection::{Registry, take_numbers},
    variants,
};

/// Which quantities a row has.
#[derive(Clone, Copy)]
pub enum Quantities {
    /// Deflections, pressures, and what the feet carry.
    Statics,
    /// Stresses and tipping.
    Strength,
    /// This many of the lowest frequencies.
    Modes(usize),
}

/// A column: its name, and its unit as people read it.
struct Column {
    name: String,
    unit: &'static str,
}

/// What all rows have in common.
pub struct PosedCrane<'a> {
    crane: &'a dyn DynCrane,
    /// The crane with rigid beams and no other difference, if there is one.
    rigid: Option<(Reach, LiveCrane)>,
    /// Index of the load and its smallest value.
    load: Option<(usize, f64)>,
    axes: &'a Axes,
    /// The point whose radius, height and deflection are shown.
    pub reach: Reach,
    wanted: Quantities,
}

/// A pose: values of the axes, of the quantities in SI, and how statics ended.
pub struct PoseRow {
    settings: Vec<f64>,
    values: Vec<Option<f64>>,
    status: String,
    stable: bool,
    /// Limits of the crane's parts that it is beyond: their kinds and locations.
    exceeded: BTreeSet<(&'static str, String)>,
}

impl PoseRow {
    /// Whether the crane rests in a stable equilibrium.
    pub fn stands(&self) -> bool {
        self.stable
    }
}

impl<'a> PosedCrane<'a> {
    /// The crane with its rigid twin.
    pub fn new(
        crane: &'a dyn DynCrane,
        axes: &'a Axes,
        point: Option<&str>,
        wanted: Quantities,
        registry: &Registry,
    ) -> Outcome<Self> {
        let description = crane.description();
        let reach_of = |live: &LiveCrane| envelope::reach(point, only_mass(live.description()), live);
        let checked = registry.checked(&description.name).ok().filter(|_| matches!(wanted, Quantities::Statics));
        let change = checked.and_then(|checked| variants::rigid(&description.name, &checked.spec.crane).ok()?);
        // A crane that moves by its beams alone has no rigid form.
        let twin = change.and_then(|change| registry.changed(&description.name, &change).ok()?.ok());
        let twin = twin.map(|checked| LiveCrane::new(checked.chain));
        let rigid = twin.filter(|twin| twin.description().parameters.len() == description.parameters.len());
        let rigid = match rigid {
            Some(rigid) => Some((reach_of(&rigid)?, rigid)),
            None => None,
        };
        let varies = |index| axes.0.iter().any(|axis| axis.varied == Varied::Parameter(index));
        let load = only_mass(description).filter(|load| !varies(*load) && matches!(wanted, Quantities::Statics));
        let load = load.map(|load| (load, range_of_loads(crane, load, None)[0]));
        let reach = reach_of(&registry.live(crane)?)?;
        Ok(Self { crane, rigid, load, axes, reach, wanted })
    }

    fn columns(&self) -> Vec<Column> {
        let description = self.crane.description();
        let column = |name: &str, unit| Column { name: name.to_owned(), unit };
        let figure = |KeyFigure { name, shown, .. }: KeyFigure| column(name, shown);
        let mut columns = vec![column("radius", "m"), column("height", "m")];
        match self.wanted {
            Quantities::Statics => {
                columns.extend(self.rigid.as_ref().map(|_| column("deflection by flexibility", "m")));
                columns.extend(self.load.map(|_| column("deflection by the load", "m")));
                if !description.supports.is_empty() {
                    columns.push(column("smallest force of a foot", "N"));
                }
                let pressure = |name: &str| column(&format!("pressure of {name}"), "bar");
                columns.extend(description.cylinders.iter().map(|info| pressure(info.name.as_str())));
            }
            Quantities::Strength => {
                columns.extend([figure(KeyFigure::UTILISATION), figure(KeyFigure::EQUIVALENT_STRESS)]);
                if !description.supports.is_empty() {
                    columns.push(figure(KeyFigure::TIPPING_MARGIN));
                }
            }
            Quantities::Modes(count) => columns.extend((1..=count).flat_map(|mode| {
                [column(&format!("frequency {mode}"), "Hz"), column(&format!("damping ratio {mode}"), "")]
            })),
        }
        columns
    }

    /// The row of a pose.
    pub fn row(&self, settings: &[(usize, f64)]) -> Outcome<PoseRow> {
        let crane = posed(self.crane, settings)?;
        let crane = crane.as_ref();
        let equilibrium = crane.equilibrium(&statics::Settings::default());
        let (stable, status) = (equilibrium.is_stable(), equilibrium.status.name().to_owned());
        let settings: Vec<f64> = settings.iter().map(|(_, value)| *value).collect();
        if !stable {
            return Ok(PoseRow {
                settings,
                values: vec![None; self.columns().len()],
                status,
                stable,
                exceeded: BTreeSet::new(),
            });
        }
        let q = equilibrium.q;
        let positions = crane.drive_targets_at(0.0);
        let limits = Limits { tipping: None, utilisation: None, ..Limits::usual(crane.description()) };
        let beyond = Condition::at(crane, q.clone(), &positions).exceeded(crane, &limits);
        let exceeded = beyond.iter().map(|margin| (margin.limit.kind(), margin.limit.location(crane))).collect();
        let mut values: Vec<_> = self.reach.radius_and_height(&q, &crane.parameter_values()).map(Some).into();
        match self.wanted {
            Quantities::Statics => values.extend(self.of_statics(crane, &q)?),
            Quantities::Strength => values.extend(of_strength(crane, q)),
            Quantities::Modes(count) => values.extend(of_modes(crane, &q, count)?),
        }
        Ok(PoseRow { settings, values, status, stable, exceeded })
    }

    fn of_statics(&self, crane: &dyn DynCrane, q: &[f64]) -> Outcome<Vec<Option<f64>>> {
        let position = self.reach.position(q, &crane.parameter_values());
        let moved = |other: &dyn DynCrane, reach: &Reach| {
            let rest = other.equilibrium(&statics::Settings::default());
            rest.is_stable().then(|| (position - reach.position(&rest.q, &other.parameter_values())).norm())
        };
        let mut values = Vec::new();
        if let Some((reach, rigid)) = &self.rigid {
            let mut rigid = rigid.boxed_clone();
            take_numbers(crane, rigid.as_mut())?;
            values.push(moved(rigid.as_ref(), reach));
        }
        if let Some(unloaded) = self.load {
            values.push(moved(posed(crane, &[unloaded])?.as_ref(), &self.reach));
        }
        let rest = vec![0.0; q.len()];
        if !crane.description().supports.is_empty() {
            let forces = crane.support_reactions_at(q, &rest);
            values.push(forces.iter().map(|force| force.z).min_by(f64::total_cmp));
        }
        let cylinders = cylinders_at(crane, q, &rest, &crane.drive_efforts_at_rest(q));
        values.extend(cylinders.iter().map(|state| state.pressures.into_iter().max_by(f64::total_cmp)));
        Ok(values)
    }

    /// What must not be overlooked.
    pub fn cautions(&self, rows: &[PoseRow]) -> Vec<String> {
        let mut cautions = Vec::new();
        let fallen = rows.iter().filter(|row| !row.stable).count();
        if fallen > 0 {
            cautions
                .push(format!("{fallen} of {} poses have no stable equilibrium: see the column status", rows.len()));
        }
        let over = |name: &str, is_over: fn(f64) -> bool| {
            let index = self.columns().iter().position(|column| column.name == name)?;
            let count = rows.iter().filter(|row| row.values[index].is_some_and(is_over)).count();
            (count > 0).then_some(count)
        };
        let of = |count: usize| format!("in {count} of {} poses", rows.len());
        let stressed = over(KeyFigure::UTILISATION.name, |value| value > 1.0);
        cautions.extend(stressed.map(|count| format!("{} the stress exceeds what is allowed", of(count))));
        let tips = over(KeyFigure::TIPPING_MARGIN.name, |value| value <= 0.0);
        cautions.extend(tips.map(|count| format!("{} the crane tips over", of(count))));
        let lifts = over("smallest force of a foot", |value| value <= 0.0);
        cautions.extend(lifts.map(|count| format!("{} a foot lifts or pulls", of(count))));
        let kinds: BTreeSet<_> = rows.iter().flat_map(|row| &row.exceeded).collect();
        cautions.extend(kinds.into_iter().map(|exceeded| {
            let count = rows.iter().filter(|row| row.exceeded.contains(exceeded)).count();
            let (kind, location) = exceeded;
            format!("{} the limit of {location} is exceeded: {kind}", of(count))
        }));
        cautions
    }

    /// Names and units of the axes, and whether they are angles.
    fn headings(&self) -> Vec<(String, String, bool)> {
        let Description { coordinates, drives, parameters, .. } = self.crane.description();
        let of = |varied| match varied {
            Varied::Drive(drive) => {
                let info = &coordinates[drives[drive].coordinate];
                let angle = info.kind == CoordinateKind::Rotation;
                (info.name.to_string(), if angle { "°" } else { info.kind.unit() }.to_owned(), angle)
            }
            Varied::Parameter(index) => {
                let info = &parameters[index];
                let angle = info.unit == "rad";
                (info.name.to_string(), if angle { "°" } else { info.unit.as_str() }.to_owned(), angle)
            }
        };
        self.axes.0.iter().map(|axis| of(axis.varied)).collect()
    }
}

/// Utilisation, equivalent stress and tipping margin.
fn of_strength(crane: &dyn DynCrane, q: Vec<f64>) -> Vec<Option<f64>> {
    let positions = crane.drive_targets_at(0.0);
    let condition = Condition::at(crane, q, &positions);
    let stress = condition.sections.iter().map(|section| section.stress.equivalent).max_by(f64::total_cmp);
    let mut values = vec![condition.utilisation(), stress];
    if !crane.description().supports.is_empty() {
        values.push(condition.margin());
    }
    values
}

/// The lowest frequencies of undamped modes, and the damping ratios of the damped modes that move in the same way.
fn of_modes(crane: &dyn DynCrane, q: &[f64], count: usize) -> Outcome<Vec<Option<f64>>> {
    let vibrations = vibrations(&crane.small_motions_at(q))?;
    let pair = |mode: usize| {
        let vibration = vibrations.get(mode);
        [vibration.and_then(|vibration| vibration.mode.frequency()), vibration.and_then(Vibration::damping_ratio)]
    };
    Ok((0..count).flat_map(pair).collect())
}

/// The rows as a table.
pub fn table(subject: &PosedCrane<'_>, rows: &[PoseRow]) -> Grid {
    let axes = subject.headings();
    let columns = subject.columns();
    let named = |name: &str, unit: &str| if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") };
    let headings: Vec<String> = (axes.iter().map(|(name, unit, _)| named(name, unit)))
        .chain(columns.iter().map(|column| named(&column.name, column.unit)))
        .chain(["status".to_owned()])
        .collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let mut grid = Grid::new("poses", "Poses at rest", &headings);
    for row in rows {
        let settings = row.settings.iter().zip(&axes);
        let settings = settings
            .map(|(value, (.., angle))| if *angle { Cell::of_unit(*value, "rad") } else { Cell::Number(*value) });
        let values = row.values.iter().zip(&columns);
        let values = values.map(|(value, column)| value.map_or(Cell::Empty, |value| Cell::shown(value, column.unit)));
        grid.row(settings.chain(values).chain([row.status.as_str().into()]).collect::<Vec<_>>());
    }
    grid
}

/// A panel for every quantity over the only axis; nothing for several axes.
pub fn figure(subject: &PosedCrane<'_>, rows: &[PoseRow]) -> Vec<Panel> {
    let headings = subject.headings();
    let [(name, unit, angle)] = headings.as_slice() else { return Vec::new() };
    let across = |value: f64| if *angle { value.to_degrees() } else { value };
    let panel = |(index, column): (usize, Column)| {
        let point = |row: &PoseRow| {
            let value = row.values[index]?;
            Some((across(row.settings[0]), Cell::shown(value, column.unit).number()?))
        };
        let points: Vec<_> = rows.iter().filter_map(point).collect();
        let y = if column.unit.is_empty() { column.name } else { format!("{} [{}]", column.name, column.unit) };
        let curve = Curve { label: String::new(), colour: PALETTE[0], mark: Mark::Solid, points };
        Panel { x: format!("{name} [{unit}]"), y, equal: false, logarithmic: false, curves: vec![curve] }
    };
    let mut panels: Vec<Panel> = subject.columns().into_iter().enumerate().map(panel).collect();
    panels.retain(|panel| !panel.curves[0].points.is_empty());
    panels
}
