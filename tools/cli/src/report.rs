//! Tables for people and the same as JSON for programs.

use std::io::Write;

use serde_json::{Map, Value, json};

use crate::{arguments::Format, files, problem::Outcome};

/// One field of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// A name or a sentence.
    Text(String),
    /// A number.
    Number(f64),
    /// A relative error: its size is what matters.
    Error(f64),
    /// An absolute error, in the unit of its row: two digits are enough.
    Uncertainty(f64),
    /// A count.
    Count(usize),
    /// Nothing to say.
    Empty,
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Cell::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Cell::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Cell::Number(number)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Cell::Count(count)
    }
}

impl From<Option<f64>> for Cell {
    fn from(number: Option<f64>) -> Self {
        number.map_or(Cell::Empty, Cell::Number)
    }
}

impl Cell {
    fn text(&self) -> String {
        match self {
            Cell::Text(text) => text.clone(),
            Cell::Number(number) => readable(*number),
            Cell::Error(error) => format!("{error:.1e}"),
            Cell::Uncertainty(error) => uncertain(*error),
            Cell::Count(count) => count.to_string(),
            Cell::Empty => "–".to_owned(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Cell::Text(text) => text.as_str().into(),
            Cell::Number(number) | Cell::Error(number) | Cell::Uncertainty(number) => (*number).into(),
            Cell::Count(count) => (*count).into(),
            Cell::Empty => Value::Null,
        }
    }
}

/// A number with two significant digits, in powers of ten where it is very large or small.
fn uncertain(number: f64) -> String {
    let short = format!("{number:.1e}");
    match short.parse::<f64>() {
        Ok(rounded) if (1e-3..1e6).contains(&rounded) => rounded.to_string(),
        _ => short,
    }
}

/// A number with six significant digits, in powers of ten where it is very large or small. What is below 1e-10 of
/// a unit is what rounding left of zero.
fn readable(number: f64) -> String {
    /// Significant digits.
    const DIGITS: i32 = 6;
    /// A number as short as this is shown as it is.
    const SHORT: usize = 7;
    let size = number.abs();
    let plain = number.to_string();
    if size < 1e-10 {
        "0".to_owned()
    } else if plain.len() <= SHORT {
        plain
    } else if (1e-3..1e7).contains(&size) {
        // Digits before the point; 1e-3 counts as -2.
        let before = (-2..=7).find(|&digits| size < 10_f64.powi(digits)).unwrap_or(7);
        let places = usize::try_from(DIGITS - before).unwrap_or(0);
        format!("{number:.places$}")
    } else {
        format!("{number:.4e}")
    }
}

/// A table with named columns.
#[derive(Clone, Debug)]
pub struct Grid {
    key: &'static str,
    title: String,
    headers: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

impl Grid {
    /// A table without rows; `key` names it in JSON, `title` for people.
    pub fn new(key: &'static str, title: impl Into<String>, headers: &[&str]) -> Self {
        let headers = headers.iter().map(ToString::to_string).collect();
        Self { key, title: title.into(), headers, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl Into<Vec<Cell>>) {
        self.rows.push(cells.into());
    }

    /// Its name in JSON.
    pub fn key(&self) -> &'static str {
        self.key
    }

    fn json(&self) -> Value {
        let object = |row: &Vec<Cell>| -> Value {
            let keys = self.headers.iter().map(|header| header.replace(' ', "_"));
            keys.zip(row).map(|(key, cell)| (key, cell.json())).collect::<Map<_, _>>().into()
        };
        self.rows.iter().map(object).collect()
    }

    /// Whether a column holds numbers alone.
    fn numeric(&self, column: usize) -> bool {
        self.rows.iter().all(|row| !matches!(row.get(column), Some(Cell::Text(_)))) && !self.rows.is_empty()
    }

    /// Its texts as printed, for a page.
    fn page(&self) -> Value {
        let numeric: Vec<bool> = (0..self.headers.len()).map(|column| self.numeric(column)).collect();
        let rows: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::text).collect()).collect();
        json!({"key": self.key, "title": self.title, "headers": self.headers, "numeric": numeric, "rows": rows})
    }

    /// Names of the columns, and rows of fields with all digits, for a CSV file.
    pub fn fields(&self) -> (impl Iterator<Item = String>, impl Iterator<Item = Vec<String>>) {
        let field = |cell: &Cell| match cell {
            Cell::Number(number) | Cell::Error(number) | Cell::Uncertainty(number) => files::number(*number),
            Cell::Empty => String::new(),
            other => other.text(),
        };
        (self.headers.iter().cloned(), self.rows.iter().map(move |row| row.iter().map(field).collect()))
    }

    /// The table in Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let sides = (0..self.headers.len()).map(|column| if self.numeric(column) { "---:" } else { "---" }.to_owned());
        let rows = self.rows.iter().map(|row| line(row.iter().map(Cell::text).collect()));
        [line(self.headers.clone()), line(sides.collect())].into_iter().chain(rows).collect()
    }

    /// Prints it for people.
    fn print(&self, out: &mut dyn Write) -> Outcome<()> {
        writeln!(out, "{}", self.title)?;
        let texts: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::text).collect()).collect();
        let width = |column: usize| {
            let cells = texts.iter().filter_map(|row| row.get(column)).map(|text| text.chars().count());
            cells.chain([self.headers[column].chars().count()]).max().unwrap_or(0)
        };
        let mut line = |cells: &mut dyn Iterator<Item = &str>| -> Outcome<()> {
            let padded = cells.enumerate().map(|(column, cell)| {
                let width = width(column);
                if self.numeric(column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
            });
            Ok(writeln!(out, "  {}", padded.collect::<Vec<_>>().join("  ").trim_end())?)
        };
        line(&mut self.headers.iter().map(String::as_str))?;
        for row in &texts {
            line(&mut row.iter().map(String::as_str))?;
        }
        Ok(())
    }
}

/// Facts and tables in order.
#[derive(Clone, Debug, Default)]
pub struct Report {
    facts: Vec<(String, Cell, &'static str)>,
    cautions: Vec<String>,
    grids: Vec<Grid>,
}

impl Report {
    /// Adds a fact with its unit.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<Cell>, unit: &'static str) {
        self.facts.push((name.into(), value.into(), unit));
    }

    /// Adds a warning, if there is one.
    pub fn caution(&mut self, words: Option<impl Into<String>>) {
        self.cautions.extend(words.map(Into::into));
    }

    /// Adds a table, unless it has no rows.
    pub fn grid(&mut self, grid: Grid) {
        if !grid.rows.is_empty() {
            self.grids.push(grid);
        }
    }

    /// The facts as a list in Markdown.
    pub fn markdown(&self) -> String {
        self.facts
            .iter()
            .map(|(name, value, unit)| format!("* {name}: {} {unit}", value.text()).trim_end().to_owned() + "\n")
            .collect()
    }

    /// Facts and tables as printed, for a page.
    pub fn page(&self) -> Value {
        let facts: Vec<_> = self
            .facts
            .iter()
            .map(|(name, value, unit)| [name.as_str(), value.text().as_str(), unit].map(str::to_owned))
            .chain(self.cautions.iter().map(|words| ["caution", words, ""].map(str::to_owned)))
            .collect();
        json!({"facts": facts, "grids": self.grids.iter().map(Grid::page).collect::<Vec<_>>()})
    }

    /// Prints it in the form asked for.
    ///
    /// # Errors
    /// The output is closed.
    pub fn print(&self, format: Format, out: &mut dyn Write) -> Outcome<()> {
        match format {
            Format::Json => Ok(writeln!(out, "{:#}", self.json())?),
            Format::Table => {
                let width = self.facts.iter().map(|(name, ..)| name.chars().count()).max().unwrap_or(0);
                for (name, value, unit) in &self.facts {
                    writeln!(out, "{}", format!("{name:<width$}  {} {unit}", value.text()).trim_end())?;
                }
                for words in &self.cautions {
                    writeln!(out, "caution: {words}")?;
                }
                for (index, grid) in self.grids.iter().enumerate() {
                    if index > 0 || !self.facts.is_empty() || !self.cautions.is_empty() {
                        writeln!(out)?;
                    }
                    grid.print(out)?;
                }
                Ok(())
            }
        }
    }

    /// Facts and tables by name; units of facts as `<name>_unit`.
    fn json(&self) -> Value {
        let mut object = Map::new();
        for (name, value, unit) in &self.facts {
            let key = name.replace(' ', "_");
            if !unit.is_empty() {
                object.insert(format!("{key}_unit"), (*unit).into());
            }
            object.insert(key, value.json());
        }
        if !self.cautions.is_empty() {
            object.insert("cautions".to_owned(), self.cautions.as_slice().into());
        }
        for grid in &self.grids {
            object.insert(grid.key.to_owned(), grid.json());
        }
        object.into()
    }
}
