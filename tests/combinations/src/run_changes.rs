//! Derivatives of runs by live numbers and by the start: against differences of tighter runs, and by the adjoint mode against the forward mode; half
//! of them with an event on a condition.

use std::ops::ControlFlow;

use crane_live::LiveCrane;
use crane_live::sensitivity::runs::{Along, run_with_adjoint, run_with_gradients};
use crane_model::CoordinateRole;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::dynamics::{InitialState, Method, Settings};
use crane_model::loop_joints::Given;
use crane_model::runs::{Measure, Start, record};
use fastrand::Rng;
use serde_json::json;

use crate::descriptions::with_parameters;
use crate::observe::{equilibrium, live};
use crate::tree::{Tree, source};

/// The name of the check.
pub const NAME: &str = "changes of runs with live numbers";
/// Numbers that are changed, chosen at random.
const CHANGED: usize = 1;
/// Length of the run, its interval of results, and initial rates, s, m/s and rad/s.
const RUN: [f64; 3] = [0.02, 0.01, 0.05];
/// Tolerances of the run with derivatives, of which the first usually does: errors of derivatives grow where feet let go and valves open. Runs
/// that are differenced have the last.
const TOLERANCES: [f64; 2] = [1e-10, 1e-12];
/// Cranes whose runs have more steps are not worth the time: most have some hundred.
const MOST_STEPS: usize = 2_000;
/// Steps relative to the number: with the longer ones differences have an error of their square, with the shorter one that of the steps of the
/// runs. A foot may let go, or a valve open, within the longer ones; with stiff pads and oil the path of a run bends within 1e-6 rad of its start.
const STEPS: [f64; 6] = [3e-3, 3e-4, 3e-5, 3e-6, 3e-7, 1e-7];
/// A result on which an event waits moves by this much of its size between two results.
const MOVES: f64 = 1e-3;
/// Largest error, relative to the largest derivative of the column.
const OF_COLUMN: f64 = 3e-3;
/// The same relative to the largest derivative of its kind: positions or rates.
const OF_LARGEST: f64 = 1e-5;
/// The same relative to a change of 1 m or rad, or of 1 m/s or rad/s, with the whole number.
const OF_ONE: f64 = 1e-6;

/// What does not change as its derivative says; `None` for a crane that does not stand, or whose runs end early.
pub fn check_run_changes(tree: &Tree, seed: u64) -> Option<Vec<String>> {
    let mut rng = Rng::with_seed(seed);
    let (mut written, names) = with_parameters(tree)?;
    let mut crane = live(&source(&written)).ok()?;
    let q = equilibrium(&crane).ok()?;
    // In motion: at rest, shut valves are where their laws have a kink.
    let v: Vec<f64> = q.iter().map(|_| RUN[2] * (2.0 * rng.f64() - 1.0)).collect();
    let mut start = Start::given(InitialState { q, v, x: Vec::new() });
    start.close(&crane, 0.0, &Given::default()).ok()?;
    let mut along: Vec<Along> = (0..crane.parameters().len()).map(Along::Parameter).collect();
    rng.shuffle(&mut along);
    along.truncate(CHANGED);
    let free: Vec<usize> =
        (0..crane.size()).filter(|j| crane.description().coordinates[*j].role != CoordinateRole::Prescribed).collect();
    if !free.is_empty() {
        along.push(Along::Position(free[rng.usize(0..free.len())]));
        along.push(Along::Rate(free[rng.usize(0..free.len())]));
    }
    let own = Settings::from_description(crane.description());
    let settings = Settings {
        duration: RUN[0],
        output: RUN[1],
        method: Method::Rosenbrock,
        audit: false,
        most_steps: MOST_STEPS,
        ..own
    };
    // Every second crane becomes another one on the way.
    if seed % 2 == 1
        && let Some(changing) = with_event(&mut written, &names, (&crane, &start, &settings), &mut rng)
    {
        crane = changing;
    }
    let [first, last] = TOLERANCES.map(|tolerance| Settings { tolerance, ..settings });
    let mut wrong = Vec::new();
    for settings in [&first, &last] {
        let proceed = &mut |_| ControlFlow::Continue(());
        let (recorded, found) = run_with_gradients(&crane, &start, settings, &along, proceed).ok()?;
        if recorded.table.rows.is_empty() {
            return None;
        }
        wrong = not_transposed(&crane, &start, settings, &along, &found);
        wrong.extend(not_the_difference(&crane, &start, &last, &along, &found));
        if wrong.is_empty() {
            break;
        }
    }
    Some(wrong)
}

/// The crane with an event that sets a live number as soon as a result passes a value between two results of a run; `None` if the result hardly moves.
fn with_event(
    crane: &mut Tree,
    names: &[String],
    (before, start, settings): (&LiveCrane, &Start, &Settings),
    rng: &mut Rng,
) -> Option<LiveCrane> {
    let table = record(before, start, settings, &mut |_| ControlFlow::Continue(())).ok()?.table;
    let column = 1 + rng.usize(0..before.description().columns(before.loop_joints()).len());
    let [from, to] = [1, 2].map(|row| table.rows[row][column]);
    let name = names.get(rng.usize(0..names.len().max(1)))?;
    let index = before.description().parameters.iter().position(|info| info.name == name.as_str())?;
    let value = before.parameters()[index] * (0.7 + 0.6 * rng.f64());
    if (to - from).abs() < MOVES * to.abs().max(from.abs()) {
        return None;
    }
    let side = if to > from { "above" } else { "below" };
    let when = json!({"result": table.columns[column].name, side: 0.5 * (from + to)});
    crane["events"] = json!([{"name": "change", "when": when, "set": {name: value}}]);
    live(&source(crane)).ok()
}

/// Positions and rates whose derivatives are not the differences of runs with these settings.
fn not_the_difference(
    crane: &LiveCrane,
    start: &Start,
    settings: &Settings,
    along: &[Along],
    found: &[Vec<Vec<f64>>],
) -> Vec<String> {
    let mut wrong = Vec::new();
    for (along, found) in along.iter().zip(found) {
        let per = size_of(crane, *along);
        let mut fewest: Option<Vec<String>> = None;
        for step in STEPS {
            let step = step * per;
            let [Some(less), Some(more)] = [-step, step].map(|step| run(crane, start, settings, *along, step)) else {
                continue;
            };
            let off = differences(crane, found, [&less, &more], step, per);
            let off: Vec<String> =
                off.into_iter().map(|words| format!("{words}, by {}", name(crane, *along))).collect();
            let agrees = off.is_empty();
            if fewest.as_ref().is_none_or(|known| off.len() < known.len()) {
                fewest = Some(off);
            }
            if agrees {
                break;
            }
        }
        wrong.extend(fewest.into_iter().flatten());
    }
    wrong
}

/// Final positions and rates whose derivatives by adjoint mode are not those of the forward mode.
fn not_transposed(
    crane: &LiveCrane,
    start: &Start,
    settings: &Settings,
    along: &[Along],
    forward: &[Vec<Vec<f64>>],
) -> Vec<String> {
    let n = crane.size();
    let asked: Vec<(usize, Measure)> =
        [1, n.div_ceil(2), n, n + 1, 2 * n].map(|column| (column, Measure::Final)).to_vec();
    let proceed = &mut |_| ControlFlow::Continue(());
    let Ok((_, found)) = run_with_adjoint(crane, start, settings, along, &asked, proceed) else {
        return vec!["the run ends early in adjoint mode".to_owned()];
    };
    let mut wrong = Vec::new();
    for ((column, _), found) in asked.iter().zip(&found) {
        for ((along, value), rows) in along.iter().zip(found).zip(forward) {
            let expected = rows[rows.len() - 1][*column];
            let largest = |columns: std::ops::RangeInclusive<usize>| {
                rows.iter().flat_map(|row| &row[columns.clone()]).fold(0.0, |size: f64, x| size.max(x.abs()))
            };
            let kind = if *column > n { n + 1..=2 * n } else { 1..=n };
            let allowed =
                OF_COLUMN * largest(*column..=*column) + OF_LARGEST * largest(kind) + OF_ONE / size_of(crane, *along);
            let off = (value - expected).abs();
            if off > allowed || off.is_nan() {
                let name = name(crane, *along);
                wrong.push(format!("column {column} by {name}: {value:.9e} backward, {expected:.9e} forward, {off:.1e} of {allowed:.1e}"));
            }
        }
    }
    wrong
}

/// The size of a number.
fn size_of(crane: &LiveCrane, along: Along) -> f64 {
    let value = match along {
        Along::Parameter(index) => crane.parameters()[index],
        _ => 1.0,
    };
    if value == 0.0 { 1.0 } else { value.abs() }
}

/// The rows of the run of a crane with a number, or a start, that is changed by a step.
fn run(crane: &LiveCrane, start: &Start, settings: &Settings, along: Along, step: f64) -> Option<Vec<Vec<f64>>> {
    let (mut crane, mut start) = (crane.clone(), start.clone());
    match along {
        Along::Parameter(index) => crane.set_parameter(index, crane.parameters()[index] + step).ok()?,
        Along::Input(_) => return None,
        Along::Position(coordinate) => start.q[coordinate] += step,
        Along::Rate(coordinate) => start.v[coordinate] += step,
    }
    Some(record(&crane, &start, settings, &mut |_| ControlFlow::Continue(())).ok()?.table.rows)
}

/// Positions and rates whose derivative is not their difference.
fn differences(
    crane: &LiveCrane,
    found: &[Vec<f64>],
    [less, more]: [&[Vec<f64>]; 2],
    step: f64,
    per: f64,
) -> Vec<String> {
    let n = crane.size();
    let largest = |columns: &mut dyn Iterator<Item = usize>| {
        columns.flat_map(|column| found.iter().map(move |row| row[column].abs())).fold(0.0, f64::max)
    };
    let kinds = [largest(&mut (1..=n)), largest(&mut (n + 1..=2 * n))];
    let coordinates = &crane.description().coordinates;
    let mut wrong = Vec::new();
    for column in 1..=2 * n {
        let allowed = OF_COLUMN * largest(&mut std::iter::once(column))
            + OF_LARGEST * kinds[usize::from(column > n)]
            + OF_ONE / per;
        for ((own, less), more) in found.iter().zip(less).zip(more) {
            let expected = (more[column] - less[column]) / (2.0 * step);
            let off = (own[column] - expected).abs();
            if off > allowed || off.is_nan() {
                let part = if column > n { "rate of " } else { "" };
                let name = &coordinates[(column - 1) % n].name;
                wrong.push(format!(
                    "{part}{name} at {} s: {:.9e} against {expected:.9e}, {off:.1e} of {allowed:.1e}",
                    less[0], own[column]
                ));
            }
        }
    }
    wrong
}

fn name(crane: &LiveCrane, along: Along) -> String {
    let description = crane.description();
    match along {
        Along::Parameter(index) => description.parameters[index].name.to_string(),
        Along::Input(index) => description.inputs[index].name.to_string(),
        Along::Position(index) => format!("q0.{}", description.coordinates[index].name),
        Along::Rate(index) => format!("v0.{}", description.coordinates[index].name),
    }
}
