//! Finer meshes: what is reported converges with the number of sections.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use crate::observe::{Extent, LOADS, Number, Numbers, live, observe, rated};
use crate::tree::{Tree, for_each_place, source};

/// The name of the check.
pub const NAME: &str = "finer meshes";
/// Sections of every beam.
const SECTIONS: [u32; 3] = [4, 8, 16];
/// The difference between the finer two over that between the coarser two: 1/4 for order 2; more, since the terms behind the leading one
/// count at four sections.
const RATIO: f64 = 0.45;
/// Differences below this share of the largest number of a unit are not looked at: Newton's tolerance for poses. For pressures, modes, stresses and
/// the loads that these limit, the terms of order 2 and 4 may cancel between the coarser two.
const SMALL: [(&str, f64); 4] = [("rest", 1e-8), ("modes", 1e-4), ("cuts", 3e-4), (LOADS, 3e-4)];
const SMALL_PRESSURE: f64 = 1e-6;

/// What does not converge with order 2; `None` for a crane without divided beams, or with beams that cannot be divided again.
pub fn check_meshes(tree: &Tree) -> Option<Vec<String>> {
    let beams = tree["links"].as_array()?.iter().filter(|link| link["beam"]["sections"].is_u64()).count();
    // The paper's joint is of order 1.
    if beams == 0 || tree["links"].as_array()?.iter().any(|link| link["beam"]["section_joint"] == "paper") {
        return None;
    }
    // Pads are at any place within a section. There the moment has a peak, which a beam spreads over a section. `engine/live/tests/cranes/sliding_beams.rs` has
    // the order of the tip, and its twist.
    if tree["links"].as_array()?.iter().any(|link| link["beam"]["slides_in"].is_object()) {
        return None;
    }
    let mut tree = tree.clone();
    move_to_borders(&mut tree);
    let with = |sections: u32| {
        let mut tree = tree.clone();
        for link in tree["links"].as_array_mut().into_iter().flatten() {
            if let Some(beam) =
                link.get_mut("beam").and_then(Value::as_object_mut).filter(|beam| beam.contains_key("sections"))
            {
                beam.insert("sections".into(), json!(sections));
            }
        }
        let mut numbers = observe(&source(&tree), Extent::default()).ok()?;
        if let Some(value) = live(&source(&tree)).ok().and_then(|crane| rated(&crane)?.load) {
            numbers.insert(format!("{LOADS} load of a chart"), Number { group: LOADS, unit: "kg".to_owned(), value });
        }
        Some(numbers)
    };
    let [coarse, middle, fine]: [Numbers; 3] = [with(SECTIONS[0])?, with(SECTIONS[1])?, with(SECTIONS[2])?];
    let of = |name: &String, number: &Number| Some((coarse.get(name)?.value, middle.get(name)?.value, number.value));
    // Forces that joints transmit are listed by bodies, of which a finer beam has others; higher modes are not yet resolved.
    let counts = |name: &String, number: &Number| {
        let high =
            ["modes", "steps", "cautions"].contains(&number.group) && !LOWEST.iter().any(|mode| name.ends_with(mode));
        (number.group != "cuts" || (name.contains("stress") && !name.contains("at place")))
            && !of_element(name)
            && !high
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
        let of_group = SMALL.iter().find(|(group, _)| *group == number.group).map_or(0.0, |(_, small)| *small);
        let small = if number.unit == "Pa" { of_group.max(SMALL_PRESSURE) } else { of_group };
        if (c - b).abs() > RATIO * change && (c - b).abs() > small * scale {
            lines.push(format!("{name}: {:?} {} with {SECTIONS:?} sections", [a, b, c], number.unit));
        }
    }
    Some(lines)
}

/// Moves all places on divided beams, and the steps between their parts, to the nearest border between equal sections of the coarsest mesh,
/// which is one of every other mesh too: then sections double exactly. Where places are anywhere, whole numbers of sections between them do not,
/// and points of interest and steps are at any place of a section.
fn move_to_borders(tree: &mut Tree) {
    let lengths: BTreeMap<String, f64> = tree["links"]
        .as_array()
        .into_iter()
        .flatten()
        .filter(|link| link["beam"]["sections"].is_u64())
        .filter_map(|link| Some((link["name"].as_str()?.to_owned(), link["beam"]["length"].as_f64()?)))
        .collect();
    for beam in tree["links"].as_array_mut().into_iter().flatten().filter_map(|link| link.get_mut("beam")) {
        let section = beam["length"].as_f64().unwrap_or(0.0) / f64::from(SECTIONS[0]);
        if let Some([first, second]) = beam.get_mut("parts").and_then(Value::as_array_mut).map(Vec::as_mut_slice) {
            let length = |part: &Value| part["length"].as_f64().unwrap_or(0.0);
            let total = length(first) + length(second);
            let step = (length(first) / section).round().max(1.0) * section;
            (first["length"], second["length"]) = (json!(step), json!(total - step));
        }
    }
    let moved = |link: &Value, x: &mut Value| {
        let Some((length, x_now)) = link.as_str().and_then(|link| lengths.get(link)).zip(x.as_f64()) else { return };
        let section = length / f64::from(SECTIONS[0]);
        *x = json!((x_now / section).round() * section);
    };
    for_each_place(tree, &mut |attached| {
        let link = attached["link"].clone();
        moved(&link, &mut attached["at"][0]);
    });
    for cylinder in tree["cylinders"].as_array_mut().into_iter().flatten() {
        let link = cylinder["foot"]["link"].clone();
        if let Some(x) = cylinder.pointer_mut("/linkage/pivot/0") {
            moved(&link, x);
        }
    }
}

/// The modes whose frequencies must converge.
const LOWEST: [&str; 3] = ["squared_0", "squared_1", "squared_2"];

/// Whether a number belongs to an element of a beam: `rest boom_2_psi`.
fn of_element(name: &str) -> bool {
    ["boom_", "arm_", "jib_"]
        .iter()
        .any(|beam| name.split(beam).nth(1).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())))
}
