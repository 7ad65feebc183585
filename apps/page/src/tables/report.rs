//! Results: facts, cautions and tables, for people and the same as JSON for programs.

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use crane_codegen::exchange::xml::escaped;

use super::{Cell, Grid, cell::si};

/// A named value.
#[derive(Clone, Debug)]
struct Fact {
    name: String,
    value: Cell,
    unit: String,
    /// Its key in JSON; `None` where programs get the same in another form.
    key: Option<String>,
}

/// Key of tables that programs do not get.
const FOR_PEOPLE: &str = "";

/// Facts and tables in order.
#[derive(Clone, Debug, Default)]
pub struct Report {
    facts: Vec<Fact>,
    /// Values for programs alone.
    values: Map<String, Value>,
    cautions: Vec<String>,
    /// Tables, and how many of their rows people see unless they ask for all.
    grids: Vec<(Grid, usize)>,
    /// Tables for programs alone.
    data: Vec<Grid>,
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

    /// Adds a warning, if there is one that is not there yet: what holds at rest often holds during a run, too.
    pub fn caution(&mut self, words: Option<impl Into<String>>) {
        self.cautions.extend(words.map(Into::into).filter(|words| !self.cautions.contains(words)));
    }

    /// Whether there are warnings.
    #[must_use]
    pub fn has_cautions(&self) -> bool {
        !self.cautions.is_empty()
    }

    /// Adds a table. People do not see it if it has no rows.
    pub fn grid(&mut self, grid: Grid) {
        self.excerpt(grid, usize::MAX);
    }

    /// Adds what another one has.
    pub fn append(&mut self, other: Report) {
        let Report { facts, values, cautions, grids, data, all: _ } = other;
        self.facts.extend(facts);
        self.values.extend(values);
        self.grids.extend(grids);
        self.data.extend(data);
        for words in cautions {
            self.caution(Some(words));
        }
    }

    /// Adds a table before all others.
    pub fn grid_first(&mut self, grid: Grid) {
        self.grids.insert(0, (grid, usize::MAX));
    }

    /// Adds a table for people; programs get the same by [`Report::data`].
    pub fn shown(&mut self, mut grid: Grid) {
        grid.key = FOR_PEOPLE;
        self.grid(grid);
    }

    /// Adds a table for programs alone.
    pub fn data(&mut self, grid: Grid) {
        self.data.push(grid);
    }

    /// Adds a table of which people see some rows, or none, unless they ask for all.
    pub fn excerpt(&mut self, grid: Grid, rows: usize) {
        self.grids.push((grid, rows));
    }

    /// The tables that have rows, and how many of them people see unless they ask for all.
    fn filled(&self) -> impl Iterator<Item = &(Grid, usize)> {
        self.grids.iter().filter(|(grid, _)| !grid.is_empty())
    }

    /// Sets whether all tables are printed in full.
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
    pub(crate) fn page(&self) -> Value {
        let facts: Vec<_> = self
            .facts
            .iter()
            .map(|Fact { name, value, unit, .. }| [name.clone(), value.text(), unit.clone()])
            .chain(self.cautions.iter().map(|words| ["caution", words, ""].map(str::to_owned)))
            .collect();
        json!({"facts": facts, "grids": self.filled().map(|(grid, _)| grid.page()).collect::<Vec<_>>()})
    }

    /// Facts, cautions and tables as a section of a page; of each table as many rows as people see.
    #[must_use]
    pub fn html(&self) -> String {
        let facts = self.facts.iter().map(|Fact { name, value, unit, .. }| {
            let value = format!("{} {unit}", value.text());
            format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escaped(name), escaped(value.trim_end()))
        });
        let facts = match facts.collect::<String>() {
            none if none.is_empty() => none,
            rows => format!("<table class=\"facts\">\n{rows}</table>\n"),
        };
        let cautions =
            self.cautions.iter().map(|words| format!("<p class=\"caution\">caution: {}</p>\n", escaped(words)));
        let seen = |rows: usize| if self.all { usize::MAX } else { rows };
        let shown = self.filled().filter(|(_, rows)| seen(*rows) > 0);
        let tables = shown.map(|(grid, rows)| grid.html(seen(*rows)));
        std::iter::once(facts).chain(cautions).chain(tables).collect()
    }

    /// Prints it for people, as the command does.
    ///
    /// # Errors
    /// The output is closed.
    pub fn print(&self, out: &mut dyn Write) -> io::Result<()> {
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
        // What the table is, without how to read it.
        let hidden: Vec<&str> = hidden
            .map(|(grid, _)| grid.title.split([',', ':', '(']).map(str::trim_end).next().unwrap_or_default())
            .collect();
        if !hidden.is_empty() {
            writeln!(out, "\nWith `--all` also: {}", hidden.join("; "))?;
        }
        Ok(())
    }

    /// Facts, cautions and tables by name; `units` has the units of facts by their names, and those of columns by table and name.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut object = self.values.clone();
        let mut units = Map::new();
        for Fact { key, value, unit, .. } in &self.facts {
            let Some(key) = key else { continue };
            if !unit.is_empty() {
                units.insert(key.clone(), si(unit).into());
            }
            object.insert(key.clone(), value.json());
        }
        let for_programs = self.grids.iter().map(|(grid, _)| grid).filter(|grid| grid.key != FOR_PEOPLE);
        for grid in for_programs.chain(&self.data) {
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

/// Version of the form of JSON: it increases when a key changes its meaning or is removed.
pub const FORMAT: u32 = 2;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::Heading;

    #[test]
    fn programs_read_fixed_keys_with_units_apart() {
        let mut report = Report::default();
        report.fact("mean step", 0.01, "s");
        report.line("mast", "at rest", "");
        report.value("stable", true);
        let headings = vec![
            "mode".into(),
            Heading::about("rigid", "frequency [Hz]"),
            Heading::about("flexible", "frequency [Hz]"),
        ];
        let mut grid = Grid::with_headings("modes", "Modes", headings);
        assert_eq!(grid.headers(), ["mode", "rigid frequency [Hz]", "flexible frequency [Hz]"]);
        grid.row([1_usize.into(), 2.5.into(), Cell::Empty]);
        report.grid(grid);
        report.grid(Grid::new("feet", "Feet", &["foot"]));
        let expected = json!({
            "format": 2,
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
            report.print(&mut out).expect("it prints");
            String::from_utf8(out).expect("text")
        };
        let short = printed(false);
        assert!(short.starts_with("Peaks\n") && short.contains("… 3 more rows with `--all`"), "{short}");
        assert!(short.ends_with("\nWith `--all` also: Pose\n"), "{short}");
        assert_eq!(printed(true).lines().filter(|line| line.trim() == "4").count(), 3);
    }
}
