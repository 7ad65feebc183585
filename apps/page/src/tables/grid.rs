//! Tables with named columns: printed, as JSON, as Markdown and for a page.

use std::{
    fmt,
    io::{self, Write},
};

use crane_codegen::exchange::xml::escaped;
use serde_json::{Map, Value, json};

use super::cell::{Cell, DIGITS_OF_DOCUMENTS, number_text, si};

/// The heading of a column.
#[derive(Clone, Debug)]
pub struct Heading {
    /// Which of several cranes, or of several cases, the column is about; empty if there is one.
    label: String,
    name: String,
    /// Unit of all its numbers; empty where there is none or each row has its own.
    unit: String,
}

/// Name of a column that its label describes completely, and label of a single crane.
pub const VALUE: &str = "value";

impl Heading {
    /// The heading of a column about one of several things; about the only one if the label is [`VALUE`].
    pub fn about(label: &str, name: &str) -> Self {
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
    pub(super) key: &'static str,
    pub(super) title: String,
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
    pub(super) fn headers(&self) -> Vec<String> {
        self.headings.iter().map(ToString::to_string).collect()
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl Into<Vec<Cell>>) {
        self.rows.push(cells.into());
    }

    /// Whether it has no rows.
    pub(super) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Its name in JSON.
    pub fn key(&self) -> &'static str {
        self.key
    }

    /// Rows as objects. Columns about one of several things are objects by label.
    pub(super) fn json(&self) -> Value {
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
    pub(super) fn units(&self) -> Map<String, Value> {
        let with_unit = self.headings.iter().filter(|heading| !heading.unit.is_empty());
        with_unit.map(|heading| (heading.key(), si(&heading.unit).into())).collect()
    }

    /// Whether a column contains only numbers.
    fn numeric(&self, column: usize) -> bool {
        self.rows
            .iter()
            .all(|row| !matches!(row.get(column), Some(Cell::Text(_) | Cell::Names(_) | Cell::ShownUnit(_))))
            && !self.rows.is_empty()
    }

    /// Its texts as printed, for a page, and what they leave out.
    pub(super) fn page(&self) -> Value {
        let numeric: Vec<bool> = (0..self.headings.len()).map(|column| self.numeric(column)).collect();
        let rows: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::short).collect()).collect();
        let exact: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(Cell::exact).collect()).collect();
        json!({
            "key": self.key, "title": self.title, "headers": self.headers(), "numeric": numeric, "rows": rows, "exact": exact,
        })
    }

    /// Names of the columns, and rows of fields with all digits, for a CSV file, in SI.
    pub fn fields(&self) -> (impl Iterator<Item = String>, impl Iterator<Item = Vec<String>>) {
        let field = |cell: &Cell| match cell {
            Cell::Number(number)
            | Cell::Error(number)
            | Cell::Uncertainty(number)
            | Cell::Shown(number, _)
            | Cell::ShownUncertainty(number, _)
            | Cell::Change(number) => number_text(*number),
            Cell::ShownUnit(scale) => scale.si().to_owned(),
            Cell::Empty => String::new(),
            other => other.text(),
        };
        let in_si = |heading: &Heading| Heading { unit: si(&heading.unit).to_owned(), ..heading.clone() }.to_string();
        let headers: Vec<String> = self.headings.iter().map(in_si).collect();
        (headers.into_iter(), self.rows.iter().map(move |row| row.iter().map(field).collect()))
    }

    /// The table in Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let sides = (0..self.headings.len()).map(|column| if self.numeric(column) { "---:" } else { "---" }.to_owned());
        let text = |cell: &Cell| cell.with_digits(DIGITS_OF_DOCUMENTS);
        let rows = self.rows.iter().map(|row| line(row.iter().map(text).collect()));
        [line(self.headers()), line(sides.collect())].into_iter().chain(rows).collect()
    }

    /// Its first rows as a figure of a page, or all of it.
    pub(super) fn html(&self, most: usize) -> String {
        /// More columns than this are set in smaller letters.
        const MANY: usize = 8;
        let class = if self.headings.len() > MANY { " class=\"wide\"" } else { "" };
        let numeric: Vec<bool> = (0..self.headings.len()).map(|column| self.numeric(column)).collect();
        let line = |tag: &str, cells: &mut dyn Iterator<Item = String>| {
            let cells = cells.zip(&numeric).map(|(cell, is_number)| {
                let side = if *is_number { " class=\"n\"" } else { "" };
                format!("<{tag}{side}>{}</{tag}>", escaped(&cell))
            });
            format!("<tr>{}</tr>\n", cells.collect::<String>())
        };
        let head = line("th", &mut self.headers().into_iter());
        let rows: String = self.rows.iter().take(most).map(|row| line("td", &mut row.iter().map(Cell::text))).collect();
        let more = match self.rows.len().saturating_sub(most) {
            0 => String::new(),
            more => format!("<p class=\"more\">{more} more rows with <code>--all</code></p>\n"),
        };
        let title = escaped(&self.title);
        format!(
            "<figure class=\"table\">\n<figcaption>{title}</figcaption>\n<table{class}>\n<thead>\n{head}</thead>\n<tbody>\n{rows}</tbody>\n</table>\n{more}</figure>\n"
        )
    }

    /// Prints its first rows for people, or all of it.
    pub(super) fn print(&self, most: usize, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "{}", self.title)?;
        let headers = self.headers();
        let text = if most == usize::MAX { Cell::text } else { Cell::short };
        let texts: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(text).collect()).collect();
        let width = |column: usize| {
            let cells = texts.iter().filter_map(|row| row.get(column)).map(|text| text.chars().count());
            cells.chain([headers[column].chars().count()]).max().unwrap_or(0)
        };
        let mut line = |cells: &mut dyn Iterator<Item = &str>| {
            let padded = cells.enumerate().map(|(column, cell)| {
                let width = width(column);
                if self.numeric(column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
            });
            writeln!(out, "  {}", padded.collect::<Vec<_>>().join("  ").trim_end())
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
