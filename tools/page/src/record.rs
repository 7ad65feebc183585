//! The record of a run.

use crane_model::{dyn_crane::DynCrane, dynamics::Settings, results::Verification, runs::Recorded};
use serde_json::{Map, Value, json};

/// The program that computed a run.
#[derive(Clone, Copy)]
pub struct Program {
    /// Its name.
    pub name: &'static str,
    /// Its version.
    pub version: &'static str,
}

/// Maximum difference of every column from a finer run, by name.
fn differences(recorded: &Recorded, verification: &Verification) -> Map<String, Value> {
    let columns = recorded.table.columns.iter().map(|column| column.name.clone());
    columns.zip(verification.differences.iter().map(|difference| json!(difference))).collect()
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
    json!({
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
        "cautions": recorded.cautions,
        "differences_from_a_finer_run": recorded.verification.as_ref().map(|verification| differences(recorded, verification)),
        "wall_time_s": recorded.wall.as_secs_f64(),
        "real_time_factor": recorded.real_time_factor(),
    })
}
