//! A chart that somebody gave: loads over the radius, to compare with.

use std::path::Path;

use crane_codegen::units::name_and_unit;

use crate::{
    files,
    problem::{Outcome, Problem},
    quantity,
};

/// Columns of its file.
const COLUMNS: [&str; 2] = ["radius", "load"];

/// Radii, m, and loads in the unit of the crane's load.
#[derive(Debug)]
pub struct Given(pub Vec<[f64; 2]>);

impl Given {
    /// Reads a CSV file with the columns `radius` and `load`, whose units may stand in the header, as in `load [t]`, or beside numbers.
    ///
    /// # Errors
    /// The file cannot be read, lacks a column, or has something else than numbers above zero.
    pub fn read(path: &Path, unit_of_load: &str) -> Outcome<Self> {
        let unreadable = |error: csv::Error| {
            Problem::usage(
                format!("cannot use {}: {error}", path.display()),
                "write a CSV table with the columns radius and load, such as `radius [m],load [t]` and `6.5,3.2`",
            )
        };
        let mut csv = files::csv(path).map_err(unreadable)?;
        let headers = csv.headers().map_err(unreadable)?.clone();
        files::check_separators(path, &headers)?;
        let columns = COLUMNS.map(|wanted| headers.iter().position(|header| name_and_unit(header).0 == wanted));
        let [Some(radius), Some(load)] = columns else {
            let missing = COLUMNS.iter().zip(columns).find(|(_, found)| found.is_none()).map_or("", |(name, _)| *name);
            return Err(Problem::usage(
                format!("{} has no column `{missing}`", path.display()),
                format!(
                    "its header is `{}`; write `radius [m],load [{unit_of_load}]`",
                    headers.iter().collect::<Vec<_>>().join(",")
                ),
            ));
        };
        let mut points = Vec::new();
        for record in csv.records() {
            let record = record.map_err(unreadable)?;
            let line = record.position().map_or(0, csv::Position::line);
            let number = |column: usize, unit: &str| {
                let text = record.get(column).unwrap_or_default();
                let with_unit =
                    name_and_unit(&headers[column]).1.map_or_else(|| text.to_owned(), |unit| format!("{text} {unit}"));
                let subject = format!("the {} of {}, line {line},", name_and_unit(&headers[column]).0, path.display());
                let number = quantity::number(unit, &with_unit, &subject)?;
                if number > 0.0 {
                    return Ok(number);
                }
                Err(Problem::usage(
                    format!("{}, line {line}: {text} is not above 0", path.display()),
                    "leave the row out",
                ))
            };
            points.push([number(radius, "m")?, number(load, unit_of_load)?]);
        }
        if points.is_empty() {
            return Err(Problem::usage(format!("{} has no rows", path.display()), "write a radius and a load per row"));
        }
        Ok(Self(points))
    }
}
