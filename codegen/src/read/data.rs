//! Tables from files: columns of CSV files take the place of `times` and `values`.

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::diagnostic::{Mistake, SourceFile, SourcePart, Span, rule};
use crate::node::{Content, Node};
use crate::units::{Quantity, Unit, UnknownUnit, name_and_unit};

/// Maximum number of rows: each becomes a polynomial that is evaluated at every step.
const MOST: usize = 1000;
/// Key whose value may name a file.
const TABLE: &str = "table";
/// Names of the files that tables of a spec refer to, with their locations.
pub(super) fn files(tree: &Node) -> Vec<(&str, Span)> {
    let of_children = || children(tree).flat_map(files);
    match &tree.content {
        Content::Mapping(entries) => {
            let of_parts =
                entries.iter().filter(|(key, _)| key.key_text() == TABLE).filter_map(|(_, table)| table.text("file"));
            of_parts.chain(of_children()).collect()
        }
        _ => of_children().collect(),
    }
}

fn children(node: &Node) -> Box<dyn Iterator<Item = &Node> + '_> {
    match &node.content {
        Content::Sequence(items) => Box::new(items.iter()),
        Content::Mapping(entries) => Box::new(entries.iter().map(|(_, value)| value)),
        _ => Box::new(std::iter::empty()),
    }
}

/// Adds `times` and `values` to all tables that name a file.
pub(super) fn fill(tree: &mut Node, source: &SourceFile, mistakes: &mut Vec<Mistake>) {
    match &mut tree.content {
        Content::Sequence(items) => items.iter_mut().for_each(|item| fill(item, source, mistakes)),
        Content::Mapping(entries) => {
            for (key, value) in entries {
                if key.key_text() == TABLE {
                    fill_table(value, source, mistakes);
                }
                fill(value, source, mistakes);
            }
        }
        _ => (),
    }
}

fn fill_table(table: &mut Node, source: &SourceFile, mistakes: &mut Vec<Mistake>) {
    let Some((file, span)) = table.text("file") else { return };
    if let Some(written) = ["times", "values"].iter().find_map(|key| table.entry(key)) {
        let [of_file, of_list] = [span, written.span].map(|span| source.part(span.start).start);
        if of_file == of_list {
            mistakes.push(rule::table_twice(span));
            return;
        }
        // What an extending spec writes replaces what the extended spec has.
        let replaced = if of_file < of_list { ["file", "column"] } else { ["times", "values"] };
        table.remove(&replaced);
        return fill_table(table, source, mistakes);
    }
    let filled = match source.data(file, span.start) {
        Some(data) => columns(&data, (file, span), table.text("column")),
        None => Err(rule::no_data(span, file, "this spec is text, not a file, so there is no folder to look in")),
    };
    match (filled, &mut table.content) {
        (Ok(columns), Content::Mapping(entries)) => {
            for (name, items) in ["times", "values"].into_iter().zip(columns) {
                let node = |content| Node { span, content };
                entries.push((node(Content::Text(name.to_owned())), node(Content::Sequence(items))));
            }
        }
        (filled, _) => mistakes.extend(filled.err()),
    }
}

impl Node {
    fn remove(&mut self, keys: &[&str]) {
        if let Content::Mapping(entries) = &mut self.content {
            entries.retain(|(key, _)| !keys.contains(&key.key_text().as_str()));
        }
    }

    /// The text of an entry, and its location.
    fn text(&self, key: &str) -> Option<(&str, Span)> {
        let value = self.entry(key)?;
        match &value.content {
            Content::Text(text) => Some((text, value.span)),
            _ => None,
        }
    }
}

/// Times and values of a file: its first column, and the one that is asked for, or the second.
fn columns(
    data: &SourcePart<'_>,
    (file, at): (&str, Span),
    column: Option<(&str, Span)>,
) -> Result<[Vec<Node>; 2], Mistake> {
    // Spreadsheets mark UTF-8 by a first character that is not part of the table.
    let text = data.text.strip_prefix('\u{feff}').unwrap_or(data.text);
    let data = &SourcePart { text, start: data.start + data.text.len() - text.len(), ..*data };
    if let Some(with) = other_separators(text) {
        return Err(rule::data_separators(at, file, with));
    }
    let mut reader = ReaderBuilder::new().has_headers(false).trim(Trim::All).from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for row in reader.records() {
        rows.push(row.map_err(|error| rule::no_data(at, file, problem(&error)))?);
    }
    let Some(first) = rows.first() else { return Err(rule::no_data(at, file, "it is empty")) };
    // An empty cell may end a row.
    let has_header = first.iter().all(|cell| cell.parse::<f64>().is_err());
    let names: Vec<_> = first.iter().map(name_and_unit).filter(|_| has_header).collect();
    let column = match column {
        Some((wanted, span)) => {
            let mut places =
                names.iter().enumerate().skip(1).filter(|(_, (name, _))| *name == wanted).map(|(column, _)| column);
            let known = || names.iter().skip(1).map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            let known = || if has_header { known() } else { "no names".into() };
            let column = places.next().ok_or_else(|| rule::data_column(span, file, wanted, known()))?;
            if places.next().is_some() {
                return Err(rule::no_data(at, file, format!("it has several columns `{wanted}`")));
            }
            column
        }
        None => 1,
    };
    if first.len() < 2 {
        return Err(rule::no_data(at, file, "it has a single column; columns are separated by commas"));
    }
    let unit_of = |column: usize| {
        let Some((name, Some(unit))) =
            names.get(column).copied().filter(|(_, unit)| unit.is_some_and(|unit| !["", "1"].contains(&unit)))
        else {
            return Ok(None);
        };
        match Unit::parse(unit) {
            Ok(_) => Ok(Some(unit)),
            Err(UnknownUnit { help, .. }) => Err(rule::data_unit(at, file, name, unit, help)),
        }
    };
    let units = [unit_of(0)?, unit_of(column)?];
    let rows = &rows[usize::from(has_header)..];
    if rows.len() > MOST {
        return Err(rule::long_table(at, file, rows.len(), MOST, rows.len().div_ceil(MOST)));
    }
    let numbers = |column: usize, unit: Option<&str>| {
        let mut numbers = rows.iter().map(|row| number(data, row, column, unit)).collect::<Result<Vec<_>, _>>()?;
        // The first one keeps its unit: its dimension is checked where the table stands.
        if let (Some(unit), Some(row), Some(first)) = (unit, rows.first(), numbers.first_mut()) {
            first.content = Content::Text(format!("{} {unit}", row.get(column).unwrap_or_default()));
        }
        Ok::<_, Mistake>(numbers)
    };
    Ok([numbers(0, units[0])?, numbers(column, units[1])?])
}

/// A cell as a number, in SI units.
fn number(data: &SourcePart<'_>, row: &StringRecord, column: usize, unit: Option<&str>) -> Result<Node, Mistake> {
    let cell = row.get(column).unwrap_or_default();
    let begin = row.position().map_or(0, |position| usize::try_from(position.byte()).unwrap_or(0));
    let line = data.text.get(begin..).and_then(|rest| rest.lines().next()).unwrap_or_default();
    let span = Span { start: data.start + begin, end: data.start + begin + line.len() };
    let shown = if cell.is_empty() { "an empty cell".to_owned() } else { format!("`{cell}`") };
    let help = || match Quantity::parse(cell) {
        Some(Ok(_)) => "write the unit once, in brackets behind the name of the column: `boom [deg]`".to_owned(),
        _ => "write numbers with a decimal point, and commas between columns".to_owned(),
    };
    let mut number: f64 = cell.parse().map_err(|_| rule::data_number(span, shown, column + 1, help()))?;
    if let Some(Some(Ok(quantity))) = unit.map(|unit| Quantity::parse(&format!("{cell} {unit}"))) {
        number = quantity.value;
    }
    Ok(Node { span, content: Content::Number(number) })
}

/// What separates columns, if it is not commas: spreadsheets whose numbers have decimal commas write semicolons.
fn other_separators(text: &str) -> Option<&'static str> {
    let line = text.lines().find(|line| !line.trim().is_empty())?;
    let has_decimal_commas = || {
        let commas = text.match_indices(',').map(|(at, _)| [&text[..at], &text[at + 1..]]);
        commas.into_iter().any(|[before, after]| {
            before.ends_with(|c: char| c.is_ascii_digit()) && after.starts_with(|c: char| c.is_ascii_digit())
        })
    };
    match (line.contains(';'), line.contains('\t'), line.contains(',')) {
        (true, ..) if has_decimal_commas() => Some("semicolons between columns, and decimal commas"),
        (true, ..) => Some("semicolons between columns"),
        (_, true, false) => Some("tabs between columns"),
        _ => None,
    }
}

/// What is wrong with a file, in words.
fn problem(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            let columns = if *len == 1 { "column" } else { "columns" };
            format!("line {line} has {len} {columns} instead of {expected_len}")
        }
        _ => error.to_string(),
    }
}
