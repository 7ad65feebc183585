//! Numbers in rows.

use crane_quantities::ColumnKind;

use crate::{
    Description, EventInfo, Moment,
    column::{Column, columns_of},
    dynamics::event_times,
};

/// Numbers in rows, one column per quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Names and units.
    pub columns: Vec<Column>,
    /// Rows as long as `columns`.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// Row and column of the first value that is not finite.
    pub fn not_finite(&self) -> Option<(usize, usize)> {
        self.rows.iter().enumerate().find_map(|(index, row)| Some((index, row.iter().position(|x| !x.is_finite())?)))
    }

    /// Adds a column that is none of a part's to a table without rows.
    pub fn add(&mut self, name: impl Into<String>, unit: impl Into<String>) {
        self.columns.push(Column::new(name, unit));
    }

    /// Adds the columns of one kind of a part to a table without rows.
    pub(crate) fn add_of(&mut self, kind: ColumnKind, part: &str, turns: bool) {
        self.columns.extend(columns_of(kind, part, turns));
    }

    /// The time that a number of its results stands for, s: at most the whole run.
    pub(super) fn time_of(&self, results: usize) -> f64 {
        let duration = self.rows.last().map_or(0.0, |row| row[0]);
        (results as f64 * duration / (self.rows.len().max(2) - 1) as f64).min(duration)
    }

    /// The largest force or moment of a run, N or N m, of all its columns.
    pub(super) fn largest_force(&self) -> f64 {
        let forces = self.columns.iter().enumerate().filter(|(_, column)| matches!(column.unit.as_str(), "N" | "N m"));
        let forces: Vec<usize> = forces.map(|(index, _)| index).collect();
        self.rows.iter().flat_map(|row| forces.iter().map(|&force| row[force].abs())).fold(0.0, f64::max)
    }

    /// The poses of a run: the columns after the time.
    pub(super) fn poses(&self, description: &Description) -> impl Iterator<Item = &[f64]> {
        let n = description.coordinates.len();
        self.rows.iter().filter_map(move |row| row.get(1..=n))
    }

    /// When the events of a crane happened in a run, s; `None` for those that did not.
    pub fn times_of_events(&self, description: &Description) -> Vec<Option<f64>> {
        let Some(last) = self.rows.last() else { return vec![None; description.events.len()] };
        let mut times = event_times(description, last).iter();
        let time = |event: &EventInfo| match event.moment {
            Moment::At(time) => (time <= last[0]).then_some(time),
            Moment::When(_) => times.next().copied().filter(|time| *time > 0.0),
        };
        description.events.iter().map(time).collect()
    }

    /// The values of a column by its name.
    pub fn values(&self, name: &str) -> Option<impl Iterator<Item = f64>> {
        let column = self.columns.iter().position(|column| column.name == name)?;
        Some(self.rows.iter().map(move |row| row[column]))
    }
}
