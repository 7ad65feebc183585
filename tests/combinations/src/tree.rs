//! A spec as a tree of keys and values.

use crane_codegen::SourceFile;
use serde_json::{Value, json};

/// The tree of a spec.
pub type Tree = Value;

/// The entry of a list whose `key` has this value.
#[must_use]
pub fn entry<'t>(tree: &'t Tree, list: &str, key: &str, value: &str) -> Option<&'t Tree> {
    tree[list].as_array()?.iter().find(|entry| entry[key] == value)
}

/// The same, to be changed.
pub fn entry_mut<'t>(tree: &'t mut Tree, list: &str, key: &str, value: &str) -> Option<&'t mut Tree> {
    tree.get_mut(list)?.as_array_mut()?.iter_mut().find(|entry| entry[key] == value)
}

/// Appends to a list, which is created if there is none.
pub fn push(tree: &mut Tree, list: &str, new: Tree) {
    if tree[list].is_null() {
        tree[list] = json!([]);
    }
    if let Some(entries) = tree[list].as_array_mut() {
        entries.push(new);
    }
}

/// Without the input that offsets a drive, if none has it any more: an input that nothing uses is a mistake.
pub fn without_unused_offset(tree: &mut Tree) {
    if entry(tree, "drives", "offset", "trim").is_none()
        && let Some(inputs) = tree.get_mut("inputs").and_then(Value::as_object_mut)
    {
        inputs.remove("trim");
    }
}

/// The numbers of a list.
#[must_use]
pub fn numbers(tree: &Tree) -> Vec<f64> {
    tree.as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
}

/// Calls a function for every point of a link, `{link, at}`.
pub fn for_each_place(tree: &mut Tree, act: &mut impl FnMut(&mut Tree)) {
    if tree.get("link").is_some() && tree.get("at").is_some_and(Value::is_array) {
        act(tree);
    }
    match tree {
        Value::Object(entries) => entries.values_mut().for_each(|value| for_each_place(value, act)),
        Value::Array(entries) => entries.iter_mut().for_each(|value| for_each_place(value, act)),
        _ => {}
    }
}

/// Calls a function for every key and its value, at any depth.
pub fn for_each_key(tree: &mut Tree, act: &mut impl FnMut(&str, &mut Tree)) {
    match tree {
        Value::Object(entries) => {
            for (key, value) in entries.iter_mut() {
                act(key, value);
                for_each_key(value, act);
            }
        }
        Value::Array(entries) => entries.iter_mut().for_each(|value| for_each_key(value, act)),
        _ => {}
    }
}

/// Gravity in the axes of the ground, m/s².
pub fn gravity(tree: &Tree) -> Vec<f64> {
    let vertical = tree.get("gravity").map_or(vec![0.0, 0.0, -9.81], numbers);
    let Some(slope) = tree.get("slope") else { return vertical };
    let [angle, towards] = ["angle", "towards"].map(|key| slope[key].as_f64().unwrap_or_default());
    let [along, down] = [-vertical[2] * angle.sin(), vertical[2] * angle.cos()];
    vec![along * towards.cos(), along * towards.sin(), down]
}

/// Gives a crane another gravity.
pub fn set_gravity(tree: &mut Tree, gravity: &[f64]) {
    tree["gravity"] = serde_json::json!(gravity);
    tree.as_object_mut().and_then(|entries| entries.remove("slope"));
}

/// Keys in the order in which a person writes them.
const ORDER: [&str; 32] = [
    "format",
    "name",
    "title",
    "gravity",
    "slope",
    "loops",
    "parameters",
    "inputs",
    "materials",
    "links",
    "supports",
    "drives",
    "couplings",
    "cylinders",
    "pump",
    "damping",
    "stops",
    "friction",
    "armature",
    "loads",
    "combinations",
    "combination",
    "connectors",
    "contacts",
    "loop_joints",
    "frames",
    "joints",
    "points",
    "guess",
    "run",
    "analyses",
    "events",
];

/// The text of a spec, ready to be run: one line per entry.
///
/// # Panics
/// If the spec has a key without a place in a file.
#[must_use]
pub fn text(tree: &Tree) -> String {
    let mut text = String::new();
    let others = tree.as_object().into_iter().flatten().map(|(key, _)| key).find(|key| !ORDER.contains(&key.as_str()));
    assert!(others.is_none(), "a random crane has the key {others:?}, which has no place in a file");
    for key in ORDER {
        match tree.get(key) {
            Some(Value::Array(entries)) if entries.iter().any(Value::is_object) => {
                text += &format!("{key}:\n");
                for entry in entries {
                    text += &format!("  - {entry}\n");
                }
            }
            Some(Value::Object(entries)) if entries.is_empty() => {}
            Some(Value::Object(entries)) => {
                text += &format!("{key}:\n");
                for (name, entry) in entries {
                    text += &format!("  {name}: {entry}\n");
                }
            }
            Some(value) if !value.is_null() => text += &format!("{key}: {value}\n"),
            _ => {}
        }
    }
    text
}

/// A spec as a file in memory.
#[must_use]
pub fn source(tree: &Tree) -> SourceFile {
    SourceFile::new("random.yaml", text(tree))
}

/// Four significant digits: as a person would write it.
#[must_use]
pub fn round(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
