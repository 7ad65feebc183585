//! A chart that somebody gave: loads over the radius or over positions of drives, to compare with.

use std::path::Path;

use crane_model::{
    Description, DisplayUnit,
    envelope::{Axes, Axis, Envelope},
};
use crane_page::tables::{Cell, Grid, Heading};

use crate::{
    problem::{Outcome, Problem},
    screen::Console,
    sheet::Sheet,
};

use super::{
    chart::{self, rounded_down},
    ranges::{unit_of, varied},
    rows::{ChartRow, Layout},
};

/// Key of the table of both charts.
pub const KEY: &str = "beside_the_given_chart";

/// Loads in the unit of the crane's load, and where they hold.
#[derive(Debug)]
pub struct Given {
    /// One per row of the file.
    pub loads: Vec<f64>,
    /// As many values as loads.
    pub places: Places,
}

/// Where loads hold.
#[derive(Debug)]
pub enum Places {
    /// At radii, m.
    Radii(Vec<f64>),
    /// At positions of drives and values of parameters, each with one value per load.
    Positions(Vec<Axis>),
}

impl Given {
    /// Reads a CSV file with the column `load` and either `radius` or columns that name drives or parameters of the ranges. Units may stand in the
    /// header, as in `load [t]`, or beside numbers.
    ///
    /// # Errors
    /// The file cannot be read, lacks a column, has one that no range varies, or has something else than numbers.
    pub fn read(
        console: &Console,
        path: &Path,
        unit_of_load: &str,
        description: &Description,
        ranges: &Axes,
    ) -> Outcome<Self> {
        /// The columns of loads and of radii.
        const COLUMNS: [&str; 2] = ["load", "radius"];
        let help = "write a CSV table with the columns radius and load, such as `radius [m],load [t]` and `6.5,3.2`, or with positions of drives in \
                    place of the radius";
        let sheet = Sheet::read(console, path, help)?;
        let [load, radius] = COLUMNS.map(|name| sheet.place(name));
        let others: Vec<&str> = sheet.names().filter(|name| !COLUMNS.contains(name)).collect();
        let Some(load) = load.filter(|_| radius.is_some() || !others.is_empty()) else {
            return Err(Problem::usage(
                format!("{} has no column `{}`", path.display(), COLUMNS[usize::from(load.is_some())]),
                format!(
                    "its columns are {}; write `radius [m],load [{unit_of_load}]`",
                    sheet.names().collect::<Vec<_>>().join(", ")
                ),
            ));
        };
        let empty = |row: usize| sheet.problem(row, "a field is empty", "write all numbers, or leave the row out");
        let above_zero = |row: usize, column: usize, unit: &str| {
            sheet.number_above_zero(row, column, unit)?.ok_or_else(|| empty(row))
        };
        let of_all = |column: usize, unit: &str| -> Outcome<Vec<f64>> {
            (0..sheet.len()).map(|row| above_zero(row, column, unit)).collect()
        };
        let loads = of_all(load, unit_of_load)?;
        let places = match (radius, others.first()) {
            (Some(radius), None) => Places::Radii(of_all(radius, "m")?),
            (Some(_), Some(other)) => {
                return Err(Problem::usage(
                    format!("{} has a radius and the column `{other}`", path.display()),
                    "write loads over the radius, or over positions of drives",
                ));
            }
            (None, _) => {
                let axis = |name: &str| {
                    let varied = varied(name, description)?;
                    if !ranges.0.iter().any(|axis| axis.varied == varied) {
                        return Err(Problem::usage(
                            format!("{} has the column `{name}`, which no range varies", path.display()),
                            format!("add `--range {name}=FROM:TO:COUNT`"),
                        ));
                    }
                    let (column, unit) = (sheet.place(name).unwrap_or_default(), unit_of(varied, description));
                    let value = |row: usize| sheet.number(row, column, unit)?.ok_or_else(|| empty(row));
                    Ok(Axis { varied, values: (0..sheet.len()).map(value).collect::<Outcome<_>>()? })
                };
                Places::Positions(others.into_iter().map(axis).collect::<Outcome<_>>()?)
            }
        };
        Ok(Self { loads, places })
    }

    /// The chart beside ratings at its positions: between two of them, what the crane bears at both; with the best values of what the chart does not
    /// name.
    pub fn beside(&self, positions: &[Axis], envelope: &Envelope, layout: &Layout, rows: &[ChartRow]) -> Grid {
        let columns: Vec<Option<usize>> =
            positions.iter().map(|given| envelope.axes.0.iter().position(|axis| axis.varied == given.varied)).collect();
        let columns: Vec<usize> = columns.into_iter().flatten().collect();
        let unit = &layout.columns[layout.load()].unit;
        let of_positions = columns.iter().map(|column| {
            let column = &layout.columns[*column];
            let shown = DisplayUnit::always(&column.unit).map_or(column.unit.as_str(), |shown| shown.unit());
            Heading::from(format!("{} [{shown}]", column.name).as_str())
        });
        let of_loads = [format!("given load [{unit}]"), format!("largest load [{unit}]")];
        let of_loads = of_loads.iter().map(String::as_str).chain(["difference [%]", "limit"]).map(Heading::from);
        let title = "The given chart, the largest load at its positions, and its difference from the given one";
        let mut grid = Grid::with_headings(KEY, title, of_positions.chain(of_loads).collect());
        for (index, load) in self.loads.iter().enumerate() {
            // Positions beside the given ones.
            let around: Vec<Vec<f64>> = positions
                .iter()
                .zip(&columns)
                .map(|(given, column)| neighbours(&envelope.axes.0[*column].values, given.values[index]))
                .collect();
            let is_near = |row: &&ChartRow| {
                columns.iter().zip(&around).all(|(column, near)| near.contains(&row.numbers[*column]))
            };
            // What all around bear, by what the chart does not name.
            let mut found: Vec<(Vec<f64>, &ChartRow)> = Vec::new();
            let axes = 0..envelope.axes.0.len();
            for row in rows.iter().filter(is_near) {
                let others: Vec<f64> =
                    axes.clone().filter(|axis| !columns.contains(axis)).map(|axis| row.numbers[axis]).collect();
                match found.iter_mut().find(|(known, _)| *known == others) {
                    Some((_, least)) if layout.load_of(row) < layout.load_of(least) => *least = row,
                    Some(_) => {}
                    None => found.push((others, row)),
                }
            }
            let best = found.iter().map(|(_, row)| *row).max_by(|a, b| layout.load_of(a).total_cmp(&layout.load_of(b)));
            let computed = best.map(|row| rounded_down(layout.load_of(row)));
            let at = positions.iter().zip(&columns);
            let at = at.map(|(given, column)| Cell::of_unit(given.values[index], &layout.columns[*column].unit));
            let numbers = [
                (*load).into(),
                computed.map_or(Cell::Empty, Cell::from),
                computed.map_or(Cell::Empty, |computed| Cell::Change(computed / load - 1.0)),
                best.map_or(Cell::from(chart::UNREACHED), |row| chart::limit_words(row).into()),
            ];
            grid.row(at.chain(numbers).collect::<Vec<_>>());
        }
        grid
    }
}

/// The values of a range on both sides of a position, or the one that it is; none if it is outside.
fn neighbours(values: &[f64], position: f64) -> Vec<f64> {
    /// Rounding of ranges.
    const SAME: f64 = 1e-9;
    let span = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    if let Some(same) = values.iter().find(|value| (*value - position).abs() <= SAME * span) {
        return vec![*same];
    }
    let below = values.iter().copied().filter(|value| *value < position).max_by(f64::total_cmp);
    let above = values.iter().copied().filter(|value| *value > position).min_by(f64::total_cmp);
    below.zip(above).map_or_else(Vec::new, |(below, above)| vec![below, above])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_have_neighbours_on_both_sides() {
        let values = [0.0, 0.1, 0.2];
        assert_eq!(neighbours(&values, 0.1 + 1e-12), [0.1]);
        assert_eq!(neighbours(&values, 0.15), [0.1, 0.2]);
        assert_eq!(neighbours(&values, 0.3), [0.0; 0]);
    }
}
