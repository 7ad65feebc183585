//! What is drawn, described and exported of a crane whose numbers are set instead of written.

use crane_codegen::exchange;
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_page::shapes::Figure;
use serde_json::Value;

use crate::observe::equilibrium;

/// How far numbers that are drawn may differ, m and rad: poses are solved twice.
const DRAWN: f64 = 1e-6;

/// What differs between a crane as written and one with its numbers set.
#[must_use]
pub fn differences(written: &LiveCrane, set: &LiveCrane) -> Vec<String> {
    let mut lines = described([written, set]);
    let Ok(q) = equilibrium(written as &dyn DynCrane) else { return lines };
    let [one, other] = [written, set].map(|crane| drawn(crane, &q));
    different("scene", [&one, &other], &mut lines);
    let exported = |crane: &LiveCrane| {
        let (chain, parameters) = (crane.chain(), crane.parameters());
        let mjcf = exchange::mjcf(chain, parameters, &[], (&chain.guess_at(parameters), "guess"))
            .unwrap_or_else(|failure| failure.title);
        [
            exchange::urdf(chain, parameters, &[]).unwrap_or_else(|failure| failure.to_string()),
            exchange::springs(chain, parameters),
            mjcf,
        ]
    };
    for (name, (written, set)) in ["URDF", "springs", "MJCF"].iter().zip(exported(written).iter().zip(exported(set))) {
        // The head of a file names the spec and its parameters.
        let of_crane = |text: &str| {
            text.lines().skip_while(|line| !line.contains("spec hash")).skip(1).map(str::to_owned).collect::<Vec<_>>()
        };
        let differing = of_crane(written).into_iter().zip(of_crane(&set)).find(|(written, set)| written != set);
        lines.extend(differing.map(|(written, set)| format!("{name}: {written} against {set}")));
    }
    lines
}

/// What a page draws of a crane, and the corners of all shapes; those of surfaces are packed in the former, to 7 digits.
fn drawn(crane: &LiveCrane, q: &[f64]) -> Value {
    let figure = Figure::new(crane, q, q);
    let mut drawn = figure.json();
    for part in drawn["parts"].as_array_mut().into_iter().flatten() {
        part["corners"] = Value::Null;
    }
    drawn["corners"] = figure.all_corners().iter().map(|corner| corner.iter().copied().collect::<Vec<_>>()).collect();
    drawn
}

/// What the descriptions say that does not depend on live parameters and inputs, and differs nevertheless.
fn described(cranes: [&LiveCrane; 2]) -> Vec<String> {
    let [written, set] = cranes.map(|crane| {
        let crane: &dyn DynCrane = crane;
        let mut description = crane.description().clone();
        description.parameters = Vec::new().into();
        description.inputs = Vec::new().into();
        description.spec_hash = "".into();
        format!("{description:#?}")
    });
    let differing = written.lines().zip(set.lines()).filter(|(written, set)| written != set);
    differing.map(|(written, set)| format!("description: {} against {}", written.trim(), set.trim())).collect()
}

/// Differences of two JSON values, numbers to rounding.
fn different(place: &str, [a, b]: [&Value; 2], lines: &mut Vec<String>) {
    match (a, b) {
        (Value::Object(one), Value::Object(other)) => {
            for (key, value) in one {
                different(&format!("{place}.{key}"), [value, &other[key]], lines);
            }
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() => {
            for (index, (value, counterpart)) in one.iter().zip(other).enumerate() {
                different(&format!("{place}[{index}]"), [value, counterpart], lines);
            }
        }
        _ => {
            let close = |a: f64, b: f64| (a - b).abs() <= DRAWN * a.abs().max(1.0);
            let same = a.as_f64().zip(b.as_f64()).map_or(a == b, |(a, b)| close(a, b));
            if !same {
                lines.push(format!("{place}: {a} against {b}"));
            }
        }
    }
}
