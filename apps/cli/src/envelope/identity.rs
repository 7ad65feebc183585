//! To which crane a chart belongs: the file of facts beside it is compared with a crane.

use std::{fs, path::Path};

use crane_model::{
    dyn_crane::DynCrane,
    envelope::{Envelope, Varied},
};
use serde_json::{Map, Value};

use crate::problem::{Outcome, Problem};

/// Values of the live parameters that a chart depends on: all but the load and those that it varies.
pub fn parameters(crane: &dyn DynCrane, envelope: &Envelope) -> Map<String, Value> {
    let varies = |index: usize| envelope.axes.0.iter().any(|axis| axis.varied == Varied::Parameter(index));
    let fixed = crane.description().parameters.iter().enumerate();
    let fixed = fixed.filter(|(index, _)| *index != envelope.load && !varies(*index));
    fixed.map(|(index, info)| (info.name.to_string(), crane.parameter(index).into())).collect()
}

/// The facts beside the table of an envelope, if the chart is one of this crane.
pub fn facts(table: &Path, crane: &dyn DynCrane) -> Outcome<Value> {
    let description = crane.description();
    let again = || format!("compute it again: `crane envelope` with the spec of {} and its ranges", description.name);
    let facts = fs::read_to_string(table.with_extension("json")).ok();
    let facts: Option<Value> = facts.and_then(|text| serde_json::from_str(&text).ok());
    let Some(facts) = facts else {
        let title = format!("{} has no file with its facts beside it, `….json`", table.display());
        return Err(Problem::usage(title, again()));
    };
    let charted = facts["crane"].as_str().unwrap_or("another crane");
    if charted != description.name.as_str() {
        let title = format!("{} is a chart of {charted}, not of {}", table.display(), description.name);
        return Err(Problem::usage(title, format!("name the chart of {}, or {}", description.name, again())));
    }
    if facts["spec_hash"] != description.spec_hash.as_str() {
        let title = format!("{} was computed with another version of the spec of {charted}", table.display());
        return Err(Problem::usage(title, again()));
    }
    let other = description.parameters.iter().enumerate().find(|(index, info)| {
        let value = facts["parameters"][info.name.as_str()].as_f64();
        value.is_some_and(|value| value != crane.parameter(*index))
    });
    if let Some((index, info)) = other {
        let name = &info.name;
        let (of_chart, here) = (&facts["parameters"][name.as_str()], crane.parameter(index));
        let title =
            format!("{} was computed with {name} = {of_chart} {}; here it is {here}", table.display(), info.unit);
        return Err(Problem::usage(title, format!("add `--set {name}={of_chart}`, or {}", again())));
    }
    Ok(facts)
}
