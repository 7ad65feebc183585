//! A table of parameter values, one row per crane.

use std::path::Path;

use crane_codegen::units::{name_and_unit, number_in};
use crane_model::{Description, dyn_crane::DynCrane};

use crate::{
    files,
    problem::{Outcome, Problem},
    screen::Console,
    selection::{find_parameter, refusal_message, set_parameters},
};

/// Values of live parameters of many cranes.
pub struct ParameterTable {
    /// Indices of the columns' parameters in the description.
    pub columns: Vec<usize>,
    /// Values, one row per crane; at least one.
    pub rows: Vec<Vec<f64>>,
}

impl ParameterTable {
    /// Reads a CSV file whose header names live parameters, each with a unit of its dimension or without: `load_mass`, `load_mass [kg]` or `load_mass [t]`.
    pub fn read(console: &Console, path: &Path, description: &Description) -> Outcome<Self> {
        let csv = console.csv(path);
        let unreadable = |error: csv::Error| {
            let title = match error.kind() {
                csv::ErrorKind::UnequalLengths { pos: Some(pos), expected_len, len } => {
                    let path = path.display();
                    format!("{path}, line {}: {len} fields, but the header names {expected_len}", pos.line())
                }
                _ => format!("cannot use {}: {error}", path.display()),
            };
            Problem::usage(
                title,
                "write a CSV table: a header with names of live parameters, then one row of numbers per crane",
            )
        };
        let mut csv = csv.map_err(unreadable)?;
        let (mut columns, mut units) = (Vec::new(), Vec::new());
        let headers = csv.headers().map_err(unreadable)?;
        files::check_separators(path, headers)?;
        for (column, header) in headers.iter().enumerate() {
            let at = Cell { path, line: 1, column: column + 1 };
            let (index, unit) = at.parameter(header, description)?;
            if columns.contains(&index) {
                return Err(at.problem(&format!("`{header}` occurs twice"), "give each parameter one column"));
            }
            columns.push(index);
            units.push(unit);
        }
        let mut rows = Vec::new();
        for record in csv.records() {
            let record = record.map_err(unreadable)?;
            let line = record.position().map_or(0, csv::Position::line);
            let value = |(column, (text, &index)): (usize, (&str, &usize))| {
                let (info, at) = (&description.parameters[index], Cell { path, line, column: column + 1 });
                let with_unit = units[column].as_ref().map_or_else(|| text.to_owned(), |unit| format!("{text} {unit}"));
                let number = number_in(&info.unit, &with_unit, &info.name).ok().filter(|number| number.is_finite());
                let number = number.ok_or_else(|| {
                    let help = match &units[column] {
                        Some(unit) => format!("write a finite number, in {unit}"),
                        None => format!("write a finite number, in {}, such as {}", info.unit, info.default),
                    };
                    at.problem(&format!("`{text}` is not a valid value for {}", info.name), help)
                })?;
                info.check(number).map_err(|refused| {
                    let (title, help) = refusal_message(&refused);
                    at.problem(&title, help)
                })?;
                Ok(number)
            };
            rows.push(record.iter().zip(&columns).enumerate().map(value).collect::<Outcome<_>>()?);
        }
        if rows.is_empty() {
            return Err(Problem::usage(
                format!("{} has no rows", path.display()),
                "write a header with names of live parameters, then one row of numbers per crane",
            ));
        }
        Ok(Self { columns, rows })
    }

    /// All live parameters of every row: those without a column are as in `base`.
    pub fn parameters(&self, base: &dyn DynCrane) -> Vec<Vec<f64>> {
        let defaults: Vec<f64> = base.parameter_values();
        let row = |row: &Vec<f64>| {
            let mut values = defaults.clone();
            for (&index, &value) in self.columns.iter().zip(row) {
                values[index] = value;
            }
            values
        };
        self.rows.iter().map(row).collect()
    }

    /// The crane of a row: parameters without a column are as in `base`.
    pub fn crane(&self, base: &dyn DynCrane, row: &[f64]) -> Outcome<Box<dyn DynCrane>> {
        let mut crane = base.boxed_clone();
        let settings: Vec<(usize, f64)> = self.columns.iter().copied().zip(row.iter().copied()).collect();
        set_parameters(crane.as_mut(), &settings)?;
        Ok(crane)
    }
}

/// A field of a table.
struct Cell<'a> {
    path: &'a Path,
    line: u64,
    column: usize,
}

impl Cell<'_> {
    fn problem(&self, what: &str, help: impl Into<String>) -> Problem {
        let Self { path, line, column } = self;
        Problem::usage(format!("{}, line {line}, column {column}: {what}", path.display()), help)
    }

    /// The parameter that a header names, and the unit of its column if that is another one of its dimension.
    fn parameter(&self, header: &str, description: &Description) -> Outcome<(usize, Option<String>)> {
        let (name, unit) = name_and_unit(header);
        let index = find_parameter(name, description).map_err(|(title, help)| self.problem(&title, help))?;
        let wanted = &description.parameters[index].unit;
        let Some(unit) = unit.filter(|unit| wanted != unit) else { return Ok((index, None)) };
        match number_in(wanted, &format!("1 {unit}"), name) {
            Ok(_) => Ok((index, Some(unit.to_owned()))),
            Err(_) => {
                Err(self
                    .problem(&format!("{name} is in {wanted}, not in {unit}"), format!("write `{name} [{wanted}]`")))
            }
        }
    }
}
