//! Two descriptions of one crane: a second spec that must do the same.

use fastrand::Rng;
use serde_json::{Value, json};

use crate::crane::BOOM;
use crate::observe::{CAUTIONS, LINEAR, LOADS, MARGINS, MODES, STEPS, live};
use crate::pins;
use crate::second::Second;
use crate::tree::{Tree, entry, entry_mut, for_each_key, for_each_place, gravity, numbers, push, set_gravity, source};
use crate::{whole, wind};

/// A way to describe a crane again; `None` where it does not apply.
pub type Description = fn(&Tree, &mut Rng) -> Option<Second>;

/// All of them, with their names.
pub const ALL: [(&str, Description); 29] = [
    ("slope written as gravity", slope_as_gravity),
    ("beam split by a fixed joint", split_boom),
    ("beam given element by element", boom_one_by_one),
    ("rigid beam as a body", rigid_boom_as_body),
    ("other names", other_names),
    ("the whole turned", whole::turned),
    ("the whole turned about the vertical", whole::turned_about_the_vertical),
    ("mirrored", whole::mirrored),
    ("planes of a beam exchanged", planes_exchanged),
    ("as an overlay", overlay),
    ("parameters written in", parameters_written_in),
    ("numbers as parameters", numbers_as_parameters),
    ("numbers set, not written", numbers_set),
    ("inputs set, not written", inputs_set),
    ("angles in degrees", degrees),
    ("lists in another order", other_order),
    ("weight as a force", weight_as_force),
    ("forces as wind, wind as forces", wind_as_force),
    ("cylinders as forces at their pins", pins::as_loads),
    ("foot and head of cylinders exchanged", pins::exchanged),
    ("a loop joint holds what hangs", held_by_loop),
    ("a rigid coupling the other way around", coupled_the_other_way),
    ("branches in another order", branches_exchanged),
    ("rope link by link", rope_link_by_link),
    ("falls as sheaves", falls_as_sheaves),
    ("rope from its other end", from_its_other_end),
    ("massless frames between links", massless_frames),
    ("another unit of mass", mass_unit),
    ("loops of generated code", loops),
];

/// Whether a column or body belongs to an element of the boom, `boom_2…`, or a stress to the boom as a whole.
fn of_boom_element(name: &str) -> bool {
    name.starts_with("boom stress")
        || name.strip_prefix("boom_").is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
}

fn without_boom_elements(name: &str) -> Option<String> {
    (!of_boom_element(name)).then(|| name.to_owned())
}

/// Where a beam is tapered, its stress may peak where only one of two descriptions has a cut.
fn without_stresses_and_boom_elements(name: &str) -> Option<String> {
    without_boom_elements(name).filter(|name| !name.ends_with("stress"))
}

/// Ends of the sections of a link, from its beginning to its end, m: springs are at the ends of elements, and in the middles of sections.
fn borders(tree: &Tree, link: &str) -> Option<Vec<f64>> {
    let crane = live(&source(tree)).ok()?;
    let bodies = crane.chain().bodies.iter().filter(|body| body.link == link);
    let lengths: Vec<f64> = bodies.map(|body| body.length.at(crane.parameters())).collect();
    let (mut spring, mut borders) = (0.0, vec![0.0]);
    for length in lengths.iter().take(lengths.len().saturating_sub(1)) {
        spring += length;
        borders.push(2.0 * spring - borders.last()?);
    }
    Some(borders)
}

/// The boom in two beams with the same sections, joined by a fixed joint between two of them; none if the halves are divided elsewhere.
fn split_boom(tree: &Tree, rng: &mut Rng) -> Option<Second> {
    // The line of a slide is that of one element.
    if tree["loop_joints"].as_array().into_iter().flatten().any(|joint| joint["joint"]["slide"].is_object()) {
        return None;
    }
    let mut second = tree.clone();
    let links = second["links"].as_array_mut()?;
    let at = links.iter().position(|link| link["name"] == "boom")?;
    let beam = links[at]["beam"].clone();
    let ends = borders(tree, "boom")?;
    let sections = ends.len().checked_sub(1).filter(|sections| *sections > 1)?;
    let first = rng.usize(1..sections);
    let cut = ends[first];
    let share = cut / BOOM;
    let tapered = beam["parts"].as_array().into_iter().flatten().any(|part| part["to"].is_object());
    let mut halves = [beam.clone(), beam];
    for (half, (count, length)) in halves.iter_mut().zip([(first, cut), (sections - first, BOOM - cut)]) {
        half["sections"] = json!(count);
        half["length"] = json!(length);
    }
    if halves[0]["parts"].is_array() {
        let parts = split_parts(&halves[0]["parts"], cut);
        for (half, parts) in halves.iter_mut().zip(parts) {
            half["parts"] = parts;
        }
    }
    if halves[0]["bend"].is_object() {
        for (half, share) in halves.iter_mut().zip([share, 1.0 - share]) {
            for_each_key(&mut half["bend"], &mut |_, angle| *angle = json!(share * angle.as_f64().unwrap_or(0.0)));
        }
    }
    let [inner, outer] = halves;
    links[at]["beam"] = inner;
    links.insert(at + 1, json!({"name": "front", "beam": outer}));
    let moved = |attached: &mut Tree| {
        let x = attached["at"][0].as_f64().unwrap_or(0.0);
        if attached["link"] == "boom" && x >= cut {
            attached["link"] = json!("front");
            attached["at"][0] = json!(x - cut);
        }
    };
    for list in ["links", "loads", "connectors", "cylinders", "loop_joints", "points"] {
        if let Some(entries) = second.get_mut(list) {
            for_each_place(entries, &mut { moved });
        }
    }
    // The pivot of a linkage is on the link of the foot, and has to be split with it.
    let pivot = second["cylinders"].as_array().into_iter().flatten().any(|cylinder| cylinder["linkage"].is_object());
    if pivot {
        return None;
    }
    let behind = borders(&second, "front")?.into_iter().map(|x| cut + x);
    let ends_of_halves: Vec<f64> = borders(&second, "boom")?.into_iter().chain(behind.skip(1)).collect();
    let same = |(one, other): (&f64, &f64)| (one - other).abs() < 1e-9;
    if ends_of_halves.len() != ends.len() || !ends.iter().zip(&ends_of_halves).all(same) {
        return None;
    }
    Some(Second::new(&second).with_other_links().named(if tapered {
        without_stresses_and_boom_elements
    } else {
        without_boom_elements
    }))
}

/// Parts of a beam before and behind a place.
fn split_parts(parts: &Tree, cut: f64) -> [Tree; 2] {
    let mut halves = [Vec::new(), Vec::new()];
    let mut begin = 0.0;
    for part in parts.as_array().into_iter().flatten() {
        let length = part["length"].as_f64().unwrap_or(0.0);
        let share = ((cut - begin) / length).clamp(0.0, 1.0);
        let section = |share: f64| {
            let mut section = part["section"].clone();
            if part["to"].is_object() {
                for (shape, to) in part["to"].as_object().into_iter().flatten() {
                    for (key, to) in to.as_object().into_iter().flatten() {
                        let from = section[shape][key].as_f64().unwrap_or(0.0);
                        section[shape][key] = json!((1.0 - share) * from + share * to.as_f64().unwrap_or(0.0));
                    }
                }
            }
            section
        };
        for (half, [from, to]) in halves.iter_mut().zip([[0.0, share], [share, 1.0]]) {
            if to > from {
                let mut piece = json!({"length": (to - from) * length, "section": section(from)});
                if part["to"].is_object() {
                    piece["to"] = section(to);
                }
                half.push(piece);
            }
        }
        begin += length;
    }
    halves.map(Value::Array)
}

/// Area, `J_y`, `J_z` and torsion constant of a box, by hand.
fn box_section(section: &Tree) -> Option<[f64; 4]> {
    let side = |key: &str| section["box"][key].as_f64();
    let (h, b, t) = (side("height")?, side("width")?, side("thickness")?);
    let (hi, bi) = (h - 2.0 * t, b - 2.0 * t);
    let torsion = 2.0 * t * (b - t).powi(2) * (h - t).powi(2) / (b + h - 2.0 * t);
    Some([b * h - bi * hi, (h * b.powi(3) - hi * bi.powi(3)) / 12.0, (b * h.powi(3) - bi * hi.powi(3)) / 12.0, torsion])
}

/// Mass, and moments of inertia about the centre of mass, of a length of the boom.
fn piece_of_boom(beam: &Tree, length: f64) -> Option<(f64, [f64; 3])> {
    let [area, jy, jz, _] = box_section(&beam["section"])?;
    let mass = (7850.0 * area + beam["extra_mass"].as_f64().unwrap_or(0.0)) * length;
    let slender = length * length / 12.0;
    Some((mass, [mass * (jy + jz) / area, mass * (slender + jy / area), mass * (slender + jz / area)]))
}

/// The boom's elements and springs worked out by hand.
fn boom_one_by_one(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let link = entry_mut(&mut second, "links", "name", "boom")?;
    let beam = link["beam"].clone();
    if beam["bend"].is_object() {
        return None;
    }
    beam["sections"].as_u64()?;
    let sections: Vec<f64> = borders(tree, "boom")?.windows(2).map(|ends| ends[1] - ends[0]).collect();
    let [_, jy, jz, jo] = box_section(&beam["section"])?;
    let halves = |k: usize| sections.get(k).map_or(0.0, |section| 0.5 * section);
    let element = |k: usize| {
        let length = k.checked_sub(1).map_or(0.0, halves) + halves(k);
        let (mass, [xx, yy, zz]) = piece_of_boom(&beam, length)?;
        Some(
            json!({"length": length, "mass": mass, "com": [0.5 * length, 0, 0], "inertia": {"Ixx": xx, "Iyy": yy, "Izz": zz}}),
        )
    };
    let elements: Vec<Tree> = (0..=sections.len()).map(element).collect::<Option<_>>()?;
    let beta = beam["damping"]["beta"].as_f64().unwrap_or(0.0);
    let spring = |d: &f64| {
        let stiffness = [2.1e11 * jz / d, 2.1e11 * jy / d, 8.1e10 * jo / d];
        let each = |factor: f64| json!({"psi": factor * stiffness[0], "theta": factor * stiffness[1], "phi": factor * stiffness[2]});
        json!({"stiffness": each(1.0), "damping": each(beta)})
    };
    let springs: Vec<Tree> = sections.iter().map(spring).collect();
    link["beam"] = json!({"length": BOOM, "elements": elements, "springs": springs});
    if beam["section_joint"].is_string() {
        link["beam"]["section_joint"] = beam["section_joint"].clone();
    }
    // Elements that are given one by one have no sections, so no stress limits loads.
    let without = &[CAUTIONS, LOADS];
    Some(Second { without, ..Second::new(&second).named(|name| (!name.contains("stress")).then(|| name.to_owned())) })
}

/// A beam without springs, and the body that it is.
fn rigid_boom_as_body(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut first = tree.clone();
    let link = entry_mut(&mut first, "links", "name", "boom")?;
    let beam = link["beam"].as_object_mut()?;
    beam.insert("sections".into(), json!("rigid"));
    beam.retain(|key, _| !matches!(key.as_str(), "bend" | "section_joint"));
    let (mass, [xx, yy, zz]) = piece_of_boom(&link["beam"], BOOM)?;
    let mut second = first.clone();
    let link = entry_mut(&mut second, "links", "name", "boom")?;
    link.as_object_mut()?.remove("beam");
    link["mass"] = json!(mass);
    link["com"] = json!([0.5 * BOOM, 0, 0]);
    link["inertia"] = json!({"Ixx": xx, "Iyy": yy, "Izz": zz});
    let arm = entry_mut(&mut second, "links", "name", "arm")?;
    if arm["placement"].is_object() {
        return None;
    }
    arm["placement"] = json!({"transform": {"translation": [BOOM, 0, 0]}});
    let second = Second { first: Some(first), ..Second::new(&second) };
    // The body of a rigid beam is called after its element. It has no sections, so no bending moments.
    let of_sections = |name: &str| name.contains("stress") || name.starts_with("bending by");
    Some(second.named(move |name| (!of_sections(name)).then(|| name.replace("boom_0", "boom"))))
}

/// Every link has another name.
fn other_names(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let links: Vec<String> =
        tree["links"].as_array()?.iter().filter_map(|link| Some(link["name"].as_str()?.to_owned())).collect();
    let renamed = move |name: &str| {
        let known = links
            .iter()
            .any(|link| name == link || name.starts_with(&format!("{link}_")) || name.starts_with(&format!("{link} ")));
        if known { format!("zz_{name}") } else { name.to_owned() }
    };
    let mut second = tree.clone();
    for link in second["links"].as_array_mut()? {
        link["name"] = json!(renamed(link["name"].as_str()?));
    }
    for_each_key(&mut second, &mut |key, value| {
        if let (true, Some(name)) = (matches!(key, "link" | "on" | "beam" | "coordinate" | "follows"), value.as_str()) {
            *value = json!(renamed(name));
        }
    });
    for list in ["damping", "stops", "friction", "guess", "armature"] {
        if let Some(entries) = second.get(list).and_then(Value::as_object) {
            let entries: serde_json::Map<_, _> =
                entries.iter().map(|(name, value)| (renamed(name), value.clone())).collect();
            second[list] = Value::Object(entries);
        }
    }
    // A point may be called as a link is.
    Some(Second::new(&second).named(move |name| Some(renamed(name))))
}

/// A slope of the ground as the gravity that it means.
fn slope_as_gravity(tree: &Tree, _: &mut Rng) -> Option<Second> {
    tree.get("slope")?;
    let mut second = tree.clone();
    set_gravity(&mut second, &gravity(tree));
    Some(Second::new(&second).with_cautions())
}

/// Positions in a frame that is turned by 90° about x.
fn quarter(at: &[f64]) -> [f64; 3] {
    [at[0], at[2], -at[1]]
}

/// The boom's frame turned by 90° about x: ψ becomes θ, the section lies on its side.
fn planes_exchanged(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let boom = entry_mut(&mut second, "links", "name", "boom")?;
    let beam = boom["beam"].as_object_mut()?;
    // One after the other, rotations of the paper's joint depend on what is called ψ.
    if beam.contains_key("section_joint") || beam.contains_key("elements") {
        return None;
    }
    if let Some(bend) = beam.get_mut("bend") {
        // About the new y is what was about z; about the new z what was about −y.
        *bend = json!({"theta": bend["psi"], "psi": -bend["theta"].as_f64()?});
    }
    for_each_key(&mut boom["beam"], &mut |key, value| {
        if key == "box" {
            *value = json!({"height": value["width"], "width": value["height"], "thickness": value["thickness"]});
        }
    });
    let placement = &mut boom["placement"]["transform"];
    placement["rotation"] = json!([placement.get("rotation")?.clone(), {"x": "90 deg"}]);
    boom["joint"] = json!({"revolute": {"axis": "y"}});
    let arm = entry_mut(&mut second, "links", "name", "arm")?;
    if arm["placement"].is_object() {
        return None;
    }
    let back = json!({"transform": {"rotation": {"x": "-90 deg"}}});
    arm["placement"] = back.clone();
    if let Some(lamp) = entry_mut(&mut second, "links", "name", "lamp") {
        lamp["placement"] = back;
    }
    for list in ["links", "loads", "connectors", "cylinders", "loop_joints", "points"] {
        let Some(entries) = second.get_mut(list) else { continue };
        for_each_place(entries, &mut |attached| {
            if attached["link"] == "boom" {
                attached["at"] = json!(quarter(&numbers(&attached["at"])));
            }
        });
    }
    for cylinder in second.get_mut("cylinders").and_then(Value::as_array_mut).into_iter().flatten() {
        if cylinder["linkage"].is_object() && cylinder["foot"]["link"] == "boom" {
            cylinder["linkage"]["pivot"] = json!(quarter(&numbers(&cylinder["linkage"]["pivot"])));
        }
    }
    for joint in second.get_mut("loop_joints").and_then(Value::as_array_mut).into_iter().flatten() {
        if joint["joint"]["pin"].is_object() && joint["to"]["link"] == "boom" {
            joint["joint"]["pin"]["to_axis"] = json!(quarter(&numbers(&joint["joint"]["pin"]["axis"])));
        }
        if joint["joint"]["slide"].is_object() && joint["from"]["link"] == "boom" {
            joint["joint"]["slide"]["axis"] = json!(quarter(&numbers(&joint["joint"]["slide"]["axis"])));
        }
    }
    for_each_key(&mut second, &mut |key, value| {
        if key == "coordinate" && value == "boom_psi" {
            *value = json!("boom_theta");
        }
    });
    // What a groove of the boom exerts is in the axes of the boom.
    let same = |name: &str| (!name.starts_with("groove_force")).then(|| name.replace("boom_psi", "boom_theta"));
    Some(Second::new(&second).named(move |name| without_boom_elements(&same(name)?)))
}

/// A spec that extends one with other numbers.
fn overlay(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut base = tree.clone();
    let mut changes = json!({"name": tree["name"], "links": [], "drives": [], "run": tree["run"]});
    for link in base["links"].as_array_mut()? {
        if let Some(mass) = link["mass"].as_f64() {
            changes["links"].as_array_mut()?.push(json!({"name": link["name"], "mass": mass}));
            link["mass"] = json!(2.0 * mass);
        }
    }
    for drive in base["drives"].as_array_mut()? {
        if drive["stiffness"].is_f64() {
            changes["drives"]
                .as_array_mut()?
                .push(json!({"coordinate": drive["coordinate"], "stiffness": drive["stiffness"]}));
            drive["stiffness"] = json!(1e5);
        }
    }
    for list in ["links", "drives"] {
        if changes[list].as_array()?.is_empty() {
            changes.as_object_mut()?.remove(list);
        }
    }
    base["name"] = json!("base");
    let text = changes.to_string();
    Some(Second { source: source(&base).changed(&text), ..Second::new(tree) }.with_cautions())
}

/// Whether a number is a value of the live parameter that is the load, or what happens or is there.
fn of_load(name: &str) -> bool {
    ["load of ", "load that ", "governed by "].iter().any(|what| name.starts_with(what))
        || name.ends_with(" of a chart")
}

fn parameters_written_in(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let parameters = second.as_object_mut()?.remove("parameters")?;
    let parameters = parameters.as_object().filter(|parameters| !parameters.is_empty())?.clone();
    for_each_key(&mut second, &mut |key, value| {
        if let Some(parameter) = value.as_str().filter(|_| key != "name").and_then(|name| parameters.get(name)) {
            *value = parameter["value"].clone();
        }
    });
    let without_load = |name: &str| (!of_load(name)).then(|| name.to_owned());
    Some(Second::new(&second).with_cautions().named(without_load))
}

/// Masses, stiffnesses and an angle become live parameters.
pub(crate) fn numbers_as_parameters(tree: &Tree, _: &mut Rng) -> Option<Second> {
    Some(Second::new(&with_parameters(tree)?.0).with_cautions())
}

/// They become live parameters with other values, and are set to those of the first.
fn numbers_set(tree: &Tree, rng: &mut Rng) -> Option<Second> {
    let (mut second, made) = with_parameters(tree)?;
    let mut set = Vec::new();
    for name in made {
        let value = &mut second["parameters"][&name]["value"];
        let written = value.as_f64()?;
        set.push((name, written));
        *value = json!(written * (1.0 + 0.03 * rng.f64()));
    }
    Some(Second { set, ..Second::new(&second).with_cautions() })
}

/// Inputs have other values, or follow a motion, and are set to the values of the first.
fn inputs_set(tree: &Tree, rng: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let mut set = Vec::new();
    for (name, input) in second.get_mut("inputs").and_then(Value::as_object_mut)? {
        let Some(value) = input["value"].as_f64() else { continue };
        set.push((name.clone(), value));
        input.as_object_mut()?.retain(|key, _| key != "value");
        let other = value * (1.0 + 0.1 * rng.f64());
        if rng.bool() {
            input["value"] = json!(other);
        } else {
            input["motion"] = json!({"cubic": {"from": other, "to": value, "begin": 0.1, "duration": 0.2}});
        }
    }
    (!set.is_empty()).then(|| Second { set, ..Second::new(&second).with_cautions() })
}

/// Lists whose numbers of these names become live, wherever they stand.
const MOVING: [&str; 5] = ["drives", "loads", "connectors", "stops", "friction"];
const LIVE: [&str; 19] = [
    "from",
    "to",
    "begin",
    "duration",
    "min",
    "max",
    "stiffness",
    "damping",
    "coulomb",
    "breakaway",
    "viscous",
    "length",
    "force",
    "progression",
    "offset",
    "shape_factor",
    "area",
    "max_effort",
    "ratio",
];

/// A crane some of whose numbers are live parameters, and their names.
pub(crate) fn with_parameters(tree: &Tree) -> Option<(Tree, Vec<String>)> {
    let mut second = tree.clone();
    let mut made = serde_json::Map::new();
    let mut live = |name: &str, value: &mut Tree| {
        if value.is_number() {
            made.insert(name.to_owned(), json!({"value": value}));
            *value = json!(name);
        }
    };
    for (k, link) in second["links"].as_array_mut()?.iter_mut().enumerate() {
        live(&format!("mass_{k}"), &mut link["mass"]);
        live(&format!("extra_{k}"), &mut link["beam"]["extra_mass"]);
        live(&format!("beta_{k}"), &mut link["beam"]["damping"]["beta"]);
        strip(link);
    }
    for (k, drive) in second["drives"].as_array_mut()?.iter_mut().enumerate() {
        live(&format!("drive_{k}"), &mut drive["stiffness"]);
        live(&format!("position_{k}"), &mut drive["motion"]["hold"]);
        strip(drive);
    }
    for (k, foot) in second.get_mut("supports").and_then(Value::as_array_mut).into_iter().flatten().enumerate() {
        live(&format!("ground_{k}"), &mut foot["stiffness"][2]);
        live(&format!("place_{k}"), &mut foot["at"][1]);
        live(&format!("grip_{k}"), &mut foot["friction_coefficient"]);
        strip(foot);
    }
    for (k, connector) in second.get_mut("connectors").and_then(Value::as_array_mut).into_iter().flatten().enumerate() {
        live(&format!("end_{k}"), &mut connector["to"]["at"][1]);
    }
    for list in MOVING {
        let mut count = 0;
        let entries: Vec<&mut Value> = match second.get_mut(list) {
            Some(Value::Array(entries)) => entries.iter_mut().collect(),
            Some(Value::Object(entries)) => entries.values_mut().collect(),
            _ => Vec::new(),
        };
        // Friction with bristles has numbers.
        for entry in entries.into_iter().filter(|entry| entry.get("bristle").is_none()) {
            for_each_key(entry, &mut |key, value| {
                if LIVE.contains(&key) {
                    live(&format!("{list}_{key}_{count}"), value);
                    count += 1;
                }
            });
        }
    }
    let names = made.keys().cloned().collect();
    for (name, entry) in made {
        second["parameters"][name] = entry;
    }
    Some((second, names))
}

/// Removes keys without a value, which looking for them made.
fn strip(tree: &mut Tree) {
    if let Value::Object(entries) = tree {
        entries.values_mut().for_each(strip);
        entries.retain(|_, value| !value.is_null() && value.as_object().is_none_or(|entries| !entries.is_empty()));
    }
}

fn degrees(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    for drive in second["drives"].as_array_mut()? {
        if drive["coordinate"].as_str().is_some_and(|name| name.ends_with("psi")) {
            for_each_key(&mut drive["motion"], &mut |key, value| {
                if let (true, Some(angle)) = (matches!(key, "from" | "to" | "hold"), value.as_f64()) {
                    *value = json!(format!("{:?} deg", angle.to_degrees()));
                }
            });
        }
    }
    Some(Second::new(&second).with_cautions())
}

fn other_order(tree: &Tree, rng: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    for list in ["supports", "drives", "loads", "connectors", "cylinders", "loop_joints", "points"] {
        if let Some(entries) = second.get_mut(list).and_then(Value::as_array_mut) {
            rng.shuffle(entries);
        }
    }
    Some(Second::new(&second))
}

/// Half of the weight of the hook's load as a force at its centre of mass: the same at rest.
fn weight_as_force(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let gravity = gravity(tree);
    let hook = entry_mut(&mut second, "links", "name", "hook")?;
    let at = hook["com"].clone();
    let half = if hook["mass"] == "payload" {
        let value = second["parameters"]["payload"]["value"].as_f64()?;
        second["parameters"]["payload"]["value"] = json!(0.5 * value);
        0.5 * value
    } else {
        let mass = hook["mass"].as_f64()?;
        hook["mass"] = json!(0.5 * mass);
        0.5 * mass
    };
    let force: Vec<f64> = gravity.iter().map(|g| half * g).collect();
    push(&mut second, "loads", json!({"name": "weight", "link": "hook", "at": at, "force": force}));
    let same = |name: &str| {
        let of_inertia = name.ends_with("energy") || of_load(name);
        (!of_inertia).then(|| name.to_owned())
    };
    let without = &[CAUTIONS, MODES, STEPS, LINEAR, MARGINS];
    Some(Second { moves: false, without, ..Second::new(&second).named(same) })
}

/// Forces of loads as wind, and wind as forces.
fn wind_as_force(tree: &Tree, rng: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let loads = second.get_mut("loads").and_then(Value::as_array_mut)?;
    let exchanged = loads.iter_mut().filter_map(|load| wind::exchange(load, rng).then_some(())).count();
    (exchanged > 0).then(|| Second::new(&second))
}

/// The falls of a rope one by one: back and forth between its last sheave and its end.
fn falls_as_sheaves(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let rope = entry_mut(&mut second, "connectors", "name", "reeving")?;
    let falls = rope["falls"].as_u64()?;
    rope.as_object_mut()?.remove("falls");
    let mut points = rope["over"].as_array()?.clone();
    points.push(rope["to"].clone());
    for _ in 1..falls {
        points.push(points[points.len() - 2].clone());
    }
    rope["to"] = points.pop()?;
    rope["over"] = json!(points);
    Some(Second::new(&second).named(without_places_of_rope))
}

/// A rope from `to` over its sheaves to `from`.
fn from_its_other_end(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let rope = entry_mut(&mut second, "connectors", "name", "reeving")?;
    if rope.get("falls").is_some() {
        return None;
    }
    [rope["from"], rope["to"]] = [rope["to"].clone(), rope["from"].clone()];
    rope["over"].as_array_mut()?.reverse();
    Some(Second::new(&second))
}

/// Names without those of places at the rope's ends, which are sheaves in the other description.
fn without_places_of_rope(name: &str) -> Option<String> {
    (!name.contains("of reeving")).then(|| name.to_owned())
}

/// Every link of the rope as two links with a joint each, its mass in three points by Simpson's rule, which is exact for a rod.
fn rope_link_by_link(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let links = second["links"].as_array_mut()?;
    let at = links.iter().position(|link| link["name"] == "rope")?;
    let rope = links.remove(at);
    let (count, fields) = (rope["rope"]["links"].as_u64()?, &rope["rope"]);
    let length = fields["length"].as_f64()? / count as f64;
    let mass = fields["mass_per_length"].as_f64()? * length;
    let mut made = Vec::new();
    for k in 1..=count {
        let along = json!({"transform": {"translation": [length, 0, 0]}});
        let placement = if k == 1 { rope["placement"].clone() } else { along };
        made.push(json!({"name": format!("rope_{k}"), "placement": placement, "joint": "revolute"}));
        let point = |name: &str, share: f64, x: f64| json!({"name": format!("{name}_{k}"), "mass": share * mass, "com": [x, 0, 0]});
        made.push(json!({"name": format!("rope_{k}_y"), "joint": {"revolute": {"axis": "y"}},
            "bodies": [point("start", 1.0 / 6.0, 0.0), point("middle", 4.0 / 6.0, 0.5 * length), point("end", 1.0 / 6.0, length)]}));
    }
    links.splice(at..at, made);
    let hook = links.iter_mut().find(|link| link["name"] == "hook")?;
    hook["placement"] = json!({"transform": {"translation": [length, 0, 0]}});
    if let Some(damping) = fields["damping"].as_f64() {
        for k in 1..=count {
            second["damping"][format!("rope_{k}_psi")] = json!(damping);
            second["damping"][format!("rope_{k}_y_theta")] = json!(damping);
        }
    }
    // Bodies of the rope are bodies of links with other names.
    Some(Second::new(&second).with_other_links().named(|name| {
        let is_body = name.starts_with("rope_") && name.contains(' ');
        if is_body {
            None
        } else if name.starts_with("rope_") {
            Some(name.replace("_theta", "_y_theta"))
        } else {
            Some(name.to_owned())
        }
    }))
}

/// What follows the arm, or its stages, slides along three axes and is held in its place by a loop joint.
fn held_by_loop(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let links = second["links"].as_array_mut()?;
    let held = links.iter().position(|link| ["rope", "swing", "hook"].iter().any(|name| link["name"] == *name))?;
    let mut anchor = json!({"name": "anchor"});
    anchor["placement"] = links[held].as_object_mut()?.remove("placement")?;
    let slide = |axis: &str| json!({"name": format!("slide_{axis}"), "joint": {"prismatic": {"axis": axis}}});
    links.splice(held..held, [anchor, slide("x"), slide("y"), slide("z")]);
    let joint = json!({"name": "holder", "from": {"link": "anchor", "at": [0, 0, 0]}, "to": {"link": "slide_z", "at": [0, 0, 0]},
        "joint": "ball"});
    push(&mut second, "loop_joints", joint);
    // The factor by the stiffness alone is none of closed loops.
    let named = |name: &str| (name != "factor by the stiffness").then(|| name.to_owned());
    Some(Second::new(&second).with_other_links().named(named))
}

/// What followed leads: `q_i = q_j/r − c/r`. The coupling's force is then that on what leads.
fn coupled_the_other_way(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let coupling =
        entry_mut(&mut second, "couplings", "name", "chains").filter(|coupling| coupling["rigid"] == true)?;
    let (ratio, offset) = (coupling["ratio"].as_f64()?, coupling["offset"].as_f64()?);
    let [follower, leader] = ["coordinate", "follows"].map(|key| coupling[key].clone());
    (coupling["coordinate"], coupling["follows"]) = (leader, follower);
    (coupling["ratio"], coupling["offset"]) = (json!(1.0 / ratio), json!(-offset / ratio));
    Some(Second::new(&second).named(|name| (!name.contains("chains")).then(|| name.to_owned())))
}

/// The second arm before what the column carried first.
fn branches_exchanged(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    entry_mut(&mut second, "links", "name", "boom")?["on"] = json!("column");
    let links = second["links"].as_array_mut()?;
    let position = |name: &str| links.iter().position(|link| link["name"] == name);
    let (boom, jib, lamp) = (position("boom")?, position("jib")?, position("lamp")?);
    links[boom..lamp].rotate_left(jib - boom);
    Some(Second::new(&second))
}

/// The placement of every other link belongs to a massless link before it.
fn massless_frames(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    let mut links = Vec::new();
    for (k, mut link) in second["links"].as_array()?.iter().cloned().enumerate() {
        if link["placement"]["transform"].is_object() && k > 0 {
            let mut frame = json!({"name": format!("frame_{k}")});
            for key in ["on", "placement"] {
                if let Some(value) = link.as_object_mut()?.remove(key) {
                    frame[key] = value;
                }
            }
            links.push(frame);
        }
        links.push(link);
    }
    second["links"] = Value::Array(links);
    Some(Second::new(&second).with_other_links())
}

/// Keys whose numbers are proportional to the unit of mass.
const WITH_MASS: &[&str] = &[
    "axial_stiffness",
    "progression",
    "mass",
    "Ixx",
    "Iyy",
    "Izz",
    "Ixy",
    "Ixz",
    "Iyz",
    "E",
    "G",
    "density",
    "yield_stress",
    "stiffness",
    "damping",
    "max_effort",
    "max_tension",
    "max_power",
    "armature",
    "force",
    "moment",
    "coulomb",
    "breakaway",
    "viscous",
    "extra_mass",
    "mass_per_length",
    "max_pressure",
    "back_pressure",
    "bulk_modulus",
    "pressure",
    "swing_psi",
    "hook_theta",
    "payload",
    "pressure_drop",
];
/// Their factor.
const HEAVIER: f64 = 2.0;

/// Everything in a unit of half a kilogram: numbers with the unit of mass double, nothing moves differently.
fn mass_unit(tree: &Tree, _: &mut Rng) -> Option<Second> {
    // The law of a valve's edges has a pressure of its own, at which they become laminar.
    if tree["cylinders"].as_array().into_iter().flatten().any(|cylinder| cylinder["valve"].is_object()) {
        return None;
    }
    let mut second = tree.clone();
    heavier(&mut second, "");
    if let Some(value) = second["parameters"]["payload"]["value"].as_f64() {
        second["parameters"]["payload"]["value"] = json!(HEAVIER * value);
    }
    if let Some(push) = second.pointer_mut("/inputs/push/value") {
        double(push);
    }
    let factor = |unit: &str| if ["N", "N m", "J", "W", "Pa", "kg"].contains(&unit) { HEAVIER } else { 1.0 };
    Some(Second { factor: Box::new(factor), ..Second::new(&second) })
}

fn heavier(tree: &mut Tree, within: &str) {
    match tree {
        Value::Object(entries) => {
            for (key, value) in entries.iter_mut() {
                if key == "effort" {
                    // Its times stay.
                    for end in ["/cubic/from", "/cubic/to"] {
                        if let Some(end) = value.pointer_mut(end) {
                            double(end);
                        }
                    }
                    continue;
                }
                if within == "wind" && key == "speed" {
                    *value = json!(HEAVIER.sqrt() * value.as_f64().unwrap_or(0.0));
                    continue;
                }
                // Where damping is a time over a length or a time, not a force over a rate.
                let per_length = matches!(within, "rope_law" | "stops" | "contacts");
                if WITH_MASS.contains(&key.as_str())
                    && !(key == "damping" && per_length)
                    && !matches!(within, "guess" | "parameters")
                {
                    double(value);
                } else {
                    let law = if within == "law" && key == "rope" { "rope_law" } else { key };
                    heavier(value, if within == "stops" { "stops" } else { law });
                }
            }
        }
        Value::Array(entries) => entries.iter_mut().for_each(|entry| heavier(entry, within)),
        _ => {}
    }
}

/// Doubles all numbers, except Kelvin–Voigt times.
fn double(tree: &mut Tree) {
    match tree {
        Value::Object(entries) => {
            for (_, value) in entries.iter_mut().filter(|(key, _)| *key != "beta") {
                double(value);
            }
        }
        Value::Array(entries) => entries.iter_mut().for_each(double),
        Value::Number(number) => *tree = json!(HEAVIER * number.as_f64().unwrap_or(0.0)),
        _ => {}
    }
}

fn loops(tree: &Tree, _: &mut Rng) -> Option<Second> {
    let mut second = tree.clone();
    second["loops"] = json!("always");
    entry(tree, "links", "name", "boom")?;
    Some(Second::new(&second).with_cautions())
}
