//! Finer meshes: what is reported converges with the number of sections.

use serde_json::{Value, json};

use crate::observe::{Numbers, observe};
use crate::tree::{Tree, source};

/// The name of the check.
pub const NAME: &str = "finer meshes";
/// Sections of every beam.
const SECTIONS: [u32; 3] = [4, 8, 16];
/// The difference between the finer two over that between the coarser two: 1/4 for order 2; more, since the terms behind the leading one
/// count at four sections.
const RATIO: f64 = 0.45;
/// Differences below this share of the largest number of a unit are not looked at.
const SMALL: f64 = 2e-6;

/// What does not converge with order 2; `None` for a crane without divided beams, or with beams that cannot be divided again.
pub fn check(tree: &Tree) -> Option<Vec<String>> {
    let beams = tree["links"].as_array()?.iter().filter(|link| link["beam"]["sections"].is_u64()).count();
    // The paper's joint is of order 1.
    if beams == 0 || tree["links"].as_array()?.iter().any(|link| link["beam"]["section_joint"] == "paper") {
        return None;
    }
    let with = |sections: u32| {
        let mut tree = tree.clone();
        for link in tree["links"].as_array_mut().into_iter().flatten() {
            if let Some(beam) = link.get_mut("beam").and_then(Value::as_object_mut).filter(|beam| beam.contains_key("sections")) {
                beam.insert("sections".into(), json!(sections));
            }
        }
        observe(&source(&tree), false).ok()
    };
    let [coarse, middle, fine]: [Numbers; 3] = [with(SECTIONS[0])?, with(SECTIONS[1])?, with(SECTIONS[2])?];
    let mut lines = Vec::new();
    for (name, number) in &fine {
        // Forces that joints transmit are listed by bodies, of which a finer beam has others.
        let (Some(a), Some(b)) = (coarse.get(name), middle.get(name)) else { continue };
        if number.group == "cuts" || of_element(name) {
            continue;
        }
        let scale = fine.values().filter(|other| other.unit == number.unit && other.group == number.group);
        let scale = scale.map(|other| other.value.abs()).fold(1e-3, f64::max);
        let (before, after) = ((b.value - a.value).abs(), (number.value - b.value).abs());
        if after > RATIO * before && after > SMALL * scale {
            let values = [a.value, b.value, number.value];
            lines.push(format!("{name}: {values:?} {} with {SECTIONS:?} sections", number.unit));
        }
    }
    Some(lines)
}

/// Whether a number belongs to an element of a beam: `rest boom_2_psi`.
fn of_element(name: &str) -> bool {
    ["boom_", "arm_"].iter().any(|beam| name.split(beam).nth(1).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())))
}
