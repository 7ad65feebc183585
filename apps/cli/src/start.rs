//! Where a run of the command starts: at rest in equilibrium, from given values, or from the end of another run.

use std::path::Path;

use crane_model::{
    ColumnKind, CoordinateRole, Description,
    dyn_crane::DynCrane,
    force_states::{self, ForceStates},
    loop_joints::Given,
    results::{Column, quantities},
    runs::Start,
};

use crate::{
    arguments::Timing,
    files,
    problem::{Outcome, Problem, nearest},
    quantity::number,
    screen::Console,
};

/// Suffix of a coordinate's name in the name of its rate.
const RATE: &str = ColumnKind::Rate.endings(false)[0];

/// Difference from the motion of a rigid drive above which a start contradicts it, m, rad and their rates.
const PRESCRIBED: f64 = 1e-9;
/// What closing a loop changes beyond this is said, m, rad and their rates.
const MOVED: f64 = 1e-6;

/// A coordinate, its rate, or a state of a force, by its index.
#[derive(Clone, Copy)]
pub enum Variable {
    /// A coordinate.
    Position(usize),
    /// The rate of a coordinate.
    Rate(usize),
    /// A state of a force: of the oil, or the deflection of bristles.
    ForceState(usize),
}

impl Variable {
    /// The variable that a column of results contains.
    fn find(name: &str, description: &Description) -> Option<Self> {
        let index_of = |name: &str| description.coordinates.iter().position(|coordinate| coordinate.name == name);
        let rate = || name.strip_suffix(RATE).and_then(index_of).map(Self::Rate);
        let force_state =
            || force_states::columns(description).iter().position(|column| column == name).map(Self::ForceState);
        index_of(name).map(Self::Position).or_else(rate).or_else(force_state)
    }

    /// The variable that an option names.
    ///
    /// # Errors
    /// The crane has no such coordinate.
    pub fn named(name: &str, description: &Description) -> Outcome<Self> {
        Self::find(name, description).ok_or_else(|| unknown(name, description))
    }

    /// Adds it to what is given.
    fn give(self, given: &mut Given) {
        match self {
            Self::Position(index) => given.positions.push(index),
            Self::Rate(index) => given.rates.push(index),
            Self::ForceState(_) => {}
        }
    }

    /// What a rigid drive makes of it in a start, if one prescribes its coordinate.
    fn find_prescribed(self, start: &Start, description: &Description) -> Option<f64> {
        let (index, value) = match self {
            Self::Position(index) => (index, start.q[index]),
            Self::Rate(index) => (index, start.v[index]),
            Self::ForceState(_) => return None,
        };
        (description.coordinates[index].role == CoordinateRole::Prescribed).then_some(value)
    }

    fn set(self, start: &mut Start, value: f64) {
        match self {
            Self::Position(index) => start.q[index] = value,
            Self::Rate(index) => start.v[index] = value,
            Self::ForceState(index) => {
                if start.x.len() <= index {
                    start.x.resize(index + 1, f64::NAN);
                }
                start.x[index] = value;
            }
        }
    }
}

impl Timing {
    /// The start that `--from` and `--start` ask for; `skip_unknown_names`: skips names that this crane does not have, as they belong to
    /// another one.
    ///
    /// # Errors
    /// An option has a value that cannot be used.
    pub fn start(&self, console: &Console, crane: &dyn DynCrane, skip_unknown_names: bool) -> Outcome<Start> {
        if self.from.is_none() && self.start.is_empty() {
            return Ok(Start::new(crane)?);
        }
        let description = crane.description();
        // Values that are not given are those of the equilibrium, if there is one.
        let mut start = Start::new(crane).unwrap_or_else(|_| Start::guess(crane));
        start.rests = false;
        let mut given = Given::default();
        if let Some(file) = &self.from {
            for (variable, value) in row(console, file, description, None)?.values {
                variable.set(&mut start, value);
                variable.give(&mut given);
            }
            let given_there = given.positions.clone();
            // A whole state is closed as it is; of others the rest follows.
            if given.positions.len() == start.q.len() && given.rates.len() == start.v.len() {
                start.close_state(crane, 0.0)?;
                given = Given::default();
            }
            let states = force_states::columns(description);
            let count = if start.x.is_empty() { 0 } else { states.len() };
            start.x.resize(count, f64::NAN);
            if let Some(index) = start.x.iter().position(|x| x.is_nan()) {
                let title = format!("{} has no column {}", file.display(), states[index]);
                return Err(Problem::usage(
                    title,
                    "to continue a run, give all pressures, valves, bristles and slid feet of the earlier run",
                ));
            }
            let held = if start.x.is_empty() && !states.is_empty() {
                ", pressures, bristles and feet as they hold this pose"
            } else {
                ""
            };
            let other = |index: &usize| !given_there.contains(index);
            let others: Vec<usize> = (0..start.q.len()).filter(other).collect();
            let rest = others.first().map_or_else(String::new, |first| {
                let name = &description.coordinates[*first].name;
                format!(
                    ", without {} of {} coordinates ({name}, …), which begin as at rest",
                    others.len(),
                    start.q.len()
                )
            });
            start.what = format!("end of {}{held}{rest}", file.display());
        }
        let mut asked = Vec::new();
        let columns = quantities(description, crane.loop_joints());
        for text in &self.start {
            let (name, value) = text.split_once('=').ok_or_else(|| {
                let help =
                    "write `--start coordinate=value`, such as `--start boom_psi=0.3` or `--start boom_psi_rate=-0.1`";
                Problem::usage(format!("`--start {text}` has no value"), help)
            })?;
            let variable = match Variable::find(name, description) {
                Some(variable) => variable,
                None if skip_unknown_names => continue,
                None => return Err(unknown(name, description)),
            };
            let number = number(unit_of(name, &columns), value, name)?;
            variable.set(&mut start, number);
            variable.give(&mut given);
            asked.push((name, variable, number));
        }
        let before = [start.q.clone(), start.v.clone()].concat();
        start.close(crane, 0.0, &given)?;
        for (name, variable, number) in asked {
            let prescribed = variable.find_prescribed(&start, description);
            if let Some(prescribed) = prescribed.filter(|prescribed| (prescribed - number).abs() > PRESCRIBED) {
                return Err(Problem::usage(
                    format!("{name} cannot start at {number}: its rigid drive prescribes {prescribed:.6}"),
                    "change the `motion` of the drive, or leave the value out",
                ));
            }
        }
        let follows =
            before.iter().zip(start.q.iter().chain(&start.v)).any(|(before, now)| (before - now).abs() > MOVED);
        if !start.x.is_empty() {
            // States that are not given take the values that hold the pose.
            let held = ForceStates::new(description).holding(crane, 0.0, &start.q);
            start.x.resize(held.len(), f64::NAN);
            start.x.iter_mut().zip(held).filter(|(x, _)| x.is_nan()).for_each(|(x, held)| *x = held);
        }
        if let Some(wrong) = force_states::impossible(description, &start.x) {
            return Err(Problem::usage(
                wrong,
                "give an opening from −1 (fully open, retracts) to 1 (fully open, extends)",
            ));
        }
        for text in &self.start {
            start.what += ", ";
            start.what += text;
        }
        if follows && !crane.loop_joints().is_empty() {
            start.what += ", the rest as loops require";
        }
        Ok(start)
    }
}

/// Unit of the column of results that a start gives.
fn unit_of<'a>(name: &str, columns: &'a [Column]) -> &'a str {
    columns.iter().find(|column| column.name == name).map_or("", |column| column.unit.as_str())
}

fn unknown(name: &str, description: &Description) -> Problem {
    let names: Vec<&str> = description.coordinates.iter().map(|coordinate| coordinate.name.as_str()).collect();
    let guess = nearest(name.strip_suffix(RATE).unwrap_or(name), names.iter().copied());
    let guess = guess.map_or_else(String::new, |guess| format!("did you mean `{guess}`? "));
    Problem::usage(
        format!("{} has no coordinate `{name}`", description.name),
        format!("{guess}coordinates (append `{RATE}` for their rates): {}", names.join(", ")),
    )
}

/// A row of the results of a run.
pub struct ResultRow {
    /// Its time, s, if the results have one.
    pub time: Option<f64>,
    /// Values of coordinates and rates.
    pub values: Vec<(Variable, f64)>,
}

/// Name of the column of times.
const TIME: &str = "t";
/// Maximum distance of a row from the time asked for, s: results are written with all digits.
const SAME_TIME: f64 = 1e-9;

/// The last row of the results of a run, or the row at a time, s.
///
/// # Errors
/// The file cannot be used, or has no row at that time.
pub fn row(console: &Console, file: &Path, description: &Description, at: Option<f64>) -> Outcome<ResultRow> {
    let help = "give a CSV file of results written by `crane simulate` or `crane run`";
    let unreadable = |error: csv::Error| Problem::usage(format!("cannot use {}: {error}", file.display()), help);
    let mut csv = console.csv(file).map_err(unreadable)?;
    let headers = csv.headers().map_err(unreadable)?.clone();
    files::check_separators(file, &headers)?;
    let name_of = |header: &str| header.split(" [").next().unwrap_or(header).to_owned();
    let clock = headers.iter().position(|header| name_of(header) == TIME);
    let time_of = |record: &csv::StringRecord| clock.and_then(|column| record.get(column)?.parse::<f64>().ok());
    let off = |record: &csv::StringRecord| at.zip(time_of(record)).map(|(at, time)| (time - at).abs());
    let mut chosen: Option<csv::StringRecord> = None;
    for record in csv.records() {
        let record = record.map_err(unreadable)?;
        // The nearest row; the last one if no time is given.
        if chosen.as_ref().is_none_or(|chosen| at.is_none() || off(&record) < off(chosen)) {
            chosen = Some(record);
        }
    }
    let record = chosen.ok_or_else(|| Problem::usage(format!("{} has no rows", file.display()), help))?;
    let time = time_of(&record);
    if let Some(at) = at
        && off(&record).is_none_or(|off| off > SAME_TIME)
    {
        let nearest = time.map_or("it has no times".to_owned(), |time| format!("the nearest row is at t = {time} s"));
        return Err(Problem::usage(format!("{} has no row at t = {at} s", file.display()), nearest));
    }
    let mut values = Vec::new();
    for (header, text) in headers.iter().zip(&record) {
        let name = name_of(header);
        let Some(variable) = Variable::find(&name, description) else { continue };
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        let number = number.ok_or_else(|| {
            let title = format!("{}: `{text}` is not a valid value for {name}", file.display());
            Problem::usage(title, help)
        })?;
        values.push((variable, number));
    }
    if values.is_empty() {
        let title = format!("{} has no column for any coordinate of {}", file.display(), description.name);
        return Err(Problem::usage(title, help));
    }
    Ok(ResultRow { time, values })
}
