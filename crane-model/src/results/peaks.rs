//! The extremes and final values of a run.

use crate::{
    Description,
    dyn_crane::DynCrane,
    dynamics::Sample,
    results::{Column, Extremes, Table, drive_effort},
};

/// Signed extremes with their times, and final values, over the samples of a run.
///
/// Columns, `_min`, `_min_time`, `_max`, `_max_time` of each: of a point `<point>_x`, `_y`, `_z`; of a drive
/// `<coordinate>_drive_torque` or `_drive_force`; of a support `<support>_reaction_x`, `_y`, `_z`. Finally `_end` of every
/// coordinate of every point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Peaks {
    extremes: Vec<Extremes>,
    last: Vec<f64>,
}

impl Peaks {
    /// Names and units of [`Peaks::values`].
    pub fn columns(description: &Description) -> Vec<Column> {
        const AXES: [&str; 3] = ["x", "y", "z"];
        let mut table = Table::default();
        let mut add = |name: String, unit: &'static str| {
            for (what, unit) in [("min", unit), ("min_time", "s"), ("max", unit), ("max_time", "s")] {
                table.add(format!("{name}_{what}"), unit);
            }
        };
        let places = || description.points.iter().flat_map(|point| AXES.map(|axis| format!("{point}_{axis}")));
        places().for_each(|place| add(place, "m"));
        for drive in &description.drives {
            let coordinate = &description.coordinates[drive.coordinate];
            add(drive_effort(&coordinate.name, coordinate.kind), coordinate.kind.force_unit());
        }
        for support in &description.supports {
            for axis in AXES {
                add(format!("{}_reaction_{axis}", support.name), "N");
            }
        }
        places().for_each(|place| table.add(format!("{place}_end"), "m"));
        table.columns
    }

    /// Adds a sample of the run of `crane`.
    pub fn push(&mut self, crane: &dyn DynCrane, sample: &Sample<'_>) {
        let &Sample { t, q, v, .. } = sample;
        self.last.clear();
        self.last.extend(crane.points_at(q).iter().flatten());
        let reactions = crane.support_reactions_at(q, v);
        let efforts = crane.drive_efforts_of(sample);
        let values = self.last.iter().copied().chain(efforts).chain(reactions.iter().flatten().copied());
        for (index, value) in values.enumerate() {
            match self.extremes.get_mut(index) {
                Some(extremes) => extremes.widen(t, value),
                None => self.extremes.push(Extremes::at(t, value)),
            }
        }
    }

    /// Values in the order of [`Peaks::columns`]; none without samples.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let extremes = self.extremes.iter();
        let extremes = extremes.flat_map(|e| [e.minimum, e.time_of_minimum, e.maximum, e.time_of_maximum]);
        extremes.chain(self.last.iter().copied())
    }
}
