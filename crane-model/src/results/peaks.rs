//! What is left of a run when only the greatest and the last values are of interest.

use crate::{
    Description,
    dyn_crane::DynCrane,
    dynamics::Sample,
    results::{Column, Table, drive_effort},
};

/// Greatest and last values over the samples of a run.
///
/// Columns: of a point `<point>_x_max`, `_y_max`, `_z_max` and `<point>_x_end`, `_y_end`, `_z_end`; of a drive
/// `<coordinate>_drive_torque_peak` or `_drive_force_peak`; of a support `<support>_reaction_x_peak`, `_y_peak`, `_z_peak`. A
/// maximum is signed, a peak is the greatest size.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Peaks {
    highest: Vec<f64>,
    last: Vec<f64>,
    largest: Vec<f64>,
}

impl Peaks {
    /// Names and units of [`Peaks::values`].
    pub fn columns(description: &Description) -> Vec<Column> {
        const AXES: [&str; 3] = ["x", "y", "z"];
        let mut table = Table::default();
        for what in ["max", "end"] {
            for point in &description.points {
                for axis in AXES {
                    table.add(format!("{point}_{axis}_{what}"), "m");
                }
            }
        }
        for drive in &description.drives {
            let coordinate = &description.coordinates[drive.coordinate];
            let effort = drive_effort(&coordinate.name, coordinate.kind);
            table.add(format!("{effort}_peak"), coordinate.kind.force_unit());
        }
        for support in &description.supports {
            for axis in AXES {
                table.add(format!("{}_reaction_{axis}_peak", support.name), "N");
            }
        }
        table.columns
    }

    /// Adds a sample of the run of `crane`.
    pub fn push(&mut self, crane: &dyn DynCrane, sample: &Sample<'_>) {
        let &Sample { t, q, v, .. } = sample;
        self.last.clear();
        self.last.extend(crane.points_at(q).iter().flatten());
        let reactions = crane.support_reactions_at(q, v);
        let forces = crane.drive_efforts_at(t, q, v).into_iter().chain(reactions.iter().flatten().copied());
        raise(&mut self.highest, self.last.iter().copied());
        raise(&mut self.largest, forces.map(f64::abs));
    }

    /// Values in the order of [`Peaks::columns`]; none without samples.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.highest.iter().chain(&self.last).chain(&self.largest).copied()
    }
}

/// Raises every number of `greatest` to that of `values`.
fn raise(greatest: &mut Vec<f64>, values: impl Iterator<Item = f64>) {
    for (index, value) in values.enumerate() {
        match greatest.get_mut(index) {
            Some(greatest) => *greatest = greatest.max(value),
            None => greatest.push(value),
        }
    }
}
