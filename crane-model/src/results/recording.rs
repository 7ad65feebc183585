//! Everything of a run that is worth a column.

use crate::{CoordinateKind, Description, dyn_crane::DynCrane, dynamics::Sample, results::Table};

/// Records the samples of a run of a crane.
///
/// Columns: `t`; `<coordinate>` and `<coordinate>_rate`; of a drive `<coordinate>_prescribed` and
/// `<coordinate>_drive_torque` or `_drive_force`; of a point `<point>_x`, `_y`, `_z` and `_vx`, `_vy`, `_vz`; of a support
/// `<support>_reaction_x`, `_y`, `_z`; of a coordinate of an element `<coordinate>_moment`; energies. `energy_balance` is `E(t) − E(0) − drive_work + dissipated_energy`, the
/// error of the run if it is audited.
pub struct Recording<'a> {
    crane: &'a dyn DynCrane,
    table: Table,
    energy_at_start: f64,
}

impl<'a> Recording<'a> {
    /// No samples yet.
    pub fn new(crane: &'a dyn DynCrane) -> Self {
        Self {
            crane,
            table: Table { columns: columns(crane.description()).columns, rows: Vec::new() },
            energy_at_start: 0.0,
        }
    }

    /// Adds a sample.
    pub fn push(&mut self, sample: &Sample<'_>) {
        let &Sample { t, q, v, work, dissipated } = sample;
        let crane = self.crane;
        let energies = crane.energies_at(t, q, v);
        if self.table.rows.is_empty() {
            self.energy_at_start = energies.total();
        }
        let mut row = Vec::with_capacity(self.table.columns.len());
        row.push(t);
        row.extend_from_slice(q);
        row.extend_from_slice(v);
        for ([position, _], effort) in crane.drive_motions_at(t).into_iter().zip(crane.drive_efforts_at(t, q, v)) {
            row.extend([position, effort]);
        }
        for (position, velocity) in crane.points_at(q).iter().zip(crane.point_velocities_at(q, v)) {
            row.extend(position.iter().chain(&velocity));
        }
        for reaction in crane.support_reactions_at(q, v) {
            row.extend(&reaction);
        }
        row.extend(crane.element_moments_at(q, v));
        row.extend([energies.kinetic, energies.gravity, energies.supports, energies.elements, energies.drives]);
        row.extend([work, dissipated, energies.total() - self.energy_at_start - work + dissipated]);
        self.table.rows.push(row);
    }

    /// The samples so far.
    pub fn into_table(self) -> Table {
        self.table
    }
}

fn columns(description: &Description) -> Table {
    let mut table = Table::default();
    table.add("t", "s");
    for coordinate in &description.coordinates {
        table.add(coordinate.name.as_str(), coordinate.kind.unit());
    }
    for coordinate in &description.coordinates {
        table.add(format!("{}_rate", coordinate.name), format!("{}/s", coordinate.kind.unit()));
    }
    for drive in &description.drives {
        let coordinate = &description.coordinates[drive.coordinate];
        table.add(format!("{}_prescribed", coordinate.name), coordinate.kind.unit());
        table.add(drive_effort(&coordinate.name, coordinate.kind), coordinate.kind.force_unit());
    }
    for point in &description.points {
        for axis in ["x", "y", "z"] {
            table.add(format!("{point}_{axis}"), "m");
        }
        for axis in ["x", "y", "z"] {
            table.add(format!("{point}_v{axis}"), "m/s");
        }
    }
    for support in &description.supports {
        for axis in ["x", "y", "z"] {
            table.add(format!("{}_reaction_{axis}", support.name), "N");
        }
    }
    for coordinate in description.coordinates.iter().filter(|coordinate| coordinate.role.is_element()) {
        table.add(format!("{}_moment", coordinate.name), coordinate.kind.force_unit());
    }
    for energy in ["kinetic", "gravity", "support", "element", "drive"] {
        table.add(format!("{energy}_energy"), "J");
    }
    for energy in ["drive_work", "dissipated_energy", "energy_balance"] {
        table.add(energy, "J");
    }
    table
}

/// Name of the column with the torque or force of a drive.
pub fn drive_effort(coordinate: &str, kind: CoordinateKind) -> String {
    match kind {
        CoordinateKind::Translation => format!("{coordinate}_drive_force"),
        CoordinateKind::Rotation => format!("{coordinate}_drive_torque"),
    }
}
