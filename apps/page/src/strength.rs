//! How heavily a run loads the beams, and how far the crane is from tipping over.

use base64::{Engine, prelude::BASE64_STANDARD};
use crane_model::{
    Description, SectionModuli,
    dyn_crane::DynCrane,
    sections::{Place, StressedSection},
    tipping::TippingLine,
};
use serde_json::{Value, json};

use crate::history::Instant;

/// Pascals in a newton per square millimetre.
const MEGA: f64 = 1e6;

/// What all places of beams carry; utilisation of those whose moduli are known (stresses in megapascals if no beam has a yield stress); and margins
/// about all tipping lines, of every `every`-th result.
pub fn data(crane: &dyn DynCrane, history: &[Instant], every: usize) -> Value {
    let description = crane.description();
    let moduli = crane.section_moduli_at();
    if description.supports.is_empty() && description.sections.is_empty() {
        return Value::Null;
    }
    json!({
        "carried": carried(description, history, every),
        "sections": sections(description, &moduli, history, every),
        "stability": stability(description, history, every),
    })
}

/// Moments about x, y and z at all places of beams, in the order of the sections.
fn carried(description: &Description, history: &[Instant], every: usize) -> Value {
    let at = |instant: &Instant| {
        let mut places = instant.places(description);
        places.sort_by_key(|place| place.section);
        places
    };
    let all: Vec<Vec<Place>> = history.iter().map(at).collect();
    let Some(first) = all.first().filter(|places| !places.is_empty()) else { return Value::Null };
    let moments = |place: &Place| -> [f64; 3] { place.wrench.moment.into() };
    let places: Vec<Value> = first
        .iter()
        .enumerate()
        .map(|(index, place)| {
            let ranges = [0, 1, 2].map(|axis| extremes(all.iter().map(|places| moments(&places[index])[axis])));
            let mut words = words(place, description);
            words["ranges"] = json!(ranges);
            words
        })
        .collect();
    let data = packed(all.iter().step_by(every).flatten().flat_map(moments));
    json!({"places": places, "data": data, "x": ways(&all, description, every)})
}

/// Where a place is, for readers.
fn words(place: &Place, description: &Description) -> Value {
    let info = place.info(description);
    json!({"beam": place.beam(description), "body": info.body, "x": place.x, "place": info.location(), "slides": info.slides})
}

/// Distances of all places that slide, row by row.
fn ways(all: &[Vec<Place>], description: &Description, every: usize) -> String {
    let sliding = |places: &'_ Vec<Place>| -> Vec<f64> {
        let slide = |place: &&Place| place.info(description).slides;
        places.iter().filter(slide).map(|place| place.x).collect()
    };
    packed(all.iter().step_by(every).flat_map(sliding))
}

fn sections(description: &Description, moduli: &[SectionModuli], history: &[Instant], every: usize) -> Value {
    let at = |instant: &Instant| {
        let mut sections = instant.stressed_sections(description, moduli);
        sections.sort_by_key(|section| section.place.section);
        sections
    };
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
            let [_, most] = extremes(values.iter().map(|row| row[index]));
            let mut words = words(&section.place, description);
            words["most"] = json!(most);
            words
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
