//! The extremes and final values of a run.

use crane_quantities::{ColumnKind, END, PEAKS};

use super::{
    Column, Extremes, Table,
    recording::{of_events, quantities},
};
use crate::{Description, column::columns_of, dyn_crane::DynCrane};

/// Signed extremes with their times, and final values, over the samples of a run.
///
/// Columns, each with `_min`, `_min_time`, `_max`, `_max_time`: those of a run that [have peaks](ColumnKind::has_peaks), in the order of a run:
/// efforts of drives, all of cylinders and pump, points, supports, stops, what connectors and joints that close loops transmit. Finally
/// `_end` of every coordinate of every point, and the times of events on conditions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Peaks {
    extremes: Vec<Extremes>,
    last: Vec<f64>,
}

impl Peaks {
    /// Names and units of [`Peaks::values`].
    pub fn columns(crane: &dyn DynCrane) -> Vec<Column> {
        let mut table = Table::default();
        let all = quantities(crane.description(), crane.loop_joints());
        for Column { name, unit, .. } in all.into_iter().filter(|column| column.kind.has_peaks()) {
            for (what, unit) in PEAKS.into_iter().zip([unit.as_str(), "s", unit.as_str(), "s"]) {
                table.add(format!("{name}{what}"), unit);
            }
        }
        places(crane.description()).for_each(|point| table.add(point + END, "m"));
        table.columns.extend(of_events(crane.description()));
        table.columns
    }

    /// Of the table of a run.
    pub(crate) fn new(description: &Description, table: &Table) -> Self {
        let tracked = table.columns.iter().filter(|column| column.kind.has_peaks());
        let last = |name: &str| table.values(name).and_then(Iterator::last).unwrap_or(f64::NAN);
        let events = of_events(description).into_iter().map(|column| column.name);
        Self {
            extremes: Extremes::of_all(table, tracked.map(|column| column.name.as_str())),
            last: places(description).chain(events).map(|column| last(&column)).collect(),
        }
    }

    /// Values in the order of [`Peaks::columns`]; none without samples.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let extremes = self.extremes.iter();
        let extremes = extremes.flat_map(|e| [e.minimum, e.time_of_minimum, e.maximum, e.time_of_maximum]);
        extremes.chain(self.last.iter().copied())
    }
}

/// Coordinates of points.
fn places(description: &Description) -> impl Iterator<Item = String> {
    description
        .points
        .iter()
        .flat_map(|point| columns_of(ColumnKind::PointPosition, point, false))
        .map(|column| column.name)
}
