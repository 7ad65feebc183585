//! CSV tables that users write: known columns with units in their headings, `load [t]`, or beside their numbers.

use std::path::{Path, PathBuf};

use crane_codegen::units::name_and_unit;

use crate::{
    files,
    problem::{Outcome, Problem},
    quantity,
    screen::Console,
};

/// A table with a header, as written.
pub struct Sheet {
    path: PathBuf,
    /// Names and units of its columns.
    columns: Vec<(String, Option<String>)>,
    /// Its rows, with their lines in the file.
    rows: Vec<(u64, csv::StringRecord)>,
}

impl Sheet {
    /// Reads a file; `help` says what to write.
    ///
    /// # Errors
    /// The file cannot be read as a table, has no rows, or has a column twice.
    pub fn read(console: &Console, path: &Path, help: &str) -> Outcome<Self> {
        let unreadable = |error: csv::Error| {
            let title = match error.kind() {
                csv::ErrorKind::UnequalLengths { pos: Some(pos), expected_len, len } => {
                    format!(
                        "{}, line {}: {len} fields, but the header names {expected_len}",
                        path.display(),
                        pos.line()
                    )
                }
                _ => format!("cannot use {}: {error}", path.display()),
            };
            Problem::usage(title, help)
        };
        let mut csv = console.csv(path).map_err(unreadable)?;
        let headers = csv.headers().map_err(unreadable)?.clone();
        files::check_separators(path, &headers)?;
        let columns: Vec<(String, Option<String>)> =
            headers.iter().map(name_and_unit).map(|(name, unit)| (name.to_owned(), unit.map(str::to_owned))).collect();
        if let Some((name, _)) = columns
            .iter()
            .enumerate()
            .find_map(|(index, column)| columns[..index].iter().any(|(name, _)| *name == column.0).then_some(column))
        {
            return Err(Problem::usage(
                format!("{} has the column `{name}` twice", path.display()),
                "give each column once",
            ));
        }
        let mut rows = Vec::new();
        for record in csv.records() {
            let record = record.map_err(unreadable)?;
            rows.push((record.position().map_or(0, csv::Position::line), record));
        }
        if rows.is_empty() {
            return Err(Problem::usage(format!("{} has no rows", path.display()), help));
        }
        Ok(Self { path: path.to_owned(), columns, rows })
    }

    /// Names of its columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// Number of its rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Where a column of this name is.
    pub fn place(&self, name: &str) -> Option<usize> {
        self.names().position(|column| column == name)
    }

    /// The text of a field.
    pub fn text(&self, row: usize, column: usize) -> &str {
        self.rows[row].1.get(column).unwrap_or_default()
    }

    /// The number of a field, in a unit of SI; `None` of an empty field.
    ///
    /// # Errors
    /// It is something else, or in another dimension.
    pub fn number(&self, row: usize, column: usize, unit: &str) -> Outcome<Option<f64>> {
        let text = self.text(row, column);
        if text.is_empty() {
            return Ok(None);
        }
        let (name, own) = &self.columns[column];
        let with_unit = own.as_ref().map_or_else(|| text.to_owned(), |own| format!("{text} {own}"));
        quantity::number(unit, &with_unit, &format!("the {name} of {},", self.at(row))).map(Some)
    }

    /// As [`Self::number`], above 0.
    ///
    /// # Errors
    /// It is not.
    pub fn number_above_zero(&self, row: usize, column: usize, unit: &str) -> Outcome<Option<f64>> {
        match self.number(row, column, unit)? {
            Some(number) if number <= 0.0 => {
                let (name, text) = (&self.columns[column].0, self.text(row, column));
                Err(self.problem(row, &format!("the {name} `{text}` is not above 0"), "write a number above 0"))
            }
            number => Ok(number),
        }
    }

    /// A number of a column as people read it: in the unit of its heading.
    pub fn shown(&self, column: usize, number: f64, unit: &str) -> (f64, String) {
        let own = self.columns[column].1.as_deref().unwrap_or(unit);
        let one = quantity::number(unit, &format!("1 {own}"), "").unwrap_or(1.0);
        (number / one, own.to_owned())
    }

    /// What is wrong with a row.
    pub fn problem(&self, row: usize, what: &str, help: &str) -> Problem {
        Problem::usage(format!("{}: {what}", self.at(row)), help)
    }

    fn at(&self, row: usize) -> String {
        format!("{}, line {}", self.path.display(), self.rows[row].0)
    }
}
