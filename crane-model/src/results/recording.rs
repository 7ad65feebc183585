//! Recording of a run in columns.

use std::{collections::HashMap, iter};

use crane_quantities::{ColumnKind, PartColumn};
use nalgebra::Vector3;

use crate::{
    ConnectorInfo, CoordinateKind, Description, LoopJointInfo, StateAt, bristles,
    dyn_crane::{DynCrane, Energies, Functions},
    dynamics::{Phases, Quantities, Sample},
    feet::Slid,
    force_states::{self, ForceStates},
    hydraulics::{self, Oil},
    results::{Column, Table, column_name, cylinders},
};

/// Records the samples of a run of a crane.
///
/// Columns: `t`; `<coordinate>` and `<coordinate>_rate`; for a drive `<coordinate>_prescribed` and `<coordinate>_drive_torque` or
/// `_drive_force`; for a cylinder `<cylinder>_length`, `_speed`, `_force`, `_piston_pressure`, `_rod_pressure` and `_flow`, for all
/// cylinders `pump_flow` and `pump_power`, with valves `pump_pressure` and `<cylinder>_valve`; for a point `<point>_x`, `_y`, `_z` and
/// `_vx`, `_vy`, `_vz`; for a support `<support>_reaction_x`, `_y`, `_z`, and `<support>_gap`, `<support>_slid_x` and `_y` if it is one-sided; for a coordinate of an
/// element `<coordinate>_moment`; for end stops and friction `<coordinate>_stop_torque` or `_stop_force`, `<coordinate>_friction_torque` or
/// `_friction_force`; for joints that stick `<coordinate>_bristle`; for a connector `<connector>_length`, `<connector>_length_rate` and
/// `<connector>_force`; for a coupling `<coupling>_slip`, `<coupling>_slip_rate` and `<coupling>_force` or `_torque`; for a pad `<pad>_offset` and so on; for a loop joint with
/// friction `<joint>_angle`, `<joint>_angle_rate` and `<joint>_friction_torque`; for a joint that closes a loop `<joint>_force` or `<joint>_force_x` and
/// `<joint>_moment_x`, as many as it has equations; energies; for an event on a condition `<event>_time`.
/// `energy_balance` is `E(t) − E(0) − drive_work − load_work − event_work + dissipated_energy`, the error of the run if it is audited.
pub struct Recording<'a> {
    crane: &'a dyn DynCrane,
    phases: Phases<'a>,
    extent: Extent,
    table: Table,
    energy_at_start: f64,
}

/// How much of a state is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extent {
    /// Everything.
    All,
    /// What peaks and cautions need: of the rates those of drives, no velocities of points, moments of elements or energies.
    Peaks,
}

impl<'a> Recording<'a> {
    /// A recording without samples.
    pub fn new(crane: &'a dyn DynCrane) -> Self {
        let columns = [
            quantities(crane.description(), crane.loop_joints()),
            audited(crane.description()),
            of_events(crane.description()),
        ]
        .concat();
        Self {
            crane,
            phases: Phases::new(crane),
            extent: Extent::All,
            table: Table { columns, rows: Vec::new() },
            energy_at_start: 0.0,
        }
    }

    /// A recording without samples, of only what peaks and cautions need.
    pub(crate) fn of_peaks(crane: &'a dyn DynCrane) -> Self {
        let mut columns = quantities_of(crane.description(), crane.loop_joints(), Extent::Peaks);
        columns.extend(of_events(crane.description()));
        Self {
            crane,
            phases: Phases::new(crane),
            extent: Extent::Peaks,
            table: Table { columns, rows: Vec::new() },
            energy_at_start: 0.0,
        }
    }

    /// Adds a sample.
    pub fn push(&mut self, sample: &Sample<'_>) {
        let exerted = Exerted::in_motion(self.phases.at(sample.t, sample.event_times), sample);
        self.push_exerted(sample, &exerted);
    }

    fn push_exerted(&mut self, sample: &Sample<'_>, exerted: &Exerted) {
        let &Sample { state, work, dissipated, load_work, event_work, event_times } = sample;
        let mut row = Vec::with_capacity(self.table.columns.len());
        let present = self.phases.at(state.t, event_times);
        let energies = push_quantities(present, self.extent, &state, exerted, &mut row);
        if let Some(energy) = energies.as_ref().map(Energies::total) {
            if self.table.rows.is_empty() {
                self.energy_at_start = energy;
            }
            row.extend([work, dissipated]);
            if !self.crane.description().loads.is_empty() {
                row.push(load_work);
            }
            if !self.crane.description().events.is_empty() {
                row.push(event_work);
            }
            row.push(energy - self.energy_at_start - work - load_work - event_work + dissipated);
        }
        let conditions =
            self.crane.description().conditions().zip(event_times.iter().copied().chain(iter::repeat(0.0)));
        row.extend(conditions.map(|(_, time)| time));
        self.table.rows.push(row);
    }

    /// Adds a pose at rest at a time, s, with the times of events on conditions.
    pub fn push_rest(&mut self, t: f64, q: &[f64], event_times: &[f64]) {
        let crane = self.phases.at(t, event_times);
        let (v, x) = (vec![0.0; q.len()], ForceStates::new(crane.description()).holding(crane, t, q));
        let exerted = Exerted::at_rest(crane, t, q);
        self.push_exerted(&Sample::new(StateAt { t, q, v: &v, x: &x }, event_times), &exerted);
    }

    /// The row of the last sample; empty without one.
    pub fn last(&self) -> &[f64] {
        self.table.rows.last().map_or(&[], Vec::as_slice)
    }

    /// The samples so far.
    pub fn into_table(self) -> Table {
        self.table
    }
}

/// Records the samples of a run of a fleet, for each crane what peaks and cautions need.
pub(crate) struct FleetRecording<'a> {
    fleet: &'a dyn Functions,
    /// The samples of all, row by row.
    numbers: Vec<f64>,
    /// Columns of a crane, and where each of those of every crane is in a row of all.
    columns: Vec<Column>,
    places: Vec<Vec<usize>>,
    width: usize,
}

impl<'a> FleetRecording<'a> {
    /// A recording without samples.
    pub fn new(fleet: &'a dyn Functions, crane: &dyn DynCrane) -> Self {
        let columns = quantities_of(crane.description(), crane.loop_joints(), Extent::Peaks);
        let of_all = quantities_of(fleet.description(), fleet.loop_joints(), Extent::Peaks);
        let width = of_all.len();
        // Columns of all cranes have the same names, those of the first crane first; the time is one for all.
        let mut named: HashMap<String, Vec<usize>> = HashMap::new();
        for (index, Column { name, .. }) in of_all.into_iter().enumerate() {
            named.entry(name).or_default().push(index);
        }
        let of_crane = |crane: usize| {
            let place = |column: &Column| named[&column.name].get(crane).copied().unwrap_or_default();
            columns.iter().map(place).collect()
        };
        let places = (0..fleet.cranes()).map(of_crane).collect();
        Self { fleet, numbers: Vec::new(), columns, places, width }
    }

    /// Adds a sample.
    pub fn push(&mut self, sample: &Sample<'_>) {
        let exerted = Exerted::in_motion(self.fleet, sample);
        push_quantities(self.fleet, Extent::Peaks, sample, &exerted, &mut self.numbers);
    }

    /// Number of cranes.
    pub fn cranes(&self) -> usize {
        self.places.len()
    }

    /// What `of_table` makes of the samples so far of each of the first cranes. One table holds them crane by crane: rows of their own for each would
    /// take longer than what is done with them.
    pub fn each<T>(&self, cranes: usize, mut of_table: impl FnMut(usize, &Table) -> T) -> Vec<T> {
        let rows = vec![vec![0.0; self.columns.len()]; self.numbers.len() / self.width];
        let mut table = Table { columns: self.columns.clone(), rows };
        let of_crane = |(crane, places): (usize, &Vec<usize>)| {
            for (row, of_all) in table.rows.iter_mut().zip(self.numbers.chunks_exact(self.width)) {
                row.iter_mut().zip(places).for_each(|(number, index)| *number = of_all[*index]);
            }
            of_table(crane, &table)
        };
        self.places.iter().take(cranes).enumerate().map(of_crane).collect()
    }
}

/// The quantities at a state of the crane and its oil: all columns of a [`Recording`] except those of its audit, in the order of
/// [`quantities`].
pub fn quantities_at(crane: &dyn DynCrane, moment: &StateAt<'_>) -> Vec<f64> {
    quantities_with(crane, moment, &[])
}

/// The quantities at a state, for conditions of events.
pub const QUANTITIES: Quantities = Quantities {
    names: |crane| {
        let columns = quantities(crane.description(), crane.loop_joints());
        columns.into_iter().map(|column| column.name).collect()
    },
    at: quantities_at,
};

/// The same with efforts in addition to those of the drives: what follows from accelerations does not contain them.
pub(crate) fn quantities_with(crane: &dyn DynCrane, moment: &StateAt<'_>, added: &[f64]) -> Vec<f64> {
    let (mut row, mut exerted) = (Vec::new(), Exerted::in_motion(crane, moment));
    exerted.efforts.iter_mut().zip(added).for_each(|(effort, added)| *effort += added);
    push_quantities(crane, Extent::All, moment, &exerted, &mut row);
    row
}

/// Torques and forces of the drives at a state of the crane and its forces, N m and N.
pub(crate) fn drive_efforts_with(crane: &dyn Functions, moment: &StateAt<'_>) -> Vec<f64> {
    let mut efforts = crane.open_drive_efforts_at(moment.t, moment.q, moment.v);
    force_states::add_to_rigid_drives(crane, moment, &mut efforts);
    if let Some(oil) = Oil::at(crane, moment) {
        oil.give_efforts(crane.description(), &mut efforts);
    }
    efforts
}

/// Energies at a state of the crane and its forces, with the springs of feet that have slid, J.
pub(crate) fn energies_with(crane: &dyn Functions, moment: &StateAt<'_>, slid: &Slid) -> Energies {
    let mut energies = crane.energies_at(moment.t, moment.q, moment.v);
    energies.supports += slid.energy;
    energies
}

/// What depends on whether motions of drives and winches go on: at rest they stand, and nothing resists their rates.
struct Exerted {
    /// Efforts of the drives.
    efforts: Vec<f64>,
    /// Rates of the drives' motions.
    rates: Vec<f64>,
    /// Tensions of the connectors.
    tensions: Vec<f64>,
    /// What the equations of loops transmit.
    multipliers: Vec<f64>,
}

impl Exerted {
    fn in_motion(crane: &dyn Functions, moment: &StateAt<'_>) -> Self {
        let &StateAt { t, q, v, .. } = moment;
        let has_loops = !crane.loop_joints().is_empty();
        Exerted {
            efforts: drive_efforts_with(crane, moment),
            rates: crane.drive_motions_at(t).into_iter().map(|[_, rate]| rate).collect(),
            tensions: crane.connector_tensions_at(t, q, v).into_iter().map(|tension| tension.force).collect(),
            multipliers: if has_loops {
                force_states::motion_at(crane, moment).multipliers().to_vec()
            } else {
                Vec::new()
            },
        }
    }

    fn at_rest(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Self {
        let positions = crane.drive_targets_at(t);
        Exerted {
            efforts: crane.drive_efforts_holding(t, &positions, q),
            rates: vec![0.0; positions.len()],
            tensions: crane.tensions_at_rest(t, q),
            multipliers: crane.loop_forces_holding(t, &positions, q),
        }
    }
}

/// Appends the quantities at a state to a row; returns the energies if they are recorded.
fn push_quantities(
    crane: &dyn Functions,
    extent: Extent,
    moment: &StateAt<'_>,
    Exerted { efforts, rates, tensions, multipliers }: &Exerted,
    row: &mut Vec<f64>,
) -> Option<Energies> {
    let all = extent == Extent::All;
    let &StateAt { t, q, v, x } = moment;
    row.push(t);
    row.extend_from_slice(q);
    if all {
        row.extend_from_slice(v);
    } else {
        row.extend(driven(crane.description()).map(|coordinate| v[coordinate]));
    }
    let oil = Oil::at(crane, moment);
    let motions = crane.drive_motions_at(t);
    for ([position, _], effort) in motions.iter().zip(efforts) {
        row.extend([position, effort]);
    }
    let mut cylinders = hydraulics::cylinders_at(crane, q, v, efforts);
    if let Some(oil) = &oil {
        oil.give_states(&mut cylinders);
    }
    row.extend(cylinders.iter().flat_map(cylinders::values));
    match &oil {
        Some(oil) => row.extend(oil.pump_and_spools()),
        None => row.extend(cylinders::pumps(crane, q, &cylinders, |drive| rates[drive])),
    }
    if all {
        for (position, velocity) in crane.points_at(q).iter().zip(crane.point_velocities_at(q, v)) {
            row.extend(position.iter().chain(&velocity));
        }
    } else {
        row.extend(crane.points_at(q).iter().flatten());
    }
    let slid = Slid::at(crane, moment);
    let mut reactions = crane.support_reactions_at(q, v);
    for (support, [x, y]) in &slid.forces {
        reactions[*support] += Vector3::new(*x, *y, 0.0);
    }
    row.extend(reactions.iter().flatten());
    let gaps = crane.support_gaps_at(q).into_iter().zip(&*crane.description().supports);
    row.extend(gaps.filter(|(_, support)| support.one_sided).map(|(gap, _)| gap));
    row.extend(&slid.places);
    if all {
        row.extend(crane.element_moments_at(q, v));
    }
    row.extend(crane.stop_efforts_at(q, v));
    let mut frictions = crane.friction_efforts_at(v);
    for (coordinate, effort) in bristles::efforts(crane.description(), v, x) {
        for (index, total) in frictions.iter_mut().enumerate() {
            *total += if crane.description().frictions[index] == coordinate { effort } else { 0.0 };
        }
    }
    row.extend(frictions);
    row.extend(&x[x.len().saturating_sub(crane.description().bristles.len())..]);
    for (length, tension) in crane.connector_lengths_at(q, v).into_iter().zip(tensions) {
        row.extend(length);
        row.push(*tension);
    }
    row.extend(multipliers);
    if !all {
        return None;
    }
    let energies = energies_with(crane, moment, &slid);
    row.extend(energies.parts(crane.description()).map(|(_, energy)| energy));
    Some(energies)
}

/// The driven coordinates, in the order of q.
fn driven(description: &Description) -> impl Iterator<Item = usize> {
    let is_driven = |coordinate: &usize| description.drives.iter().any(|drive| drive.coordinate == *coordinate);
    (0..description.coordinates.len()).filter(is_driven)
}

/// Names and units of the quantities at a state.
pub fn quantities(description: &Description, loop_joints: &[LoopJointInfo]) -> Vec<Column> {
    quantities_of(description, loop_joints, Extent::All)
}

fn quantities_of(description: &Description, loop_joints: &[LoopJointInfo], extent: Extent) -> Vec<Column> {
    let all = extent == Extent::All;
    let mut table = Table::default();
    table.add_of(ColumnKind::Time, "t", false);
    let is_driven =
        |name: &str| driven(description).any(|coordinate| *description.coordinates[coordinate].name == *name);
    let is_recorded = |column: &PartColumn<'_>| match column.kind {
        ColumnKind::Rate => all || is_driven(column.part),
        ColumnKind::PointVelocity | ColumnKind::ElementMoment => all,
        _ => true,
    };
    let columns = description.columns(loop_joints).into_iter().filter(is_recorded);
    table.columns.extend(columns.map(|PartColumn { name, unit, kind, .. }| Column {
        name,
        unit: unit.to_owned(),
        kind,
    }));
    if !all {
        return table.columns;
    }
    for (name, _) in Energies::default().parts(description) {
        table.add_of(ColumnKind::Energy, name, false);
    }
    table.columns
}

/// Names and units of the quantities that only a run has: work, dissipated energy and energy balance.
fn audited(description: &Description) -> Vec<Column> {
    let mut table = Table::default();
    table.add_of(ColumnKind::Work, "drive", false);
    table.add_of(ColumnKind::Dissipated, "dissipated", false);
    if !description.loads.is_empty() {
        table.add_of(ColumnKind::Work, "load", false);
    }
    if !description.events.is_empty() {
        table.add_of(ColumnKind::Work, "event", false);
    }
    table.add_of(ColumnKind::Balance, "energy", false);
    table.columns
}

/// Names and units of the times of events on conditions, which only a run has, too.
pub(super) fn of_events(description: &Description) -> Vec<Column> {
    let mut table = Table::default();
    for (event, _) in description.conditions() {
        table.add_of(ColumnKind::EventTime, &description.events[event].name, false);
    }
    table.columns
}

/// Name of the column with the gap under a one-sided support.
pub fn support_gap(support: &str) -> String {
    column_name(ColumnKind::Gap, support, false)
}

/// Name of the share of its friction that a one-sided support uses.
pub fn friction_utilisation(support: &str) -> String {
    format!("{support}_friction_utilisation")
}

/// Name of the column with the force or torque of a connector.
pub fn connector_force(connector: &ConnectorInfo) -> String {
    column_name(connector.effort(), &connector.name, connector.kind.turns())
}

/// Name of the column with the torque or force of a drive.
pub fn drive_effort(coordinate: &str, kind: CoordinateKind) -> String {
    column_name(ColumnKind::DriveEffort, coordinate, kind.turns())
}

/// Name of the column with the torque or force of a coordinate's end stops.
pub fn stop_effort(coordinate: &str, kind: CoordinateKind) -> String {
    column_name(ColumnKind::StopEffort, coordinate, kind.turns())
}
