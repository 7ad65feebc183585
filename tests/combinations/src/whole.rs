//! The whole crane with everything around it, turned or mirrored.

use fastrand::Rng;
use serde_json::{Value, json};

use crate::second::Second;
use crate::tree::{Tree, entry_mut, gravity, numbers, set_gravity};

/// A rotation about a skew axis, by angles about z, then y.
const TURN: [f64; 2] = [0.7, 0.4];

/// A vector turned by `Rz Ry`.
fn turn(vector: &[f64]) -> [f64; 3] {
    let [(sz, cz), (sy, cy)] = TURN.map(f64::sin_cos);
    let (x, z) = (cy * vector[0] + sy * vector[2], -sy * vector[0] + cy * vector[2]);
    [cz * x - sz * vector[1], sz * x + cz * vector[1], z]
}

/// A vector turned by 90° about the vertical.
fn quarter(vector: &[f64]) -> [f64; 3] {
    [-vector[1], vector[0], vector[2]]
}

/// A crane on a fixed base, turned together with gravity and everything in the world.
pub fn turned(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let base = entry_mut(&mut second, "links", "name", "truck")?;
    // The ground does not turn.
    if base["joint"] != "fixed" || !tree["contacts"].is_null() {
        return None;
    }
    base["placement"] = json!({"transform": {"rotation": [{"z": TURN[0]}, {"y": TURN[1]}]}});
    turn_world(&mut second, &turn);
    Some(Second::new(&second).with_cautions().named(without_places))
}

/// A crane turned about the vertical together with everything in the world. Feet of small rotations need a base that is not turned.
pub fn turned_about_the_vertical(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let feet = second.get_mut("supports").and_then(Value::as_array_mut);
    for foot in feet.into_iter().flatten() {
        if foot["kinematics"] != "exact" {
            return None;
        }
        for key in ["stiffness", "damping"] {
            foot[key].as_array_mut()?.swap(0, 1);
        }
        if foot["free_play"].is_array() {
            foot["free_play"] = json!(quarter(&numbers(&foot["free_play"])));
        }
    }
    let base = entry_mut(&mut second, "links", "name", "truck")?;
    base["placement"] = json!({"transform": {"rotation": {"z": "90 deg"}}});
    turn_world(&mut second, &quarter);
    Some(Second::new(&second).with_cautions().named(without_places))
}

/// Turns everything in the world that a crane meets.
fn turn_world(second: &mut Tree, turn: &dyn Fn(&[f64]) -> [f64; 3]) {
    let turned = turn(&gravity(second));
    set_gravity(second, &turned);
    for load in second.get_mut("loads").and_then(Value::as_array_mut).into_iter().flatten() {
        for key in ["force", "moment"] {
            if load["axes"] != "link" && load[key].is_array() {
                load[key] = json!(turn(&numbers(&load[key])));
            }
        }
        if load["axes"] != "link" && load["wind"].is_object() {
            load["wind"]["direction"] = json!(turn(&numbers(&load["wind"]["direction"])));
        }
    }
    for connector in second.get_mut("connectors").and_then(Value::as_array_mut).into_iter().flatten() {
        let turned = |point: &mut Tree| {
            if point["link"].is_null() {
                point["at"] = json!(turn(&numbers(&point["at"])));
            }
        };
        for end in ["from", "to"] {
            turned(&mut connector[end]);
        }
        connector.get_mut("over").and_then(Value::as_array_mut).into_iter().flatten().for_each(turned);
    }
}

/// Names without those of vectors along the axes of the world.
fn without_places(name: &str) -> Option<String> {
    let along = ["tip_", "middle_", "load_", "rim_"].iter().any(|point| name.starts_with(point))
        || ["_reaction_x", "_reaction_y", "_slid_x", "_slid_y"].iter().any(|axis| name.ends_with(axis));
    (!along).then(|| name.to_owned())
}

/// A crane seen in a mirror: left is right, and what turned anticlockwise turns clockwise. All frames are mirrored, so that y becomes −y in each of
/// them, and rotations about x and z change their signs.
pub fn mirrored(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    mirror(&mut second, "");
    for drive in second["drives"].as_array_mut()? {
        if flips(drive["coordinate"].as_str()?) {
            negate_positions(&mut drive["motion"]);
            negate_positions(&mut drive["effort"]);
            strip_null(drive);
        }
    }
    for (input, drive) in [("trim", "boom_psi"), ("push", "arm_psi")] {
        if flips(drive)
            && let Some(value) = second.pointer_mut(&format!("/inputs/{input}/value"))
        {
            negate(value);
        }
    }
    for (coordinate, guess) in second.get_mut("guess").and_then(Value::as_object_mut).into_iter().flatten() {
        if flips(coordinate) {
            negate(guess);
        }
    }
    for (coordinate, stop) in second.get_mut("stops").and_then(Value::as_object_mut).into_iter().flatten() {
        if let Some(stop) = stop.as_object_mut().filter(|_| flips(coordinate)) {
            let [least, most] = ["min", "max"].map(|end| stop.remove(end));
            for (end, value) in [("min", most), ("max", least)] {
                if let Some(mut value) = value {
                    negate(&mut value);
                    stop.insert(end.to_owned(), value);
                }
            }
        }
    }
    Some(Second { signs: true, ..Second::new(&second) })
}

/// Whether a coordinate changes its sign.
fn flips(coordinate: &str) -> bool {
    ["_psi", "_phi", "_y"].iter().any(|axis| coordinate.ends_with(axis))
}

/// Mirrors vectors and angles.
fn mirror(tree: &mut Tree, within: &str) {
    if let Value::Array(entries) = tree {
        return entries.iter_mut().for_each(|entry| mirror(entry, within));
    }
    let Value::Object(entries) = tree else { return };
    for (key, value) in entries.iter_mut() {
        match (within, key.as_str()) {
            // Looks change no number.
            (_, "shape") => {}
            (_, "moment") | ("pin", "axis" | "to_axis") => negate_axes(value, [0, 2]),
            (_, "at" | "com" | "translation" | "force" | "direction" | "gravity" | "free_play" | "pivot")
            | ("slide", "axis")
                if value.is_array() =>
            {
                negate_axes(value, [1, 1]);
            }
            ("rotation", "x" | "z")
            | ("bend", "psi")
            | ("modified_dh" | "classic_dh", "alpha" | "theta")
            | ("inertia", "Ixy" | "Iyz")
            | ("slope", "towards") => negate(value),
            ("linkage", "side") => *value = json!(if value == "left" { "right" } else { "left" }),
            (_, key) => {
                let key = key.to_owned();
                mirror(value, &key);
            }
        }
    }
}

/// Changes the signs of some entries of a vector.
fn negate_axes(vector: &mut Tree, [one, other]: [usize; 2]) {
    for (axis, value) in vector.as_array_mut().into_iter().flatten().enumerate() {
        if axis == one || axis == other {
            negate(value);
        }
    }
}

/// Changes the sign of a number or an angle in degrees.
fn negate(value: &mut Tree) {
    match value {
        Value::Number(number) => *value = json!(-number.as_f64().unwrap_or(0.0)),
        Value::String(angle) => {
            *value = json!(angle.strip_prefix('-').map_or_else(|| format!("-{angle}"), str::to_owned));
        }
        _ => {}
    }
}

/// Changes the signs of the positions of a motion, not of its times.
fn negate_positions(motion: &mut Tree) {
    let Value::Object(entries) = motion else { return };
    for (key, value) in entries.iter_mut() {
        match key.as_str() {
            "hold" | "from" | "to" | "rate" => negate(value),
            "values" => value.as_array_mut().into_iter().flatten().for_each(negate),
            _ => negate_positions(value),
        }
    }
}

/// Removes keys without a value, which looking for them made.
fn strip_null(entries: &mut Tree) {
    entries.as_object_mut().into_iter().for_each(|entries| entries.retain(|_, value| !value.is_null()));
}
