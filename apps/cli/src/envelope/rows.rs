//! The rating of every pose as a row of numbers.

use std::path::Path;

use crane_live::Reach;
use crane_model::{
    Description,
    dyn_crane::DynCrane,
    envelope::{Condition, Envelope, Limit, Rating, Varied},
    results::{Column, KeyFigure, drive_effort},
};
use crane_page::tables::number_text;

use super::reach::header_with_reach;
use crate::{
    npz::{Array, npz},
    problem::{Outcome, Problem},
    screen::Console,
};

/// The rating of a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartRow {
    /// One per column of the layout; NaN where there is none.
    pub numbers: Vec<f64>,
    /// Kind of the governing limit, and what it is a limit of; empty if none governs.
    pub governing: [String; 2],
}

impl ChartRow {
    /// The row of a pose as fields of a journal: its number, the limit that governs, all numbers.
    pub fn record(&self, pose: usize) -> Vec<String> {
        let [kind, of] = self.governing.clone();
        let numbers = self.numbers.iter().copied().map(number_text);
        [pose.to_string(), kind, of].into_iter().chain(numbers).collect()
    }

    /// The same, of a crane with this combination of weights and loads.
    pub fn govern_with(&mut self, combination: &str) {
        let [kind, of] = &mut self.governing;
        if !kind.is_empty() {
            *of = if of.is_empty() { combination.to_owned() } else { format!("{of}, {combination}") };
        }
    }
}

/// The columns of a row, and what is needed to make one.
pub struct Layout {
    /// Names and units of the numbers.
    pub columns: Vec<Column>,
    /// The point whose radius and height are shown, and the axis of the radius.
    pub reach: Reach,
    /// The crane.
    pub description: Description,
    /// Combinations of weights and loads with which the loads are found.
    pub combinations: Vec<String>,
    axes: usize,
}

impl Layout {
    /// The columns: axes, load, place, condition with the crane's own load.
    pub fn new(envelope: &Envelope, description: &Description, reach: Reach) -> Self {
        let description = description.clone();
        let mut columns = Vec::new();
        let mut column = |name: String, unit: &str| columns.push(Column::new(name, unit));
        for axis in &envelope.axes.0 {
            match axis.varied {
                Varied::Drive(drive) => {
                    let coordinate = &description.coordinates[description.drives[drive].coordinate];
                    column(coordinate.name.to_string(), coordinate.kind.unit());
                }
                Varied::Parameter(index) => {
                    let parameter = &description.parameters[index];
                    column(parameter.name.to_string(), &parameter.unit);
                }
            }
        }
        column("largest_load".to_owned(), &description.parameters[envelope.load].unit);
        column("radius".to_owned(), "m");
        column("height".to_owned(), "m");
        for KeyFigure { key, unit, .. } in [KeyFigure::TIPPING_MARGIN, KeyFigure::UTILISATION] {
            column(key.to_owned(), unit);
        }
        for drive in &description.drives {
            let coordinate = &description.coordinates[drive.coordinate];
            column(drive_effort(&coordinate.name, coordinate.kind), coordinate.kind.force_unit());
        }
        for point in &description.points {
            column(format!("{point}_deflection_by_the_load"), "m");
        }
        Self { columns, reach, axes: envelope.axes.0.len(), description, combinations: Vec::new() }
    }

    /// Column of the largest load; radius, height, tipping margin and utilisation follow.
    pub fn load(&self) -> usize {
        self.axes
    }

    /// Column of the radius.
    pub fn radius(&self) -> usize {
        self.axes + 1
    }

    /// Column of the height.
    pub fn height(&self) -> usize {
        self.axes + 2
    }

    /// Column of the tipping margin with the crane's own load; what this load does follows.
    fn margin(&self) -> usize {
        self.axes + 3
    }

    /// Column of the utilisation with the crane's own load.
    pub fn utilisation(&self) -> usize {
        self.axes + 4
    }

    /// Largest load of a row; 0 if not even the smallest is within the limits.
    pub fn load_of(&self, row: &ChartRow) -> f64 {
        let load = row.numbers[self.load()];
        if load.is_nan() { 0.0 } else { load }
    }

    /// Pose by pose, load, place and limit of the row with the smaller load, of which one without a load has the smallest; and of what
    /// the crane's own load does, the worse of both.
    pub fn least(&self, first: Vec<ChartRow>, second: Vec<ChartRow>) -> Vec<ChartRow> {
        let least = |(a, b)| {
            let (mut row, other) = if self.load_of(&b) < self.load_of(&a) { (b, a) } else { (a, b) };
            let own_load = row.numbers.iter_mut().zip(&other.numbers).enumerate().skip(self.margin());
            for (column, (own, other)) in own_load {
                let is_worse = if column == self.margin() { *other < *own } else { other.abs() > own.abs() };
                if is_worse || own.is_nan() {
                    *own = *other;
                }
            }
            row
        };
        first.into_iter().zip(second).map(least).collect()
    }

    /// The row of a pose.
    pub fn row(&self, envelope: &Envelope, crane: &dyn DynCrane, pose: usize, rating: &Rating) -> ChartRow {
        let parameters = envelope.axes.parameters(crane, pose);
        let place = rating.loaded.as_ref().map(|at| self.reach.radius_and_height(&at.q, &parameters));
        let or_nan = |number: Option<f64>| number.unwrap_or(f64::NAN);
        let spec_load = rating.with_spec_load.as_ref();
        let mut numbers = envelope.axes.values(pose);
        numbers.push(or_nan(rating.load));
        numbers.extend(place.unwrap_or([f64::NAN; 2]));
        numbers.push(or_nan(spec_load.and_then(Condition::margin)));
        numbers.push(or_nan(spec_load.and_then(Condition::utilisation)));
        let efforts = self.description.drives.len();
        numbers.extend((0..efforts).map(|drive| or_nan(spec_load.map(|spec_load| spec_load.efforts[drive]))));
        let points = self.description.points.len();
        numbers.extend((0..points).map(|point| or_nan(rating.deflections.get(point).copied())));
        let governing = rating
            .governing
            .map_or_else(Default::default, |limit: Limit| [limit.kind().to_owned(), limit.location(crane)]);
        ChartRow { numbers, governing }
    }

    /// A pose and its row from the fields of a journal.
    pub fn read(&self, record: &[String]) -> Option<(usize, ChartRow)> {
        let [pose, kind, of, numbers @ ..] = record else { return None };
        let numbers = numbers.iter().map(|number| number.parse().ok()).collect::<Option<Vec<f64>>>()?;
        let governing = [kind.clone(), of.clone()];
        let complete = numbers.len() == self.columns.len();
        Some((pose.parse().ok()?, ChartRow { numbers, governing })).filter(|_| complete)
    }

    /// The axis that slews the crane, if it is one of those that vary.
    pub fn slewing(&self, asked: &Envelope) -> Option<usize> {
        let drive = self.reach.slewing()?;
        let varies = |axis: &crane_model::envelope::Axis| axis.varied == Varied::Drive(drive) && axis.values.len() > 1;
        asked.axes.0.iter().position(varies)
    }
}

/// A field of a file: empty for a number that is not finite.
pub fn field(number: f64) -> String {
    if number.is_finite() { number_text(number) } else { String::new() }
}

/// Writes all rows as CSV and as arrays; returns the names of the files.
pub fn write_rows(
    console: &Console,
    folder: &Path,
    name: &str,
    envelope: &Envelope,
    layout: &Layout,
    rows: &[ChartRow],
) -> Outcome<Vec<String>> {
    let csv = format!("{name}.csv");
    let header = layout.columns.iter().map(ToString::to_string);
    let header = header_with_reach(header, layout.radius(), &layout.reach);
    let header = header.chain(["governing", "of"].map(str::to_owned));
    let fields = rows.iter().map(|row| {
        let numbers = row.numbers.iter().copied().map(field);
        numbers.chain(row.governing.iter().cloned()).collect()
    });
    console.write_fields(&folder.join(&csv), header, fields)?;

    let archive = format!("{name}.npz");
    let axes = envelope.axes.0.iter().zip(&layout.columns).map(|(axis, column)| Array {
        name: format!("axis_{}", column.name).into(),
        shape: vec![axis.values.len()],
        data: axis.values.clone(),
    });
    let shape: Vec<usize> = envelope.axes.0.iter().map(|axis| axis.values.len()).collect();
    let columns = layout.columns.iter().enumerate().skip(layout.load());
    let columns = columns.map(|(index, column)| Array {
        name: column.name.clone().into(),
        shape: shape.clone(),
        data: rows.iter().map(|row| row.numbers[index]).collect(),
    });
    let bytes = npz(&axes.chain(columns).collect::<Vec<_>>())
        .map_err(|error| Problem::failed(format!("cannot make {archive}: {error}"), ""))?;
    console.write_file(&folder.join(&archive), |file| file.write_all(&bytes))?;
    Ok(vec![csv, archive])
}
