//! Finer meshes: what is reported converges with the number of sections.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use crate::observe::{Number, Numbers, observe};
use crate::tree::{Tree, source};

/// The name of the check.
pub const NAME: &str = "finer meshes";
/// Sections of every beam.
const SECTIONS: [u32; 3] = [4, 8, 16];
/// The difference between the finer two over that between the coarser two: 1/4 for order 2; more, since the terms behind the leading one
/// count at four sections.
const RATIO: f64 = 0.45;
/// Differences below this share of the largest number of a unit are not looked at: a place within a section is off by up to an eighth of
/// the square of the section's length times the curvature, or not at all, depending on where it is.
const SMALL: f64 = 2e-5;

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
            if let Some(beam) =
                link.get_mut("beam").and_then(Value::as_object_mut).filter(|beam| beam.contains_key("sections"))
            {
                beam.insert("sections".into(), json!(sections));
            }
        }
        observe(&source(&tree), false).ok()
    };
    let [coarse, middle, fine]: [Numbers; 3] = [with(SECTIONS[0])?, with(SECTIONS[1])?, with(SECTIONS[2])?];
    let of = |name: &String, number: &Number| Some((coarse.get(name)?.value, middle.get(name)?.value, number.value));
    // Forces that joints transmit are listed by bodies, of which a finer beam has others; higher modes are not yet resolved.
    let counts = |name: &String, number: &Number| {
        let high = number.group == "modes" && !LOWEST.iter().any(|mode| name.ends_with(mode));
        number.group != "cuts" && !of_element(name) && !high
    };
    // The error of a place within a section depends on where between two springs it is, so it need not fall at each refinement: it is
    // compared with the largest change of any number of its unit.
    let mut changes: BTreeMap<(&str, &str), [f64; 2]> = BTreeMap::new();
    for (name, number) in fine.iter().filter(|(name, number)| counts(name, number)) {
        let Some((a, b, _)) = of(name, number) else { continue };
        let [change, scale] = changes.entry((number.group, &number.unit)).or_insert([0.0; 2]);
        (*change, *scale) = (change.max((b - a).abs()), scale.max(number.value.abs()));
    }
    let mut lines = Vec::new();
    for (name, number) in fine.iter().filter(|(name, number)| counts(name, number)) {
        let Some((a, b, c)) = of(name, number) else { continue };
        let [change, scale] = changes[&(number.group, number.unit.as_str())];
        if (c - b).abs() > RATIO * change && (c - b).abs() > SMALL * scale {
            lines.push(format!("{name}: {:?} {} with {SECTIONS:?} sections", [a, b, c], number.unit));
        }
    }
    Some(lines)
}

/// The modes whose frequencies must converge.
const LOWEST: [&str; 3] = ["squared_0", "squared_1", "squared_2"];

/// Whether a number belongs to an element of a beam: `rest boom_2_psi`.
fn of_element(name: &str) -> bool {
    ["boom_", "arm_"]
        .iter()
        .any(|beam| name.split(beam).nth(1).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())))
}
