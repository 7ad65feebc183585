//! How heavily a run loads the beams, and how far the crane is from tipping over.

use base64::{Engine, prelude::BASE64_STANDARD};
use crane_model::{
    Description, SectionModuli,
    dyn_crane::DynCrane,
    sections::{StressedSection, stressed_sections},
    tipping::TippingLine,
};
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
    json!({"sections": sections(description, &moduli, history, every), "stability": stability(description, history, every)})
}

fn sections(description: &Description, moduli: &[SectionModuli], history: &[Instant], every: usize) -> Value {
    let at = |instant: &Instant| stressed_sections(description, moduli, &instant.wrenches);
    let Some(first) = history.first().map(at).filter(|sections| !sections.is_empty()) else {
        return Value::Null;
    };
    let used = first.iter().any(|section| section.utilisation.is_some());
    let value = |section: &StressedSection| {
        if used { section.utilisation.unwrap_or(f64::NAN) } else { section.stress.equivalent / MEGA }
    };
    let values: Vec<Vec<f64>> = history.iter().map(|instant| at(instant).iter().map(value).collect()).collect();
    let places: Vec<Value> = first
        .iter()
        .enumerate()
        .map(|(index, section)| {
            let info = section.info(description);
            let [_, most] = extremes(values.iter().map(|row| row[index]));
            json!({
                "beam": section.beam(description), "body": info.body, "x": info.x, "place": info.location(), "most": most,
            })
        })
        .collect();
    let data = packed(values.iter().step_by(every).flatten().copied());
    json!({"places": places, "unit": if used { "1" } else { "MPa" }, "data": data})
}

/// Margins about the tipping lines; −∞ where nothing stabilises.
fn stability(description: &Description, history: &[Instant], every: usize) -> Value {
    let Some(first) = history.first().filter(|instant| !instant.lines.is_empty()) else { return Value::Null };
    // A polygon whose corners change has no lines to follow over time.
    let same =
        |instant: &Instant| instant.lines.iter().map(|line| line.feet).eq(first.lines.iter().map(|line| line.feet));
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
    let history = history.iter().step_by(every);
    let margins = history.flat_map(|instant| instant.lines.iter().map(TippingLine::margin));
    json!({"lines": names, "data": packed(margins)})
}

/// Little-endian numbers of 32 bits in base 64, which have 7 digits.
pub fn packed(numbers: impl Iterator<Item = f64>) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "more digits than anybody can see")]
    let bytes: Vec<u8> = numbers.flat_map(|number| (number as f32).to_le_bytes()).collect();
    BASE64_STANDARD.encode(bytes)
}

/// Least and greatest of some numbers; NaN is none.
pub fn extremes(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], number| [least.min(number), most.max(number)])
}
