//! Tables of what moves what.

use crane_live::sensitivity::Group;
use crane_model::DisplayUnit;
use crane_page::tables::{Cell, Grid, Heading, number_text};

use super::Changes;

/// Parameters of an output that a table shows unless all are asked for.
const MOST: usize = 3;
/// Numbers that have a column unless all are asked for.
const COLUMNS: usize = 5;
/// Letters of the longest bar.
const BAR: usize = 20;

/// The numbers that change, the most influential first.
pub fn parameters(changes: &Changes) -> Grid {
    let title = "Numbers, the most influential first: influence is the largest relative change of an output below";
    let headings = ["parameter", "value", "unit", "change", "influence [%]", "method"];
    let mut grid = Grid::new("parameters", title, &headings);
    for &index in &changes.order {
        let number = &changes.numbers[index];
        let method = if number.errors.is_some() { "differences" } else { "exact" };
        grid.row([
            Cell::from(number.label.as_str()),
            number.value.into(),
            number.unit.as_str().into(),
            number.step.into(),
            Cell::Change(changes.influence(index)),
            method.into(),
        ]);
    }
    grid
}

/// The outputs at rest, and where those are that govern.
pub fn outputs(changes: &Changes) -> Grid {
    let title = if changes.is_of_run() { "Outputs of the run" } else { "Outputs at rest" };
    let mut grid = Grid::new("outputs", title, &["output", "group", "value", "unit", "place"]);
    for &index in &changes.shown {
        let output = &changes.found.outputs[index];
        let value = Cell::from(changes.found.values[index]);
        let words: [Cell; 2] = [output.name.as_str().into(), output.group.name().into()];
        grid.row(
            words.into_iter().chain([value, output.unit.into(), output.place.as_str().into()]).collect::<Vec<_>>(),
        );
    }
    grid
}

/// A row per output, a column per number, of which there are few unless all are asked for.
pub fn matrix(changes: &Changes, all: bool) -> Grid {
    let most = if all { usize::MAX } else { COLUMNS };
    let numbers: Vec<usize> = changes.order.iter().copied().take(most).collect();
    let title = if numbers.len() < changes.order.len() {
        format!(
            "Changes of outputs with each of the {} most influential numbers; with `--all` with each",
            numbers.len()
        )
    } else {
        "Changes of outputs with each number".to_owned()
    };
    let names: Vec<&str> = numbers.iter().map(|&place| changes.numbers[place].label.as_str()).collect();
    let labels = short_labels(&names);
    let labels = labels.iter().map(|label| Heading::about(label, "value"));
    let value = if changes.is_of_run() { "in the run" } else { "at rest" };
    let headings = ["output".into(), value.into()].into_iter().chain(labels).chain(["unit".into(), "where".into()]);
    let mut grid = Grid::with_headings("", title, headings.collect());
    for &index in &changes.shown {
        let output = &changes.found.outputs[index];
        let (scale, unit) = readable(output.unit, output.group);
        let values = numbers.iter().map(|&place| Cell::from(scale * changes.change(place, index)));
        let first: [Cell; 2] = [output.name.as_str().into(), (scale * changes.found.values[index]).into()];
        let last: [Cell; 2] = [unit.into(), output.place.as_str().into()];
        grid.row(first.into_iter().chain(values).chain(last).collect::<Vec<_>>());
    }
    grid
}

/// The shortest ends of places that differ from each other and begin with a word.
fn short_labels(names: &[&str]) -> Vec<String> {
    let ends = |name: &str| -> Vec<String> {
        let keys: Vec<&str> = name.split('.').collect();
        let begins = (0..keys.len()).rev().filter(|&begin| keys[begin].parse::<usize>().is_err());
        begins.map(|begin| keys[begin..].join(".")).collect()
    };
    let is_of = |name: &str, end: &str| name == end || name.ends_with(&format!(".{end}"));
    let short = |(index, name): (usize, &&str)| {
        let is_own = |end: &String| !names.iter().enumerate().any(|(other, name)| other != index && is_of(name, end));
        ends(name).into_iter().find(is_own).unwrap_or_else(|| (*name).to_owned())
    };
    names.iter().enumerate().map(short).collect()
}

/// Factor and unit in which people read a quantity.
pub fn readable(unit: &'static str, group: Group) -> (f64, &'static str) {
    let display = match (unit, group) {
        ("Pa", Group::Stresses) => Some(DisplayUnit::Megapascal),
        ("m", _) => Some(DisplayUnit::Millimetre),
        _ => DisplayUnit::always(unit),
    };
    // People need no unit of a ratio.
    let unit = if unit == "1" { "" } else { unit };
    display.map_or((1.0, unit), |display| (display.shown(1.0), display.unit()))
}

/// All changes, for programs.
pub fn changes(changes: &Changes) -> Grid {
    let headings = ["output", "parameter", "derivative", "error", "change", "unit", "relative [%]"];
    let mut grid = Grid::new("changes", "Changes", &headings);
    for (index, place) in changes.shown.iter().flat_map(|&index| changes.order.iter().map(move |&place| (index, place)))
    {
        let output = &changes.found.outputs[index];
        let number = &changes.numbers[place];
        let error = number.errors.as_ref().and_then(|errors| errors.get(index));
        grid.row([
            Cell::from(output.name.as_str()),
            number.label.as_str().into(),
            changes.found.derivatives[place][index].into(),
            error.map_or(Cell::Empty, |error| Cell::Number(*error)),
            changes.change(place, index).into(),
            output.unit.into(),
            changes.relative(place, index).map_or(Cell::Empty, Cell::Change),
        ]);
    }
    grid
}

/// What moves what: for every output the numbers that move it most, with bars.
pub fn bars(changes: &Changes, all: bool) -> Grid {
    /// A relative change that is printed as 0.00 %: rounding gets no bar.
    const NOTHING: f64 = 5e-5;
    let title = "What moves what: relative changes, for every output the largest first";
    let mut grid = Grid::new("bars", title, &["output", "parameter", "relative [%]", ""]);
    let pairs = || changes.shown.iter().flat_map(|&output| changes.order.iter().map(move |&place| (place, output)));
    let shares = pairs().filter_map(|(place, output)| changes.relative(place, output));
    let greatest = shares.fold(NOTHING, |size: f64, share| size.max(share.abs()));
    for &index in &changes.shown {
        let share = |place: usize| changes.relative(place, index).map(|share| (place, share));
        let mut shares: Vec<(usize, f64)> = changes.order.iter().filter_map(|&place| share(place)).collect();
        shares.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        let mut name = changes.found.outputs[index].name.as_str();
        for (place, share) in shares.into_iter().take(if all { usize::MAX } else { MOST }) {
            let parameter = changes.numbers[place].label.as_str().into();
            grid.row([name.into(), parameter, Cell::Change(share), bar(share / greatest).into()]);
            name = "";
        }
    }
    grid
}

/// A bar for a share from −1 to 1, with its sign.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of letters")]
fn bar(share: f64) -> String {
    let eighths = (share.abs() * (8 * BAR) as f64).round() as usize;
    let part = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"][eighths % 8];
    let sign = if eighths == 0 {
        ""
    } else if share < 0.0 {
        "−"
    } else {
        "+"
    };
    format!("{sign}{}{part}", "█".repeat(eighths / 8))
}

/// A header and a row per number for a file, in SI: its name, value, unit and change, then the changes of all outputs.
pub fn rows(changes: &Changes) -> (Vec<String>, Vec<Vec<String>>) {
    let with_unit = |name: &str, unit: &str| if unit.is_empty() { name.to_owned() } else { format!("{name} [{unit}]") };
    let outputs = changes.shown.iter().map(|&index| &changes.found.outputs[index]);
    let names = outputs.map(|output| with_unit(&output.name, output.unit));
    let header = ["parameter", "value", "unit", "change"].map(str::to_owned).into_iter().chain(names).collect();
    let row = |&place: &usize| {
        let number = &changes.numbers[place];
        let own = [number.label.clone(), number_text(number.value), number.unit.clone(), number_text(number.step)];
        own.into_iter().chain(changes.shown.iter().map(|&index| number_text(changes.change(place, index)))).collect()
    };
    (header, changes.order.iter().map(row).collect())
}
