//! One crane of the page: what it is, how it is drawn, its run and its modes.

use std::borrow::Cow;

use crane_model::{
    CoordinateInfo, CoordinateRole, Description,
    dyn_crane::DynCrane,
    modes::{NoModes, Vibration, vibrations},
    results::{Column, Recording, Table},
    statics::Equilibrium,
};
use serde_json::{Value, json};

use crate::{
    Program, Subject,
    history::{Instant, instants},
    record::{entries, record},
    shapes::Figure,
    strength::{self, extremes, packed},
};

/// Maximum number of rows of a run in a page; a longer run is thinned, so that the page stays small enough to mail.
const MOST_ROWS: usize = 4000;

/// A crane with everything that a page shows of it.
pub(crate) struct Shown<'a> {
    pub subject: &'a Subject<'a>,
    /// Pose at rest.
    pub pose: Vec<f64>,
    /// Its run, or its single result at rest.
    pub table: Cow<'a, Table>,
    /// What it carries at each result.
    pub history: Vec<Instant>,
    /// Modes at rest, lowest first; none unless the pose is a stable equilibrium, or if they were not asked for.
    pub modes: Vec<Vibration>,
}

impl<'a> Shown<'a> {
    pub fn new(subject: &'a Subject<'a>) -> Result<Self, NoModes> {
        Ok(Self { modes: modes(subject)?, ..Self::without_modes(subject) })
    }

    /// The same without its modes, which take longer than everything else of a crane at rest.
    pub fn without_modes(subject: &'a Subject<'a>) -> Self {
        let &Subject { crane, equilibrium, run, .. } = subject;
        let pose = shown_pose(crane, equilibrium);
        let (table, history) = match run {
            Some((_, recorded)) => (Cow::Borrowed(&recorded.table), instants(crane, recorded.table.rows.iter())),
            None => (Cow::Owned(rest(crane, &pose)), vec![Instant::at_rest(crane, &pose)]),
        };
        Self { subject, pose, table, history, modes: Vec::new() }
    }

    /// Whether it moves.
    pub fn moves(&self) -> bool {
        self.subject.run.is_some()
    }

    /// A time of the run in words.
    pub fn when(&self, time: f64) -> String {
        if self.moves() { format!("at {time:.2} s") } else { "at rest".to_owned() }
    }

    /// Least and greatest value of each coordinate in its table.
    fn travels(&self) -> Vec<[f64; 2]> {
        let travel = |(coordinate, rest): (&CoordinateInfo, &f64)| {
            let column = self.table.columns.iter().position(|column| column.name == coordinate.name.as_str());
            let values = column.into_iter().flat_map(|column| self.table.rows.iter().map(move |row| row[column]));
            extremes(values.chain([*rest]))
        };
        self.subject.crane.description().coordinates.iter().zip(&self.pose).map(travel).collect()
    }

    /// All its data.
    pub fn data(&self, program: Program) -> Value {
        let &Subject { label, crane, live, run, .. } = self.subject;
        let description = crane.description();
        let coordinates: Vec<Value> = description
            .coordinates
            .iter()
            .map(|coordinate| {
                // A joint is drawn the same whether its drive is compliant or rigid.
                let role = match coordinate.role {
                    CoordinateRole::Prescribed => CoordinateRole::Driven,
                    role => role,
                };
                json!({
                    "name": coordinate.name.as_str(), "role": role.name(),
                    "unit": coordinate.kind.unit(), "force_unit": coordinate.kind.force_unit(),
                })
            })
            .collect();
        let every = self.table.rows.len().div_ceil(MOST_ROWS).max(1);
        json!({
            "name": description.name.as_str(),
            "title": description.title.as_str(),
            "label": label,
            "coordinates": coordinates,
            "drives": description.drives.iter().map(|drive| drive.coordinate).collect::<Vec<_>>(),
            "scene": Figure::moving(live, &self.pose, self.travels()).json(),
            "modes": modes_data(&self.modes, description),
            "run": columns(&self.table, every),
            "record": run.map(|(settings, recorded)| record(crane, settings, recorded, program)),
            "repeat": run.map(|(settings, recorded)| entries(crane, settings, recorded, program)),
            "strength": strength::data(crane, &self.history, every),
        })
    }
}

/// The pose at rest; without an equilibrium there is at least the guess to look at.
pub fn shown_pose(crane: &dyn DynCrane, equilibrium: &Equilibrium) -> Vec<f64> {
    let found = equilibrium.q.iter().all(|q| q.is_finite());
    if found { equilibrium.q.clone() } else { crane.guess() }
}

/// The single result of a crane at rest, with its drives at their start positions.
fn rest(crane: &dyn DynCrane, q: &[f64]) -> Table {
    let mut recording = Recording::new(crane);
    recording.push_rest(0.0, q, &[]);
    recording.into_table()
}

/// Modes of a stable equilibrium, each with the damping of the damped mode that moves in the same way.
pub(crate) fn modes(subject: &Subject<'_>) -> Result<Vec<Vibration>, NoModes> {
    if !subject.equilibrium.is_stable() {
        return Ok(Vec::new());
    }
    vibrations(&subject.crane.small_motions_at(&subject.equilibrium.q))
}

/// Modes for the page: frequency, Hz, damping ratio, shape in generalized coordinates.
pub(crate) fn modes_data(modes: &[Vibration], description: &Description) -> Value {
    let data = |vibration: &Vibration| {
        let mode = &vibration.mode;
        let names: Vec<&str> =
            mode.dominating.iter().map(|&index| description.coordinates[index].name.as_str()).collect();
        json!({
            "frequency": mode.frequency(), "damping": vibration.damping_ratio(), "shape": mode.shape.as_slice(), "moves": names,
        })
    };
    modes.iter().map(data).collect()
}

/// Names, units and values of every `every`-th row, column by column; the extremes are those of all rows.
fn columns(table: &Table, every: usize) -> Value {
    let rows: Vec<&Vec<f64>> = table.rows.iter().step_by(every).collect();
    let numbers = (0..table.columns.len()).flat_map(|column| rows.iter().map(move |row| row[column]));
    let described = |(index, column): (usize, &Column)| {
        let [least, most] = extremes(table.rows.iter().map(|row| row[index]));
        json!({"name": column.name, "unit": column.unit, "part": column.part(), "kind": column.kind.name(), "least": least, "most": most})
    };
    let columns: Vec<Value> = table.columns.iter().enumerate().map(described).collect();
    json!({"columns": columns, "rows": rows.len(), "every": every, "data": packed(numbers)})
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A page that leaves out rows still knows the extremes of all.
    #[test]
    fn a_thinned_run_keeps_its_extremes() {
        let mut table = Table::default();
        table.add("t", "s");
        table.add("x", "m");
        table.rows = (0..7_i32).map(f64::from).map(|t| vec![t, if t == 4.0 { 9.0 } else { t }]).collect();
        let written = columns(&table, 3);
        assert_eq!((&written["rows"], &written["every"]), (&json!(3), &json!(3)));
        assert_eq!(
            written["columns"][1],
            json!({"name": "x", "unit": "m", "part": "x", "kind": "other", "least": 0.0, "most": 9.0})
        );
        assert_eq!(extremes([f64::NAN, 2.0, f64::NAN, -1.0].into_iter()), [-1.0, 2.0]);
    }
}
