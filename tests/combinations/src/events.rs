//! A run with an event, and the same run in two parts, of two cranes; an event on a condition, and the same event at the time at which it happened,
//! and the same run step by step.

use std::ops::ControlFlow;

use crane_live::{LiveCrane, Motion};
use crane_model::ColumnKind;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{Cause, InitialState, Sample, Settings, Simulation, Stopped, Watch};
use crane_model::results::{Table, quantities_at};
use crane_model::runs::{Failed, Reason, Start, imbalance, record};
use fastrand::Rng;
use serde_json::json;

use crate::descriptions::with_parameters;
use crate::observe::{equilibrium, live};
use crate::tree::{Tree, source};

/// The name of the check.
pub const NAME: &str = "events and runs in two parts";
/// Length of the run and its interval of results, s.
const RUN: [f64; 2] = [0.3, 0.05];
/// When events happen, s: between two results, or at one.
const TIMES: [f64; 2] = [0.13, 0.15];
/// Tolerance of the runs, and largest difference relative to the largest number of a column and unit: steps end at other times.
const TOLERANCE: [f64; 2] = [1e-8, 1e-4];
/// Largest error of the balance of energy, relative to what is exchanged.
const IMBALANCE: f64 = 1e-3;

/// What differs; `None` for a crane without live numbers, that does not stand, or whose runs end early.
pub fn check_events(tree: &Tree, seed: u64) -> Option<Vec<String>> {
    let mut rng = Rng::with_seed(seed);
    let (mut with_event, names) = with_parameters(tree)?;
    let mut after = live(&source(&with_event)).ok()?;
    let before = after.clone();
    let name = names.get(rng.usize(0..names.len().max(1)))?;
    let index = before.description().parameters.iter().position(|info| info.name == name.as_str())?;
    let value = before.parameters()[index] * (0.7 + 0.6 * rng.f64());
    after.set_parameter(index, value).ok()?;
    let time = TIMES[rng.usize(0..TIMES.len())];
    with_event["events"] = json!([{"name": "change", "at": time, "set": {name: value}}]);
    let crane = match live(&source(&with_event)) {
        Ok(crane) => crane,
        Err(refused) => return Some(vec![refused]),
    };
    let q = equilibrium(&before).ok()?;
    let v: Vec<f64> = q.iter().map(|_| 0.02 * (2.0 * rng.f64() - 1.0)).collect();
    let start = Start::given(InitialState { q, v, x: Vec::new() });
    let settings = Settings {
        duration: RUN[0],
        output: RUN[1],
        tolerance: TOLERANCE[0],
        audit: true,
        most_steps: 60_000,
        ..Settings::from_description(crane.description())
    };
    let rows = in_two_parts([&before, &after], time, &start.state, &settings)?;
    let table = match record(&crane, &start, &settings, &mut |_| ControlFlow::Continue(())) {
        Ok(recorded) => recorded.table,
        // What moves rigid drives or opens loops at once is refused.
        Err(failed) if is_jump(&failed) => return None,
        Err(failed) => return Some(vec![failed.to_string()]),
    };
    let mut wrong = differences(&table, &rows);
    let off = imbalance(&table, 1.0);
    if off > IMBALANCE {
        wrong.push(format!("the balance of energy is off by {off:e}, with an event that sets {name}"));
    }
    // Two more runs of some cranes.
    if seed.is_multiple_of(2) {
        wrong.extend(on_condition(with_event, &table, (&start, &settings), &mut rng).unwrap_or_default());
    }
    Some(wrong)
}

/// What differs between two runs of a crane, one of them given by its rows.
fn differences(table: &Table, rows: &[Vec<f64>]) -> Vec<String> {
    let mut wrong = Vec::new();
    // The error of the balance of energy has no size of its own.
    let compared = table.columns.iter().take(rows[0].len()).enumerate();
    for (index, column) in compared.filter(|(_, column)| column.kind != ColumnKind::Balance) {
        let alike = |other: usize| table.columns[other].unit == column.unit && table.columns[other].kind == column.kind;
        let of_kind = (0..rows[0].len()).filter(|other| alike(*other));
        let size = of_kind.flat_map(|other| rows.iter().map(move |row| row[other].abs())).fold(1e-6, f64::max);
        for (one, other) in table.rows.iter().zip(rows) {
            let off = (one[index] - other[index]).abs();
            if off.is_nan() || off > TOLERANCE[1] * size {
                let (t, unit) = (one[0], &column.unit);
                wrong.push(format!("{} at {t} s: {:e} against {:e} {unit}", column.name, one[index], other[index]));
                break;
            }
        }
    }
    wrong
}

/// What differs between an event on a condition and the same at the time that its run tells; `before`: a run of the crane with its event at a time,
/// from which the condition is taken. `None` where it never happens.
fn on_condition(
    mut crane: Tree,
    before: &Table,
    (start, settings): (&Start, &Settings),
    rng: &mut Rng,
) -> Option<Vec<String>> {
    let run = |crane: &LiveCrane| record(crane, start, settings, &mut |_| ControlFlow::Continue(())).ok();
    let at_time = live(&source(&crane)).ok()?;
    let results = at_time.description().columns(at_time.loop_joints()).len();
    let column = 1 + rng.usize(0..results);
    let [from, to] = [1, 2].map(|row| before.rows[row][column]);
    let (side, value) = (if to > from { "above" } else { "below" }, 0.5 * (from + to));
    let event = crane["events"][0].as_object_mut()?;
    event.remove("at");
    event.insert("when".to_owned(), json!({"result": before.columns[column].name, side: value}));
    let on_condition = match live(&source(&crane)) {
        Ok(crane) => crane,
        Err(refused) => return Some(vec![refused]),
    };
    let found = run(&on_condition)?.table;
    let time = found.times_of_events(on_condition.description())[0]?;
    let event = crane["events"][0].as_object_mut()?;
    event.remove("when");
    event.insert("at".to_owned(), json!(time));
    let expected = run(&live(&source(&crane)).ok()?)?.table;
    let told = |wrong| format!("once {} is {side} {value}, at {time} s: {wrong}", before.columns[column].name);
    let mut wrong = differences(&found, &expected.rows);
    match in_steps(&on_condition, &found, start, settings) {
        Ok(rows) => wrong.extend(differences(&found, &rows).into_iter().map(|wrong| format!("step by step {wrong}"))),
        Err(stopped) => wrong.push(format!("step by step {stopped}")),
    }
    Some(wrong.into_iter().map(told).collect())
}

/// All quantities at the results of a run, of a motion step by step.
fn in_steps(crane: &LiveCrane, table: &Table, start: &Start, settings: &Settings) -> Result<Vec<Vec<f64>>, Stopped> {
    let settings = Settings { duration: f64::INFINITY, ..*settings };
    let mut motion = Motion::new(Box::new(crane.clone()), 0.0, &start.state, &settings, None)?;
    let mut rows = Vec::new();
    for row in &table.rows {
        let _ = motion.advance(row[0], &mut |_| ControlFlow::Continue(()))?;
        rows.push(quantities_at(motion.crane(), &motion.sample()));
    }
    Ok(rows)
}

/// Whether an event would move the crane at once.
fn is_jump(failed: &Failed) -> bool {
    matches!(&*failed.reason, Reason::Stopped { stopped, .. } if stopped.cause == Cause::Event)
}

/// All quantities at the results of a run whose crane is another one from a time on, s.
fn in_two_parts(
    [before, after]: [&LiveCrane; 2],
    time: f64,
    start: &InitialState,
    settings: &Settings,
) -> Option<Vec<Vec<f64>>> {
    let mut rows = Vec::new();
    let mut first = Part { crane: before, keeps: &|t| t < time, rows: &mut rows, end: start.clone() };
    let whole = |t: f64| (t / settings.output).round() * settings.output;
    let until = if (whole(time) - time).abs() < 1e-9 { settings.output } else { time };
    let of_first = Settings { duration: time, output: until.min(settings.output), ..*settings };
    Simulation::new(before, start, &of_first).watch(&mut first).ok()?;
    let mut end = first.end;
    // Results before the event, at the interval of the run.
    let on_grid = |t: f64| (whole(t) - t).abs() < 1e-9;
    rows.retain(|row: &Vec<f64>| on_grid(row[0]));
    let mut begin = time;
    if !on_grid(time) {
        let next = (time / settings.output).ceil() * settings.output;
        let mut nothing = Part { crane: after, keeps: &|_| false, rows: &mut rows, end: end.clone() };
        let to_result = Settings { duration: next - time, output: next - time, ..*settings };
        Simulation::new(after, &end, &to_result).at_time(begin).watch(&mut nothing).ok()?;
        (begin, end) = (next, nothing.end);
    }
    let mut second = Part { crane: after, keeps: &|_| true, rows: &mut rows, end: end.clone() };
    let rest = Settings { duration: settings.duration - begin, ..*settings };
    Simulation::new(after, &end, &rest).at_time(begin).watch(&mut second).ok()?;
    Some(rows)
}

/// The results of a part of a run, and where it ended.
struct Part<'a> {
    crane: &'a dyn DynCrane,
    keeps: &'a dyn Fn(f64) -> bool,
    rows: &'a mut Vec<Vec<f64>>,
    end: InitialState,
}

impl Watch for Part<'_> {
    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        if (self.keeps)(sample.t) {
            self.rows.push(quantities_at(self.crane, sample));
        }
        self.end = sample.state.into();
        ControlFlow::Continue(())
    }
}
