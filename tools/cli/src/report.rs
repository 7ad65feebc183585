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
    /// An angle, rad: in degrees for people.
    Angle(f64),
    /// The unit of angles in its row, rad: degrees for people.
    AngleUnit,
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
    /// What people read: four digits, degrees.
    fn text(&self) -> String {
        self.with_digits(DIGITS)
    }

    fn with_digits(&self, digits: i32) -> String {
        match self {
            Cell::Text(text) => text.clone(),
            Cell::Number(number) => readable(*number, digits),
            Cell::Angle(radians) => readable(radians.to_degrees(), digits),
            Cell::AngleUnit => "°".to_owned(),
            Cell::Error(error) => format!("{error:.1e}"),
            Cell::Uncertainty(error) => uncertain(*error),
            Cell::Count(count) => count.to_string(),
            Cell::Empty => "–".to_owned(),
        }
    }

    /// All digits, and angles in degrees as on the screen; nothing where that says no more than the text.
    fn exact(&self) -> String {
        match self {
            Cell::Number(number) | Cell::Error(number) | Cell::Uncertainty(number) => files::number(*number),
            Cell::Angle(radians) => files::number(radians.to_degrees()),
            _ => String::new(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Cell::Text(text) => text.as_str().into(),
            Cell::Number(number) | Cell::Error(number) | Cell::Uncertainty(number) | Cell::Angle(number) => {
                (*number).into()
            }
            Cell::AngleUnit => "rad".into(),
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

/// Significant digits on the screen; files have all.
const DIGITS: i32 = 4;
/// Significant digits in documents.
const DIGITS_OF_DOCUMENTS: i32 = 6;

/// A number with some significant digits, in powers of ten where it is very large or small; digits before the point are whole. What is
/// below 1e-10 of a unit is what rounding left of zero.
fn readable(number: f64, digits: i32) -> String {
    let size = number.abs();
    let plain = number.to_string();
    let short = usize::try_from(digits).unwrap_or(0) + 1;
    if size < 1e-10 {
        "0".to_owned()
    } else if plain.len() <= short {
        plain
    } else if (1e-3..1e7).contains(&size) {
        // Digits before the point; 1e-3 counts as -2.
        let before = (-2..=7).find(|&digits| size < 10_f64.powi(digits)).unwrap_or(7);
        let places = usize::try_from(digits - before).unwrap_or(0);
        format!("{number:.places$}")
    } else {
        let places = usize::try_from(digits - 1).unwrap_or(0);
        format!("{number:.places$e}")
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
        self.rows.iter().all(|row| !matches!(row.get(column), Some(Cell::Text(_) | Cell::AngleUnit)))
            && !self.rows.is_empty()
    }

    /// Its texts as printed, for a page.
    fn page(&self) -> Value {
        let numeric: Vec<bool> = (0..self.headers.len()).map(|column| self.numeric(column)).collect();
        let rows: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::text).collect()).collect();
        let exact: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::exact).collect()).collect();
        json!({
            "key": self.key, "title": self.title, "headers": self.headers, "numeric": numeric, "rows": rows, "exact": exact,
        })
    }

    /// Names of the columns, and rows of fields with all digits, for a CSV file.
    pub fn fields(&self) -> (impl Iterator<Item = String>, impl Iterator<Item = Vec<String>>) {
        let field = |cell: &Cell| match cell {
            Cell::Number(number) | Cell::Error(number) | Cell::Uncertainty(number) | Cell::Angle(number) => {
                files::number(*number)
            }
            Cell::AngleUnit => "rad".to_owned(),
            Cell::Empty => String::new(),
            other => other.text(),
        };
        (self.headers.iter().cloned(), self.rows.iter().map(move |row| row.iter().map(field).collect()))
    }

    /// The table in Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let sides = (0..self.headers.len()).map(|column| if self.numeric(column) { "---:" } else { "---" }.to_owned());
        let text = |cell: &Cell| cell.with_digits(DIGITS_OF_DOCUMENTS);
        let rows = self.rows.iter().map(|row| line(row.iter().map(text).collect()));
        [line(self.headers.clone()), line(sides.collect())].into_iter().chain(rows).collect()
    }

    /// Prints its first rows for people.
    fn print(&self, most: usize, out: &mut dyn Write) -> Outcome<()> {
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
        for row in texts.iter().take(most) {
            line(&mut row.iter().map(String::as_str))?;
        }
        if texts.len() > most {
            writeln!(out, "  … {} more rows with `--all`", texts.len() - most)?;
        }
        Ok(())
    }
}

/// Facts and tables in order.
#[derive(Clone, Debug, Default)]
pub struct Report {
    facts: Vec<(String, Cell, &'static str)>,
    cautions: Vec<String>,
    /// Tables, and how many of their rows people see unless they ask for all.
    grids: Vec<(Grid, usize)>,
    all: bool,
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
        self.excerpt(grid, usize::MAX);
    }

    /// Adds a table before all others, unless it has no rows.
    pub fn grid_first(&mut self, grid: Grid) {
        if !grid.rows.is_empty() {
            self.grids.insert(0, (grid, usize::MAX));
        }
    }

    /// Adds a table of which people see some rows, or none, unless they ask for all.
    pub fn excerpt(&mut self, grid: Grid, rows: usize) {
        if !grid.rows.is_empty() {
            self.grids.push((grid, rows));
        }
    }

    /// Whether people want to see all tables whole.
    pub fn show_all(&mut self, all: bool) {
        self.all = all;
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
        json!({"facts": facts, "grids": self.grids.iter().map(|(grid, _)| grid.page()).collect::<Vec<_>>()})
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
                let seen = |rows: usize| if self.all { usize::MAX } else { rows };
                let shown = self.grids.iter().filter(|(_, rows)| seen(*rows) > 0);
                for (index, (grid, rows)) in shown.enumerate() {
                    if index > 0 || !self.facts.is_empty() || !self.cautions.is_empty() {
                        writeln!(out)?;
                    }
                    grid.print(seen(*rows), out)?;
                }
                let hidden = self.grids.iter().filter(|(_, rows)| seen(*rows) == 0);
                // What it is, without how to read it.
                let hidden: Vec<&str> =
                    hidden.map(|(grid, _)| grid.title.split([',', ':']).next().unwrap_or_default()).collect();
                if !hidden.is_empty() {
                    writeln!(out, "\nWith `--all` also: {}", hidden.join("; "))?;
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
        for (grid, _) in &self.grids {
            object.insert(grid.key.to_owned(), grid.json());
        }
        object.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_read_four_digits_and_degrees() {
        for (number, text) in [
            (14270.4, "14270"),
            (3.999_89, "4.000"),
            (0.471_501, "0.4715"),
            (0.02, "0.02"),
            (-6509.11, "-6509"),
            (1.234_56e9, "1.235e9"),
            (1e-12, "0"),
        ] {
            assert_eq!(Cell::Number(number).text(), text);
        }
        let angle = Cell::Angle(std::f64::consts::FRAC_PI_3);
        assert_eq!((angle.text().as_str(), angle.json()), ("60.00", std::f64::consts::FRAC_PI_3.into()));
        assert_eq!(Cell::Number(14270.44).with_digits(DIGITS_OF_DOCUMENTS), "14270.4");
    }

    #[test]
    fn long_tables_are_printed_whole_where_asked_for() {
        let grid = |key: &'static str, title: &str| {
            let mut grid = Grid::new(key, title, &["n"]);
            (0..5_usize).for_each(|n| grid.row([n.into()]));
            grid
        };
        let printed = |all: bool| {
            let mut report = Report::default();
            report.show_all(all);
            report.excerpt(grid("modes", "Modes"), 2);
            report.excerpt(grid("pose", "Pose"), 0);
            report.grid_first(grid("peaks", "Peaks"));
            let mut out = Vec::new();
            report.print(Format::Table, &mut out).expect("it prints");
            String::from_utf8(out).expect("text")
        };
        let short = printed(false);
        assert!(short.starts_with("Peaks\n") && short.contains("… 3 more rows with `--all`"), "{short}");
        assert!(short.ends_with("\nWith `--all` also: Pose\n"), "{short}");
        assert_eq!(printed(true).lines().filter(|line| line.trim() == "4").count(), 3);
    }
}
