//! The record of a run.

use crane_model::{dyn_crane::DynCrane, dynamics::Settings, results::Verification, runs::Recorded};
use serde_json::{Map, Value, json};

use crate::tables::{pace, readable};

/// The program that computed a run.
#[derive(Clone, Copy)]
pub struct Program {
    /// Its name.
    pub name: &'static str,
    /// Its version.
    pub version: &'static str,
}

/// Numbers of the columns, by name.
fn by_name(recorded: &Recorded, of: fn(&Verification) -> &Vec<f64>) -> Option<Map<String, Value>> {
    let numbers = of(recorded.verification.as_ref()?).iter().map(|number| json!(number));
    Some(recorded.table.columns.iter().map(|column| column.name.clone()).zip(numbers).collect())
}

/// The record of a run: enough to repeat it.
pub fn record(crane: &dyn DynCrane, settings: &Settings, recorded: &Recorded, program: Program) -> Value {
    let description = crane.description();
    let parameters: Map<String, Value> = description
        .parameters
        .iter()
        .enumerate()
        .map(|(index, parameter)| {
            (parameter.name.to_string(), json!({"value": crane.parameter(index), "unit": parameter.unit.as_str()}))
        })
        .collect();
    let events = description.events.iter().zip(recorded.table.times_of_events(description));
    let events: Map<String, Value> = events.map(|(event, time)| (event.name.to_string(), json!(time))).collect();
    let mut record = json!({
        "crane": description.name.as_str(),
        "title": description.title.as_str(),
        "spec_hash": description.spec_hash.as_str(),
        "program": program.name,
        "version": program.version,
        "method": settings.method.title(),
        "start": recorded.start,
        "step_s": recorded.run.step,
        "tolerance": settings.method.is_adaptive().then_some(settings.tolerance),
        "steps": recorded.run.statistics.steps,
        "rejected_steps": recorded.run.statistics.rejections,
        "evaluations": recorded.run.statistics.evaluations,
        "factorisations": recorded.run.statistics.factorisations,
        "duration_s": settings.duration,
        "output_s": settings.output,
        "parameters": parameters,
        "times_of_events_s": events,
        "cautions": recorded.cautions,
        "differences_from_a_finer_run": by_name(recorded, |found| &found.errors),
        "missed_between_results": by_name(recorded, |found| &found.missed),
    });
    if let Some((wall, factor)) = pace(recorded) {
        record["wall_time_s"] = wall.into();
        record["real_time_factor"] = factor.into();
    }
    record
}

/// The record for readers: names and values with their units. Errors and cautions are in the tables of results.
pub(crate) fn entries(
    crane: &dyn DynCrane,
    settings: &Settings,
    recorded: &Recorded,
    program: Program,
) -> Vec<[String; 2]> {
    let description = crane.description();
    let statistics = &recorded.run.statistics;
    let mut entries: Vec<[String; 2]> = Vec::new();
    let mut add = |name: &str, value: String| entries.push([name.to_owned(), value]);
    add("crane", format!("{} ({})", description.title, description.name));
    add("hash of the spec", description.spec_hash.to_string());
    add("program", format!("{} {}", program.name, program.version));
    add("method", settings.method.title().to_owned());
    add("start", recorded.start.clone());
    add("step", format!("{} s", readable(recorded.run.step)));
    if settings.method.is_adaptive() {
        add("tolerance", settings.tolerance.to_string());
    }
    add("steps", format!("{}, {} of them rejected", statistics.steps, statistics.rejections));
    add("evaluations", statistics.evaluations.to_string());
    add("factorisations", statistics.factorisations.to_string());
    add("duration", format!("{} s", settings.duration));
    add("interval of results", format!("{} s", settings.output));
    for (index, info) in description.parameters.iter().enumerate() {
        let value = crane.parameter(index);
        let degrees = if info.unit == "rad" { format!(" ({}°)", readable(value.to_degrees())) } else { String::new() };
        // Exact, to repeat the run.
        add(&info.name, format!("{value} {}", info.unit).trim_end().to_owned() + &degrees);
    }
    if let Some((wall, factor)) = pace(recorded) {
        add("wall time", format!("{} s", readable(wall)));
        add("real-time factor", readable(factor));
    }
    entries
}
