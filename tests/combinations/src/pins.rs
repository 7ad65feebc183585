//! Cylinders described by their pins: with foot and head exchanged, and with oil as forces at them, which leave a crane at rest as it is.

use crane_model::dyn_crane::DynCrane;
use crane_model::nalgebra::Vector3;
use crane_model::results::cylinders_at;
use fastrand::Rng;
use serde_json::{Value, json};

use crate::crane::BOOM;
use crate::observe::{CAUTIONS, LINEAR, LOADS, MARGINS, MODES, STEPS, equilibrium, live};
use crate::second::Second;
use crate::tree::{Tree, entry_mut, push, source, without_unused_offset};

/// What depends on how forces change with the pose.
const OF_FORCES: &[&str] = &[CAUTIONS, MODES, STEPS, LINEAR, MARGINS, LOADS];

/// Step of differences of a length by the places of its pins, m: the error of a central difference is 1e-10 of it.
const STEP: f64 = 1e-5;

/// What a cylinder's length depends on, in the world: foot, head, pivot of the rocker, axis of the joint.
type Pins = [Vector3<f64>; 4];

/// Distance of the pins of a cylinder; with a linkage, that of the foot from the rod's pin, which is at the rocker's length from the pivot
/// and at the link's from the head, in the plane across the joint's axis, on the left or right of the line from pivot to head.
fn length([foot, head, pivot, axis]: &Pins, linkage: &Tree) -> f64 {
    let Some((rocker, link)) = linkage["rocker"].as_f64().zip(linkage["link"].as_f64()) else {
        return (head - foot).norm();
    };
    let to_head = head - pivot;
    let distance = to_head.norm();
    let cosine = (distance * distance + rocker * rocker - link * link) / (2.0 * distance * rocker);
    let left = axis.cross(&to_head).normalize();
    let aside = if linkage["side"] == "left" { left } else { -left };
    let pin = pivot + rocker * (cosine * to_head / distance + (1.0 - cosine * cosine).sqrt() * aside);
    (pin - foot).norm()
}

/// `∂ℓ` by each of what it depends on.
fn gradients(pins: &Pins, linkage: &Tree) -> Pins {
    std::array::from_fn(|of| {
        Vector3::from_fn(|axis, _| {
            let moved = |by: f64| {
                let mut pins = *pins;
                pins[of][axis] += by;
                length(&pins, linkage)
            };
            (moved(STEP) - moved(-STEP)) / (2.0 * STEP)
        })
    })
}

/// Foot and head of cylinders between two pins exchanged: their distance is the same.
pub fn exchanged(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let all = second.get_mut("cylinders")?.as_array_mut()?;
    let mut plain = all.iter_mut().filter(|cylinder| cylinder["linkage"].is_null()).peekable();
    plain.peek()?;
    for cylinder in plain {
        let foot = cylinder["foot"].take();
        cylinder["foot"] = std::mem::replace(&mut cylinder["head"], foot);
    }
    Some(Second::new(&second))
}

/// Every cylinder with a valve as forces along fixed axes at its pins; its drive is where the joint is, and has nothing to do.
pub fn as_loads(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut first = tree.clone();
    let cylinders = tree["cylinders"].as_array()?;
    let with_oil: Vec<Tree> = cylinders.iter().filter(|cylinder| cylinder["valve"].is_object()).cloned().collect();
    let joint = |cylinder: &Tree| Some(cylinder["coordinate"].as_str()?.strip_suffix("_psi")?.to_owned());
    for (k, cylinder) in with_oil.iter().enumerate() {
        let link = joint(cylinder)?;
        let mut point = |name: &str, link: &Value, at: &Value| {
            push(&mut first, "points", json!({"name": format!("pin_{k}_{name}"), "link": link, "at": at}));
        };
        for end in ["foot", "head"] {
            point(end, &cylinder[end]["link"], &cylinder[end]["at"]);
        }
        let pivot = cylinder.pointer("/linkage/pivot").unwrap_or(&cylinder["foot"]["at"]);
        point("pivot", &cylinder["foot"]["link"], pivot);
        point("joint", &json!(link), &json!([0, 0, 0]));
        point("axis", &json!(link), &json!([0, 0, 1]));
    }
    let crane = live(&source(&first)).ok()?;
    let crane: &dyn DynCrane = &crane;
    let q = equilibrium(crane).ok()?;
    let description = crane.description();
    let states = cylinders_at(crane, &q, &vec![0.0; q.len()], &crane.drive_efforts_at_rest(&q));
    let places = crane.points_at(&q);
    let mut second = first.clone();
    for (k, cylinder) in with_oil.iter().enumerate() {
        let named = |name: &str| {
            let wanted = format!("pin_{k}_{name}");
            Some(places[description.points.iter().position(|point| point.as_str() == wanted)?])
        };
        let axis = named("axis")? - named("joint")?;
        let pins = [named("foot")?, named("head")?, named("pivot")?, axis];
        let own = description.cylinders.iter().position(|own| cylinder["name"] == own.name.as_str())?;
        let force = states[own].force;
        let [foot, head, pivot, turn] = gradients(&pins, &cylinder["linkage"]).map(|gradient| force * gradient);
        let mut load = |name: &str, link: &Value, at: &Value, vector: (&str, Vector3<f64>)| {
            let vector = (vector.0, json!(vector.1.as_slice()));
            let mut load = json!({"name": format!("{name}_{k}"), "link": link, "at": at});
            load[vector.0] = vector.1;
            push(&mut second, "loads", load);
        };
        load("foot", &cylinder["foot"]["link"], &cylinder["foot"]["at"], ("force", foot));
        load("head", &cylinder["head"]["link"], &cylinder["head"]["at"], ("force", head));
        if let Some(at) = cylinder.pointer("/linkage/pivot") {
            load("pivot", &cylinder["foot"]["link"], at, ("force", pivot));
            // What carries the joint on the side of the rocker also holds the plane of the linkage across its axis.
            let at_joint = if cylinder["foot"]["link"] == "boom" { BOOM } else { 0.0 };
            load("plane", &cylinder["foot"]["link"], &json!([at_joint, 0, 0]), ("moment", axis.cross(&turn)));
        }
        second["cylinders"].as_array_mut()?.retain(|other| other["name"] != cylinder["name"]);
        let drive = entry_mut(&mut second, "drives", "coordinate", cylinder["coordinate"].as_str()?)?;
        let at = description.coordinates.iter().position(|own| cylinder["coordinate"] == own.name.as_str())?;
        drive["motion"] = json!({"hold": q[at]});
        drive.as_object_mut()?.remove("offset");
    }
    if second["cylinders"].as_array()?.is_empty() {
        let entries = second.as_object_mut()?;
        entries.retain(|key, _| !matches!(key.as_str(), "cylinders" | "pump"));
    }
    without_unused_offset(&mut second);
    let cylinders: Vec<String> =
        with_oil.iter().filter_map(|own| Some(format!("{}_", own["name"].as_str()?))).collect();
    let same = move |name: &str| {
        let of_cylinder = cylinders.iter().any(|cylinder| name.starts_with(cylinder)) || name.starts_with("pump");
        let of_drive = name.contains("drive") || name.ends_with("prescribed") || name.ends_with("energy");
        (!of_cylinder && !of_drive).then(|| name.to_owned())
    };
    Some(Second {
        first: Some(first),
        moves: false,
        without: OF_FORCES,
        ..Second::new(&second).with_other_links().named(same)
    })
}
