//! Tables for people and the same as JSON for programs.

use std::{fmt, io::Write};

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
    /// A relative change, %, with its sign.
    Change(f64),
    /// Several names.
    Names(Vec<String>),
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
            Cell::Change(change) => format!("{change:+.2}"),
            Cell::Names(names) => names.join(", "),
            Cell::Count(count) => count.to_string(),
            Cell::Empty => "–".to_owned(),
        }
    }

    /// All digits, and angles in degrees as on the screen; nothing where that says no more than the text.
    fn exact(&self) -> String {
        match self {
            Cell::Number(number) | Cell::Error(number) | Cell::Uncertainty(number) | Cell::Change(number) => {
                files::number(*number)
            }
            Cell::Angle(radians) => files::number(radians.to_degrees()),
            _ => String::new(),
        }
    }

    fn json(&self) -> Value {
        match self {
            Cell::Text(text) => text.as_str().into(),
            Cell::Number(number)
            | Cell::Error(number)
            | Cell::Uncertainty(number)
            | Cell::Angle(number)
            | Cell::Change(number) => (*number).into(),
            Cell::Names(names) => names.as_slice().into(),
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

/// The heading of a column.
#[derive(Clone, Debug)]
pub struct Heading {
    /// Which of several cranes, or of several cases, the column is about; empty if there is one.
    label: String,
    name: String,
    /// Unit of all its numbers; empty where there is none or each row has its own.
    unit: String,
}

/// Name of a column about which its label says everything, and label of a crane that is alone.
pub const VALUE: &str = "value";

impl Heading {
    /// The heading of a column about one of several things; [`VALUE`] as label: about the only one.
    pub fn of(label: &str, name: &str) -> Self {
        let label = if label == VALUE { "" } else { label };
        Self { label: label.to_owned(), ..name.into() }
    }

    /// Its key in JSON.
    fn key(&self) -> String {
        self.name.replace(' ', "_")
    }
}

impl From<&str> for Heading {
    /// A name and a unit, as in `frequency [Hz]`, or a name alone.
    fn from(text: &str) -> Self {
        let parts = text.strip_suffix(']').and_then(|text| text.split_once(" ["));
        let (name, unit) = parts.unwrap_or((text, ""));
        Self { label: String::new(), name: name.to_owned(), unit: unit.to_owned() }
    }
}

impl fmt::Display for Heading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.label.as_str(), self.name.as_str()) {
            ("", name) => f.write_str(name)?,
            (label, VALUE) => f.write_str(label)?,
            (label, name) => write!(f, "{label} {name}")?,
        }
        if self.unit.is_empty() { Ok(()) } else { write!(f, " [{}]", self.unit) }
    }
}

/// A table with named columns.
#[derive(Clone, Debug)]
pub struct Grid {
    key: &'static str,
    title: String,
    headings: Vec<Heading>,
    rows: Vec<Vec<Cell>>,
}

impl Grid {
    /// A table without rows; `key` names it in JSON, `title` for people. A heading is a name with or without a unit: `frequency [Hz]`.
    pub fn new(key: &'static str, title: impl Into<String>, headings: &[&str]) -> Self {
        Self::with_headings(key, title, headings.iter().map(|heading| Heading::from(*heading)).collect())
    }

    /// A table without rows, some of whose columns are about one of several things.
    pub fn with_headings(key: &'static str, title: impl Into<String>, headings: Vec<Heading>) -> Self {
        Self { key, title: title.into(), headings, rows: Vec::new() }
    }

    /// What people read above the columns.
    fn headers(&self) -> Vec<String> {
        self.headings.iter().map(ToString::to_string).collect()
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl Into<Vec<Cell>>) {
        self.rows.push(cells.into());
    }

    /// Its name in JSON.
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// Rows as objects. Columns about one of several things are objects by label.
    fn json(&self) -> Value {
        let object = |row: &Vec<Cell>| {
            let mut object = Map::new();
            for (heading, cell) in self.headings.iter().zip(row) {
                if heading.label.is_empty() {
                    object.insert(heading.key(), cell.json());
                } else if let Value::Object(labelled) = object.entry(heading.key()).or_insert_with(|| json!({})) {
                    labelled.insert(heading.label.clone(), cell.json());
                }
            }
            Value::Object(object)
        };
        self.rows.iter().map(object).collect()
    }

    /// Units of the columns that have one.
    fn units(&self) -> Map<String, Value> {
        let with_unit = self.headings.iter().filter(|heading| !heading.unit.is_empty());
        with_unit.map(|heading| (heading.key(), heading.unit.as_str().into())).collect()
    }

    /// Whether a column holds numbers alone.
    fn numeric(&self, column: usize) -> bool {
        self.rows.iter().all(|row| !matches!(row.get(column), Some(Cell::Text(_) | Cell::AngleUnit)))
            && !self.rows.is_empty()
    }

    /// Its texts as printed, for a page.
    fn page(&self) -> Value {
        let numeric: Vec<bool> = (0..self.headings.len()).map(|column| self.numeric(column)).collect();
        let rows: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::text).collect()).collect();
        let exact: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::exact).collect()).collect();
        json!({
            "key": self.key, "title": self.title, "headers": self.headers(), "numeric": numeric, "rows": rows, "exact": exact,
        })
    }

    /// Names of the columns, and rows of fields with all digits, for a CSV file.
    pub fn fields(&self) -> (impl Iterator<Item = String>, impl Iterator<Item = Vec<String>>) {
        let field = |cell: &Cell| match cell {
            Cell::Number(number)
            | Cell::Error(number)
            | Cell::Uncertainty(number)
            | Cell::Angle(number)
            | Cell::Change(number) => files::number(*number),
            Cell::AngleUnit => "rad".to_owned(),
            Cell::Empty => String::new(),
            other => other.text(),
        };
        (self.headers().into_iter(), self.rows.iter().map(move |row| row.iter().map(field).collect()))
    }

    /// The table in Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let sides = (0..self.headings.len()).map(|column| if self.numeric(column) { "---:" } else { "---" }.to_owned());
        let text = |cell: &Cell| cell.with_digits(DIGITS_OF_DOCUMENTS);
        let rows = self.rows.iter().map(|row| line(row.iter().map(text).collect()));
        [line(self.headers()), line(sides.collect())].into_iter().chain(rows).collect()
    }

    /// Prints its first rows for people.
    fn print(&self, most: usize, out: &mut dyn Write) -> Outcome<()> {
        writeln!(out, "{}", self.title)?;
        let headers = self.headers();
        let texts: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::text).collect()).collect();
        let width = |column: usize| {
            let cells = texts.iter().filter_map(|row| row.get(column)).map(|text| text.chars().count());
            cells.chain([headers[column].chars().count()]).max().unwrap_or(0)
        };
        let mut line = |cells: &mut dyn Iterator<Item = &str>| -> Outcome<()> {
            let padded = cells.enumerate().map(|(column, cell)| {
                let width = width(column);
                if self.numeric(column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
            });
            Ok(writeln!(out, "  {}", padded.collect::<Vec<_>>().join("  ").trim_end())?)
        };
        line(&mut headers.iter().map(String::as_str))?;
        for row in texts.iter().take(most) {
            line(&mut row.iter().map(String::as_str))?;
        }
        if texts.len() > most {
            writeln!(out, "  … {} more rows with `--all`", texts.len() - most)?;
        }
        Ok(())
    }
}

/// A named value.
#[derive(Clone, Debug)]
struct Fact {
    name: String,
    value: Cell,
    unit: String,
    /// Its key in JSON; `None` where programs get the same in another form.
    key: Option<String>,
}

/// Facts and tables in order.
#[derive(Clone, Debug, Default)]
pub struct Report {
    facts: Vec<Fact>,
    /// Values for programs alone.
    values: Map<String, Value>,
    cautions: Vec<String>,
    /// Tables, and how many of their rows people see unless they ask for all.
    grids: Vec<(Grid, usize)>,
    all: bool,
}

impl Report {
    /// Adds a fact with its unit.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<Cell>, unit: impl Into<String>) {
        let name = name.into();
        self.fact_as(&name.replace(' ', "_"), name, value, unit);
    }

    /// Adds a fact whose key in JSON is not its name.
    pub fn fact_as(&mut self, key: &str, name: impl Into<String>, value: impl Into<Cell>, unit: impl Into<String>) {
        self.facts.push(Fact { name: name.into(), value: value.into(), unit: unit.into(), key: Some(key.to_owned()) });
    }

    /// Adds a fact for people; programs get the same by [`Report::value`].
    pub fn line(&mut self, name: impl Into<String>, value: impl Into<Cell>, unit: impl Into<String>) {
        self.facts.push(Fact { name: name.into(), value: value.into(), unit: unit.into(), key: None });
    }

    /// Adds a value for programs.
    pub fn value(&mut self, key: &str, value: impl Into<Value>) {
        self.values.insert(key.to_owned(), value.into());
    }

    /// Adds a warning, if there is one.
    pub fn caution(&mut self, words: Option<impl Into<String>>) {
        self.cautions.extend(words.map(Into::into));
    }

    /// Adds a table. People do not see it if it has no rows.
    pub fn grid(&mut self, grid: Grid) {
        self.excerpt(grid, usize::MAX);
    }

    /// Adds a table before all others.
    pub fn grid_first(&mut self, grid: Grid) {
        self.grids.insert(0, (grid, usize::MAX));
    }

    /// Adds a table of which people see some rows, or none, unless they ask for all.
    pub fn excerpt(&mut self, grid: Grid, rows: usize) {
        self.grids.push((grid, rows));
    }

    /// The tables that have rows, and how many of them people see unless they ask for all.
    fn filled(&self) -> impl Iterator<Item = &(Grid, usize)> {
        self.grids.iter().filter(|(grid, _)| !grid.rows.is_empty())
    }

    /// Whether people want to see all tables whole.
    pub fn show_all(&mut self, all: bool) {
        self.all = all;
    }

    /// The facts as a list in Markdown.
    pub fn markdown(&self) -> String {
        let line = |Fact { name, value, unit, .. }: &Fact| {
            format!("* {name}: {} {unit}", value.text()).trim_end().to_owned() + "\n"
        };
        self.facts.iter().map(line).collect()
    }

    /// Facts and tables as printed, for a page.
    pub fn page(&self) -> Value {
        let facts: Vec<_> = self
            .facts
            .iter()
            .map(|Fact { name, value, unit, .. }| [name.clone(), value.text(), unit.clone()])
            .chain(self.cautions.iter().map(|words| ["caution", words, ""].map(str::to_owned)))
            .collect();
        json!({"facts": facts, "grids": self.filled().map(|(grid, _)| grid.page()).collect::<Vec<_>>()})
    }

    /// Prints it in the form asked for.
    ///
    /// # Errors
    /// The output is closed.
    pub fn print(&self, format: Format, out: &mut dyn Write) -> Outcome<()> {
        match format {
            Format::Json => Ok(writeln!(out, "{:#}", self.json())?),
            Format::Table => {
                let width = self.facts.iter().map(|fact| fact.name.chars().count()).max().unwrap_or(0);
                for Fact { name, value, unit, .. } in &self.facts {
                    writeln!(out, "{}", format!("{name:<width$}  {} {unit}", value.text()).trim_end())?;
                }
                for words in &self.cautions {
                    writeln!(out, "caution: {words}")?;
                }
                let seen = |rows: usize| if self.all { usize::MAX } else { rows };
                let shown = self.filled().filter(|(_, rows)| seen(*rows) > 0);
                for (index, (grid, rows)) in shown.enumerate() {
                    if index > 0 || !self.facts.is_empty() || !self.cautions.is_empty() {
                        writeln!(out)?;
                    }
                    grid.print(seen(*rows), out)?;
                }
                let hidden = self.filled().filter(|(_, rows)| seen(*rows) == 0);
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

    /// Facts, cautions and tables by name; `units` has the units of facts by their names, and those of columns by table and name.
    fn json(&self) -> Value {
        let mut object = self.values.clone();
        let mut units = Map::new();
        for Fact { key, value, unit, .. } in &self.facts {
            let Some(key) = key else { continue };
            if !unit.is_empty() {
                units.insert(key.clone(), unit.as_str().into());
            }
            object.insert(key.clone(), value.json());
        }
        for (grid, _) in &self.grids {
            let of_columns = grid.units();
            if !of_columns.is_empty() {
                units.insert(grid.key.to_owned(), of_columns.into());
            }
            object.insert(grid.key.to_owned(), grid.json());
        }
        object.insert("cautions".to_owned(), self.cautions.as_slice().into());
        object.insert("units".to_owned(), units.into());
        object.insert("format".to_owned(), FORMAT.into());
        object.into()
    }
}

/// Version of the form of JSON: it grows when a key changes its meaning or goes.
pub const FORMAT: u32 = 1;

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
    fn programs_read_fixed_keys_with_units_apart() {
        let mut report = Report::default();
        report.fact("mean step", 0.01, "s");
        report.line("mast", "at rest", "");
        report.value("stable", true);
        let headings =
            vec!["mode".into(), Heading::of("rigid", "frequency [Hz]"), Heading::of("flexible", "frequency [Hz]")];
        let mut grid = Grid::with_headings("modes", "Modes", headings);
        assert_eq!(grid.headers(), ["mode", "rigid frequency [Hz]", "flexible frequency [Hz]"]);
        grid.row([1_usize.into(), 2.5.into(), Cell::Empty]);
        report.grid(grid);
        report.grid(Grid::new("feet", "Feet", &["foot"]));
        let expected = json!({
            "format": 1,
            "mean_step": 0.01,
            "stable": true,
            "modes": [{"mode": 1, "frequency": {"rigid": 2.5, "flexible": null}}],
            "feet": [],
            "cautions": [],
            "units": {"mean_step": "s", "modes": {"frequency": "Hz"}},
        });
        assert_eq!(report.json(), expected);
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
