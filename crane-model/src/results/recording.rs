//! Recording of a run in columns.

use std::collections::HashMap;

use nalgebra::Vector3;

use crate::{
    ConnectorInfo, CoordinateKind, Description, LoopJointInfo, bristles,
    dyn_crane::{DynCrane, Energies},
    dynamics::Sample,
    feet::{self, Slid},
    force_states,
    hydraulics::{self, Oil},
    results::{Column, Table, cylinders},
    stateful_force::StateAt,
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
/// `<joint>_moment_x`, as many as it has equations; energies.
/// `energy_balance` is `E(t) − E(0) − drive_work − load_work + dissipated_energy`, the error of the run if it is audited.
pub struct Recording<'a> {
    crane: &'a dyn DynCrane,
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
        let columns = [quantities(crane.description(), crane.loop_joints()), audited(crane.description())].concat();
        Self { crane, extent: Extent::All, table: Table { columns, rows: Vec::new() }, energy_at_start: 0.0 }
    }

    /// A recording without samples, of only what peaks and cautions need.
    pub(crate) fn of_peaks(crane: &'a dyn DynCrane) -> Self {
        let columns = quantities_of(crane.description(), crane.loop_joints(), Extent::Peaks);
        Self { crane, extent: Extent::Peaks, table: Table { columns, rows: Vec::new() }, energy_at_start: 0.0 }
    }

    /// Adds a sample.
    pub fn push(&mut self, sample: &Sample<'_>) {
        let &Sample { t, q, v, x, work, dissipated, load_work } = sample;
        let mut row = Vec::with_capacity(self.table.columns.len());
        let energies = push_quantities(self.crane, self.extent, &StateAt { t, q, v, x }, &[], &mut row);
        if let Some(energy) = energies.as_ref().map(Energies::total) {
            if self.table.rows.is_empty() {
                self.energy_at_start = energy;
            }
            row.extend([work, dissipated]);
            if !self.crane.description().loads.is_empty() {
                row.push(load_work);
            }
            row.push(energy - self.energy_at_start - work - load_work + dissipated);
        }
        self.table.rows.push(row);
    }

    /// The samples so far.
    pub fn into_table(self) -> Table {
        self.table
    }
}

/// Records the samples of a run of a fleet, for each crane what peaks and cautions need.
pub(crate) struct FleetRecording<'a> {
    fleet: &'a dyn DynCrane,
    /// The samples of all, row by row.
    numbers: Vec<f64>,
    /// Columns of a crane, and where each of those of every crane is in a row of all.
    columns: Vec<Column>,
    places: Vec<Vec<usize>>,
    width: usize,
}

impl<'a> FleetRecording<'a> {
    /// A recording without samples.
    pub fn new(fleet: &'a dyn DynCrane, crane: &dyn DynCrane) -> Self {
        let columns = quantities_of(crane.description(), crane.loop_joints(), Extent::Peaks);
        let of_all = quantities_of(fleet.description(), fleet.loop_joints(), Extent::Peaks);
        let width = of_all.len();
        // Columns of all cranes have the same names, those of the first crane first; the time is one for all.
        let mut named: HashMap<String, Vec<usize>> = HashMap::new();
        for (place, Column { name, .. }) in of_all.into_iter().enumerate() {
            named.entry(name).or_default().push(place);
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
        let &Sample { t, q, v, x, .. } = sample;
        push_quantities(self.fleet, Extent::Peaks, &StateAt { t, q, v, x }, &[], &mut self.numbers);
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
                row.iter_mut().zip(places).for_each(|(number, place)| *number = of_all[*place]);
            }
            of_table(crane, &table)
        };
        self.places.iter().take(cranes).enumerate().map(of_crane).collect()
    }
}

/// The quantities at a state of the crane and its oil: all columns of a [`Recording`] except those of its audit, in the order of
/// [`quantities`].
pub fn quantities_at(crane: &dyn DynCrane, t: f64, (q, v): (&[f64], &[f64]), x: &[f64]) -> Vec<f64> {
    let mut row = Vec::new();
    push_quantities(crane, Extent::All, &StateAt { t, q, v, x }, &[], &mut row);
    row
}

/// The same with efforts in addition to those of the drives: what follows from accelerations does not contain them.
pub(crate) fn quantities_with(crane: &dyn DynCrane, moment: &StateAt<'_>, added: &[f64]) -> Vec<f64> {
    let mut row = Vec::new();
    push_quantities(crane, Extent::All, moment, added, &mut row);
    row
}

/// Appends the quantities at a state to a row, with efforts added to those of the first drives; returns the energies if they are recorded.
fn push_quantities(
    crane: &dyn DynCrane,
    extent: Extent,
    moment: &StateAt<'_>,
    added: &[f64],
    row: &mut Vec<f64>,
) -> Option<Energies> {
    let all = extent == Extent::All;
    let &StateAt { t, q, v, x } = moment;
    row.push(t);
    row.extend_from_slice(q);
    if all {
        row.extend_from_slice(v);
    } else {
        row.extend(crane.description().drives.iter().map(|drive| v[drive.coordinate]));
    }
    let mut efforts = crane.drive_efforts_with(moment);
    efforts.iter_mut().zip(added).for_each(|(effort, added)| *effort += added);
    let oil = Oil::at(crane, moment);
    let motions = crane.drive_motions_at(t);
    for ([position, _], effort) in motions.iter().zip(&efforts) {
        row.extend([position, effort]);
    }
    let mut cylinders = hydraulics::cylinders_at(crane, q, v, &efforts);
    if let Some(oil) = &oil {
        oil.give_states(&mut cylinders);
    }
    row.extend(cylinders.iter().flat_map(cylinders::values));
    match &oil {
        Some(oil) => row.extend(oil.pump_and_spools()),
        None => row.extend(cylinders::pumps(crane, q, &cylinders, |drive| motions[drive][1])),
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
    for (length, tension) in crane.connector_lengths_at(q, v).into_iter().zip(crane.connector_tensions_at(t, q, v)) {
        row.extend(length);
        row.push(tension.force);
    }
    if !crane.loop_joints().is_empty() {
        row.extend(force_states::motion_at(crane, moment).multipliers());
    }
    if !all {
        return None;
    }
    let energies = crane.energies_with(moment, &slid);
    row.extend(energies.parts(crane.description()).map(|(_, energy)| energy));
    Some(energies)
}

/// Names and units of the quantities at a state.
pub fn quantities(description: &Description, loop_joints: &[LoopJointInfo]) -> Vec<Column> {
    quantities_of(description, loop_joints, Extent::All)
}

fn quantities_of(description: &Description, loop_joints: &[LoopJointInfo], extent: Extent) -> Vec<Column> {
    let all = extent == Extent::All;
    let mut table = Table::default();
    table.add("t", "s");
    for coordinate in &description.coordinates {
        table.add(coordinate.name.as_str(), coordinate.kind.unit());
    }
    let of_drives = description.drives.iter().map(|drive| drive.coordinate);
    let rates: Vec<usize> = if all { (0..description.coordinates.len()).collect() } else { of_drives.collect() };
    for coordinate in rates.into_iter().map(|index| &description.coordinates[index]) {
        table.add(format!("{}_rate", coordinate.name), format!("{}/s", coordinate.kind.unit()));
    }
    for drive in &description.drives {
        let coordinate = &description.coordinates[drive.coordinate];
        table.add(format!("{}_prescribed", coordinate.name), coordinate.kind.unit());
        table.add(drive_effort(&coordinate.name, coordinate.kind), coordinate.kind.force_unit());
    }
    cylinders::add_columns(description, &mut table);
    for point in &description.points {
        for axis in ["x", "y", "z"] {
            table.add(format!("{point}_{axis}"), "m");
        }
        for axis in ["x", "y", "z"].into_iter().filter(|_| all) {
            table.add(format!("{point}_v{axis}"), "m/s");
        }
    }
    for support in &description.supports {
        for axis in ["x", "y", "z"] {
            table.add(format!("{}_reaction_{axis}", support.name), "N");
        }
    }
    for support in description.supports.iter().filter(|support| support.one_sided) {
        table.add(support_gap(&support.name), "m");
    }
    let feet = description.supports.iter().filter(|support| support.one_sided);
    for column in feet::columns(feet.map(|support| support.name.as_str())) {
        table.add(column, "m");
    }
    for coordinate in description.coordinates.iter().filter(|coordinate| all && coordinate.role.is_element()) {
        table.add(format!("{}_moment", coordinate.name), coordinate.kind.force_unit());
    }
    for (coordinates, what) in [(&description.stops, "stop"), (&description.frictions, "friction")] {
        for &coordinate in coordinates {
            let coordinate = &description.coordinates[coordinate];
            table.add(effort(&coordinate.name, what, coordinate.kind), coordinate.kind.force_unit());
        }
    }
    for joint in &description.bristles {
        let coordinate = &description.coordinates[joint.coordinate];
        table.add(bristles::column(&coordinate.name), coordinate.kind.unit());
    }
    for connector in &description.connectors {
        let (what, unit) = (connector.length_name(), connector.kind.unit());
        table.add(format!("{}_{what}", connector.name), unit);
        table.add(format!("{}_{what}_rate", connector.name), format!("{unit}/s"));
        table.add(connector_force(connector), connector.kind.force_unit());
    }
    for joint in loop_joints {
        for equation in &joint.equations {
            table.add(equation.column(&joint.name), equation.force_unit());
        }
    }
    if !all {
        return table.columns;
    }
    for (name, _) in Energies::default().parts(description) {
        table.add(format!("{name}_energy"), "J");
    }
    table.columns
}

/// Names and units of the quantities that only a run has: work, dissipated energy and energy balance.
fn audited(description: &Description) -> Vec<Column> {
    let load_work = (!description.loads.is_empty()).then_some("load_work");
    let names = ["drive_work", "dissipated_energy"].into_iter().chain(load_work).chain(["energy_balance"]);
    names.map(|energy| Column { name: energy.to_owned(), unit: "J".to_owned() }).collect()
}

/// Name of the column with the gap under a one-sided support.
pub fn support_gap(support: &str) -> String {
    format!("{support}_gap")
}

/// Name of the column with the force or torque of a connector.
pub fn connector_force(connector: &ConnectorInfo) -> String {
    match connector.kind {
        CoordinateKind::Rotation if connector.is_pin() => format!("{}_friction_torque", connector.name),
        CoordinateKind::Translation => format!("{}_force", connector.name),
        CoordinateKind::Rotation => format!("{}_torque", connector.name),
    }
}

/// Name of the column with the torque or force of a drive.
pub fn drive_effort(coordinate: &str, kind: CoordinateKind) -> String {
    effort(coordinate, "drive", kind)
}

/// Name of the column with the torque or force of a coordinate's end stops.
pub fn stop_effort(coordinate: &str, kind: CoordinateKind) -> String {
    effort(coordinate, "stop", kind)
}

/// Name of the column with the torque or force of what acts on a coordinate.
fn effort(coordinate: &str, of: &str, kind: CoordinateKind) -> String {
    match kind {
        CoordinateKind::Translation => format!("{coordinate}_{of}_force"),
        CoordinateKind::Rotation => format!("{coordinate}_{of}_torque"),
    }
}
