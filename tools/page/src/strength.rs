//! How heavily a run loads the beams, and how far the crane is from tipping over.

use base64::{Engine, prelude::BASE64_STANDARD};
use crane_model::{Description, SectionModuli, dyn_crane::DynCrane, sections::stressed_sections};
use serde_json::{Value, json};

use crate::history::Instant;

/// Pascals in a newton per square millimetre.
const MEGA: f64 = 1e6;

/// Utilisation of all sections whose moduli are known (stresses in megapascals if no beam has a yield stress), and margins about all tipping lines,
/// of every `every`-th result.
pub fn data(crane: &dyn DynCrane, history: &[Instant], every: usize) -> Value {
    let description = crane.description();
    let moduli = crane.section_moduli_at();
    if description.supports.is_empty() && moduli.iter().all(|moduli| moduli.area <= 0.0) {
        return Value::Null;
    }
    let history: Vec<&Instant> = history.iter().step_by(every).collect();
    json!({"sections": sections(description, &moduli, &history), "stability": stability(description, &history)})
}

fn sections(description: &Description, moduli: &[SectionModuli], history: &[&Instant]) -> Value {
    let at = |instant: &Instant| stressed_sections(description, moduli, &instant.wrenches);
    let Some(first) = history.first().copied().map(at).filter(|sections| !sections.is_empty()) else {
        return Value::Null;
    };
    let used = first.iter().any(|section| section.utilisation.is_some());
    let places: Vec<Value> = first
        .iter()
        .map(|section| {
            let info = section.info(description);
            json!({"beam": section.beam(description), "body": info.body, "x": info.x, "place": info.location()})
        })
        .collect();
    let values = history.iter().copied().flat_map(|instant| {
        at(instant).into_iter().map(move |section| {
            if used { section.utilisation.unwrap_or(f64::NAN) } else { section.stress.equivalent / MEGA }
        })
    });
    json!({"places": places, "unit": if used { "1" } else { "MPa" }, "data": packed(values)})
}

fn stability(description: &Description, history: &[&Instant]) -> Value {
    let Some(first) = history.first().filter(|instant| !instant.lines.is_empty()) else { return Value::Null };
    // A polygon whose corners change has no lines to follow over time.
    let same =
        |instant: &&Instant| instant.lines.iter().map(|line| line.feet).eq(first.lines.iter().map(|line| line.feet));
    if !history.iter().all(same) {
        return Value::Null;
    }
    let names: Vec<String> = first
        .lines
        .iter()
        .map(|line| {
            let [from, to] = line.feet.map(|foot| description.supports[foot].name.as_str());
            format!("{from} – {to}")
        })
        .collect();
    let margins = history.iter().flat_map(|instant| instant.lines.iter().map(|line| line.margin().max(-1e3)));
    json!({"lines": names, "data": packed(margins)})
}

/// Little-endian numbers of 32 bits in base 64, which have 7 digits.
pub fn packed(numbers: impl Iterator<Item = f64>) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "more digits than anybody can see")]
    let bytes: Vec<u8> = numbers.flat_map(|number| (number as f32).to_le_bytes()).collect();
    BASE64_STANDARD.encode(bytes)
}
