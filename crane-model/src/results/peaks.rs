//! The extremes and final values of a run.

use super::{Column, Extremes, Table, connector_force, cylinders, drive_effort, stop_effort, support_gap};
use crate::Description;

/// Signed extremes with their times, and final values, over the samples of a run.
///
/// Columns, each with `_min`, `_min_time`, `_max`, `_max_time`: for a point `<point>_x`, `_y`, `_z`; for a drive
/// `<coordinate>_drive_torque` or `_drive_force`; for a support `<support>_reaction_x`, `_y`, `_z`, and `<support>_gap` if it is one-sided;
/// for a cylinder `<cylinder>_length`, `_speed`, `_force`, `_piston_pressure`, `_rod_pressure` and `_flow`, for all cylinders `pump_flow`
/// and `pump_power`, with valves `pump_pressure`; for end stops `<coordinate>_stop_torque` or `_stop_force`; for a connector
/// `<connector>_force` or `_torque`. Finally `_end` of every coordinate of every point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Peaks {
    extremes: Vec<Extremes>,
    last: Vec<f64>,
}

impl Peaks {
    /// Names and units of [`Peaks::values`].
    pub fn columns(description: &Description) -> Vec<Column> {
        let mut table = Table::default();
        for Column { name, unit } in tracked(description) {
            for (what, unit) in [("min", unit.as_str()), ("min_time", "s"), ("max", unit.as_str()), ("max_time", "s")] {
                table.add(format!("{name}_{what}"), unit);
            }
        }
        places(description).for_each(|point| table.add(format!("{point}_end"), "m"));
        table.columns
    }

    /// Of the table of a run.
    pub(crate) fn of(description: &Description, table: &Table) -> Self {
        let last = |name: &str| table.values(name).and_then(Iterator::last).unwrap_or(f64::NAN);
        Self {
            extremes: Extremes::of_all(table, tracked(description).iter().map(|column| column.name.as_str())),
            last: places(description).map(|point| last(&point)).collect(),
        }
    }

    /// Values in the order of [`Peaks::columns`]; none without samples.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let extremes = self.extremes.iter();
        let extremes = extremes.flat_map(|e| [e.minimum, e.time_of_minimum, e.maximum, e.time_of_maximum]);
        extremes.chain(self.last.iter().copied())
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// Coordinates of points.
fn places(description: &Description) -> impl Iterator<Item = String> {
    description.points.iter().flat_map(|point| AXES.map(|axis| format!("{point}_{axis}")))
}

/// The columns of a run whose extremes are kept.
fn tracked(description: &Description) -> Vec<Column> {
    let mut table = Table::default();
    places(description).for_each(|name| table.add(name, "m"));
    for drive in &description.drives {
        let coordinate = &description.coordinates[drive.coordinate];
        table.add(drive_effort(&coordinate.name, coordinate.kind), coordinate.kind.force_unit());
    }
    for support in &description.supports {
        for axis in AXES {
            table.add(format!("{}_reaction_{axis}", support.name), "N");
        }
    }
    for support in description.supports.iter().filter(|support| support.one_sided) {
        table.add(support_gap(&support.name), "m");
    }
    cylinders::add_columns(description, &mut table);
    for &coordinate in &description.stops {
        let coordinate = &description.coordinates[coordinate];
        table.add(stop_effort(&coordinate.name, coordinate.kind), coordinate.kind.force_unit());
    }
    for connector in &description.connectors {
        table.add(connector_force(connector), connector.kind.force_unit());
    }
    table.columns
}
