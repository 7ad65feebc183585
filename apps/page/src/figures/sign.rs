//! The summary to sign: what was computed, with what, and what came out.

use crane_model::{
    ParameterInfo,
    dyn_crane::DynCrane,
    dynamics::Settings,
    results::{Extremes, headlines},
    runs::Recorded,
};
use serde_json::{Value, json};

use super::{Figure, Verdict, verdict};
use crate::{
    Program,
    crane::Shown,
    tables::{Cell, readable},
};

/// A line of the summary.
struct SignedLine {
    name: String,
    /// One or several sentences.
    texts: Vec<String>,
    verdict: Verdict,
}

impl SignedLine {
    fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), texts: vec![text.into()], verdict: Verdict::Unlimited }
    }

    fn json(&self) -> Value {
        json!({"name": self.name, "texts": self.texts, "verdict": self.verdict.name()})
    }
}

/// The summary of a run; nothing for a crane at rest.
pub(crate) fn summary(crane: &Shown<'_>, figures: &[Figure], command: Option<&str>, program: Program) -> Value {
    let Some((settings, recorded)) = crane.subject.run else { return Value::Null };
    let description = crane.subject.crane.description();
    let (verdict, sentence) = verdict(figures);
    let limits = "utilisation 100 %: equivalent stress of beam theory equals yield stress over the safety factor of the spec; \
                  tipping margin 0: overturning equals stabilising moment; feet carry the crane; pressure below the relief valves";
    let mut lines = vec![
        SignedLine::new("crane", format!("{} ({})", description.title, description.name)),
        SignedLine { verdict, ..SignedLine::new("verdict", sentence) },
        SignedLine::new("load and other parameters", parameters(crane.subject.crane)),
        SignedLine::new("analysis", analysis(settings, recorded)),
        SignedLine::new("limits", limits),
    ];
    lines.extend(figures.iter().map(|figure| {
        let text = format!("{} ({})", figure.value, figure.note);
        SignedLine { verdict: figure.verdict, ..SignedLine::new(figure.title.clone(), text) }
    }));
    lines.push(SignedLine::new("largest difference from a finer run", errors(recorded)));
    lines.push(SignedLine { texts: cautions(recorded), ..SignedLine::new("cautions", "") });
    lines.push(SignedLine::new("program", format!("{} {}", program.name, program.version)));
    lines.push(SignedLine::new("hash of the spec", description.spec_hash.as_str()));
    lines.extend(command.map(|command| SignedLine::new("command", command)));
    lines.iter().map(SignedLine::json).collect()
}

/// Live parameters with their values; angles in degrees as well.
fn parameters(crane: &dyn DynCrane) -> String {
    let of = |(index, info): (usize, &ParameterInfo)| parameter(&info.name, crane.parameter(index), &info.unit);
    let all: Vec<String> = crane.description().parameters.iter().enumerate().map(of).collect();
    if all.is_empty() { "none".to_owned() } else { all.join(", ") }
}

/// A parameter with its value; an angle in degrees as well.
pub(crate) fn parameter(name: &str, value: f64, unit: &str) -> String {
    let degrees = if unit == "rad" { format!(" ({}°)", readable(value.to_degrees())) } else { String::new() };
    format!("{name} = {} {unit}", readable(value)).trim_end().to_owned() + &degrees
}

fn analysis(settings: &Settings, recorded: &Recorded) -> String {
    let tolerance = settings.method.is_adaptive().then(|| format!(", tolerance {}", settings.tolerance));
    let (duration, method) = (readable(settings.duration), settings.method.title());
    format!("{duration} s from the {}; {method}{}", recorded.start, tolerance.unwrap_or_default())
}

/// The largest difference from a finer run for each kind of quantity.
fn errors(recorded: &Recorded) -> String {
    let Some(verification) = &recorded.verification else { return "not estimated".to_owned() };
    let of_kind = headlines(&recorded.table.columns).into_iter().filter_map(|kind| {
        let differences = kind.names.iter().filter_map(|name| verification.difference(&recorded.table, name));
        let greatest = differences.filter(|difference| difference.is_finite()).max_by(f64::total_cmp)?;
        let sizes = kind.names.iter().map(|name| Extremes::of_column(&recorded.table, name).size());
        let size = sizes.fold(0.0, f64::max);
        let [error, unit] = [Cell::error_of_unit(greatest, &kind.unit), Cell::unit_of(&kind.unit)];
        Some(format!("{} {} (of up to {})", error.text(), unit.text(), super::quantity(size, &kind.unit)))
    });
    let all: Vec<String> = of_kind.collect();
    if all.is_empty() { "not estimated".to_owned() } else { all.join("; ") }
}

/// Cautions in order of importance: those about the crane, then one about the accuracy of the run. The tables have all of them.
fn cautions(recorded: &Recorded) -> Vec<String> {
    let verification = recorded.verification.as_ref();
    let inexact = verification.map_or_else(Vec::new, |found| found.cautions(&recorded.table));
    let about_crane = recorded.cautions.iter().filter(|caution| !inexact.contains(caution));
    let mut shown: Vec<String> = about_crane.cloned().collect();
    match inexact.as_slice() {
        [] => {}
        [one] => shown.push(one.clone()),
        [first, others @ ..] => {
            shown.push(format!("accuracy: {first}; {} more such cautions are in the tables", others.len()));
        }
    }
    if shown.is_empty() { vec!["none".to_owned()] } else { shown }
}
