//! Least and greatest values of a run, when they occur, and how far off they may be.

use crane_model::{
    Description,
    results::{Table, drive_effort},
};

use crate::{
    report::{Cell, Grid},
    run::Recorded,
};

/// Least and greatest value of a column, and when they occur first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extremes {
    /// Least value.
    pub minimum: f64,
    /// When, s.
    pub time_of_minimum: f64,
    /// Greatest value.
    pub maximum: f64,
    /// When, s.
    pub time_of_maximum: f64,
}

impl Extremes {
    /// Of the column of this name; zeros where there is none.
    pub fn of(table: &Table, name: &str) -> Self {
        let Some(values) = table.values(name) else { return Self::default() };
        let mut times = table.rows.iter().map(|row| row[0]).zip(values);
        let Some((t, first)) = times.next() else { return Self::default() };
        let mut found = Self { minimum: first, time_of_minimum: t, maximum: first, time_of_maximum: t };
        for (t, value) in times {
            if value < found.minimum {
                (found.minimum, found.time_of_minimum) = (value, t);
            }
            if value > found.maximum {
                (found.maximum, found.time_of_maximum) = (value, t);
            }
        }
        found
    }

    /// The greatest size.
    pub fn size(&self) -> f64 {
        self.minimum.abs().max(self.maximum.abs())
    }
}

/// What the size of a quantity is, against which its error counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Size {
    /// The greatest value.
    Peak,
    /// The way from the least to the greatest value.
    Range,
}

/// Columns of one kind, whose sizes compare.
pub struct Kind {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Their unit.
    pub unit: &'static str,
    /// What their error is measured by, in words.
    pub measure: &'static str,
    size: Size,
}

impl Kind {
    fn new(names: Vec<String>, unit: &'static str, size: Size) -> Self {
        let measure = match size {
            Size::Peak => "peak",
            Size::Range => "range",
        };
        Self { names, unit, measure, size }
    }

    /// Size of a quantity.
    pub fn size(&self, extremes: &Extremes) -> f64 {
        match self.size {
            Size::Peak => extremes.size(),
            Size::Range => extremes.maximum - extremes.minimum,
        }
    }

    /// Below this a difference is rounding or a motion too small to matter: a micrometre of a crane of some metres.
    pub fn noise(&self, table: &Table, name: &str) -> f64 {
        /// Part of the greatest value.
        const NOISE: f64 = 1e-6;
        match self.size {
            Size::Peak => 0.0,
            Size::Range => NOISE * Extremes::of(table, name).size(),
        }
    }
}

/// The columns that are headlines of a run: efforts of the drives, paths of the points, vertical forces of the supports.
pub fn columns(description: &Description) -> Vec<Kind> {
    let efforts = |unit: &str| -> Vec<String> {
        let coordinates = description.drives.iter().map(|drive| &description.coordinates[drive.coordinate]);
        let of_unit = coordinates.filter(|coordinate| coordinate.kind.force_unit() == unit);
        of_unit.map(|coordinate| drive_effort(&coordinate.name, coordinate.kind)).collect()
    };
    let each_axis =
        |name: String| ["x", "y", "z"].map(|axis| format!("{name}_{axis}")).into_iter().collect::<Vec<String>>();
    let points = description.points.iter().flat_map(|point| each_axis(point.to_string())).collect();
    let supports = description.supports.iter().map(|support| format!("{}_reaction_z", support.name));
    vec![
        Kind::new(efforts("N m"), "N m", Size::Peak),
        Kind::new(efforts("N"), "N", Size::Peak),
        Kind::new(points, "m", Size::Range),
        Kind::new(supports.collect(), "N", Size::Peak),
    ]
}

/// A time without the rounding of its sum: 2.28 instead of 2.2800000000000002.
fn instant(time: f64) -> f64 {
    format!("{time:.9}").parse().unwrap_or(time)
}

/// Extremes of all headlines of some runs, a row per quantity and run.
pub fn extremes(description: &Description, runs: &[(&str, &Recorded)]) -> Grid {
    let headers = ["quantity", "crane", "minimum", "time of minimum", "maximum", "time of maximum", "error", "unit"];
    let alone = runs.len() < 2;
    let headers: Vec<&str> = headers.into_iter().filter(|header| !alone || *header != "crane").collect();
    let title = "Extremes of the run, their times in s, and the greatest difference from a finer run";
    let mut grid = Grid::new("extremes", title, &headers);
    for kind in columns(description) {
        for name in &kind.names {
            for (label, run) in runs {
                if run.table.values(name).is_none() {
                    continue;
                }
                let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } = Extremes::of(&run.table, name);
                let error = run.verification.as_ref().and_then(|v| v.difference(&run.table, name));
                let numbers = [minimum, instant(time_of_minimum), maximum, instant(time_of_maximum)].map(Cell::from);
                let crane = (!alone).then(|| Cell::from(*label));
                let row = [Cell::from(name.as_str())].into_iter().chain(crane).chain(numbers);
                grid.row(
                    row.chain([error.map_or(Cell::Empty, Cell::Uncertainty), kind.unit.into()]).collect::<Vec<_>>(),
                );
            }
        }
    }
    grid
}
