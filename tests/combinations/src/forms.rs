//! Other forms of the language in a random crane: they need no feature, and meet all of them.

use fastrand::Rng;
use serde_json::{Value, json};

use crate::tree::{Tree, entry, entry_mut, gravity, push, round};
use crate::wind;

/// Writes some parts of a crane in other forms, chosen by its seed. Its other random numbers do not depend on this.
pub fn vary(seed: u64, tree: &mut Tree) {
    let mut rng = Rng::with_seed(seed ^ 0xf0f0);
    if let Some(jib) = entry_mut(tree, "links", "name", "jib") {
        jib["beam"]["section"] = section(&mut rng, &jib["beam"]["section"]);
        jib["beam"]["section_joint"] = json!(rng.choice(["symmetric", "paper"]));
        if rng.bool() {
            jib["beam"]["damping"] = json!({"coefficients": {"psi": 2e3, "theta": 1.5e3, "phi": 900}});
        }
    }
    if let Some(platform) = entry_mut(tree, "links", "name", "platform") {
        mass(&mut rng, platform);
        platform["placement"] = if rng.bool() {
            json!({"classic_dh": {"a": 0.05, "alpha": "10 deg", "d": 0.02, "theta": round(rng.f64())}})
        } else {
            json!({"transform": {"rotation": {"y": "5 deg"}}})
        };
    }
    if let Some(column) = entry_mut(tree, "links", "name", "column").filter(|column| column["joint"] == "revolute")
        && rng.bool()
    {
        column["joint"] = json!({"revolute": {"axis": "z"}});
    }
    // With random numbers of its own, so that all others stay.
    let mut halts = Rng::with_seed(seed ^ 0x4a17);
    for drive in entries(tree, "drives") {
        if let Some(quintic) = drive["motion"]["quintic"].as_object().cloned() {
            let slews = drive["coordinate"] == "column_psi" && drive["rigid"] != true;
            drive["motion"] = motion(&mut rng, slews, quintic.into());
        }
        if drive["motion"]["hold"].is_null() && drive["motion"]["input"].is_null() && halts.u8(0..3) == 0 {
            drive["halt"] = halt(&mut halts);
        }
        if drive["max_effort"].is_number() && rng.bool() {
            (drive["max_rate"], drive["max_power"]) = (json!(0.4), json!(5e4));
        }
    }
    for load in entries(tree, "loads").filter(|load| load["axes"].is_null()) {
        load["axes"] = json!("world");
    }
    for rope in entries(tree, "connectors").filter_map(|connector| connector.get_mut("law")?.get_mut("rope")) {
        if rope["motion"].is_object() && halts.bool() {
            rope["halt"] = halt(&mut halts);
        }
    }
    if halts.bool() {
        slope(tree);
    }
    contact(seed, tree);
    shapes(seed, tree);
    named(seed, tree);
    commanded(seed, tree);
    base(seed, tree);
    // Likewise.
    let mut gusts = Rng::with_seed(seed ^ 0xa1a1);
    for load in entries(tree, "loads") {
        if gusts.bool() {
            wind::exchange(load, &mut gusts);
        }
    }
    laws(&mut rng, tree);
    let mut ties = Rng::with_seed(seed ^ 0xc0c0);
    for coupling in entries(tree, "couplings").filter_map(Value::as_object_mut).filter(|_| ties.bool()) {
        for key in ["stiffness", "damping"] {
            coupling.remove(key);
        }
        coupling.insert("rigid".to_owned(), json!(true));
    }
    for cylinder in entries(tree, "cylinders") {
        if cylinder["valve"]["gain"].is_number() && rng.bool() {
            cylinder["valve"]["feed_forward"] = json!(0.9);
        }
    }
    if tree["pump"].is_object() && rng.bool() {
        tree["pump"]["volume"] = json!(0.004);
    }
    if tree["damping"]["swing_psi"].is_number() && rng.bool() {
        tree["armature"] = json!({"swing_psi": 0.5});
    }
    tree["loops"] = json!(rng.choice(["auto", "always", "never"]));
    tree["title"] = json!("A random crane");
    for info in ["inputs", "parameters"] {
        for entry in values(tree, info) {
            entry["about"] = json!("chosen at random");
        }
    }
}

/// Springs, friction and feet in other forms.
fn laws(rng: &mut Rng, tree: &mut Tree) {
    for connector in entries(tree, "connectors") {
        if let Some(mut spring) = connector["law"]["spring"].as_object().cloned().filter(|_| rng.bool()) {
            spring.insert("progression".to_owned(), json!(1e4));
            connector["law"] = json!({"progressive_spring": spring});
        }
    }
    for friction in values(tree, "friction") {
        if friction["bristle"].is_null() && rng.bool() {
            friction["width"] = json!(0.005);
        }
        if friction["breakaway"].is_number() && rng.bool() {
            friction["stribeck"] = json!(0.03);
        }
    }
    for foot in entries(tree, "supports").filter(|foot| foot["one_sided"] != true) {
        if foot["kinematics"].is_null() && rng.bool() {
            foot["kinematics"] = json!("linear");
        }
        if rng.u8(0..4) == 0 {
            foot["free_play"] = json!([0.001, 0, round(-0.01 * rng.f64())]);
        }
    }
}

/// The entries of a list, none if the crane has no such list.
fn entries<'t>(tree: &'t mut Tree, list: &str) -> impl Iterator<Item = &'t mut Value> {
    tree.get_mut(list).and_then(Value::as_array_mut).into_iter().flatten()
}

/// The values of a mapping, likewise.
fn values<'t>(tree: &'t mut Tree, mapping: &str) -> impl Iterator<Item = &'t mut Value> {
    tree.get_mut(mapping).and_then(Value::as_object_mut).into_iter().flat_map(serde_json::Map::values_mut)
}

/// A section of about the size of a box.
fn section(rng: &mut Rng, given: &Value) -> Value {
    let side = |key: &str| given["box"][key].as_f64();
    let (Some(height), Some(width), Some(wall)) = (side("height"), side("width"), side("thickness")) else {
        return given.clone();
    };
    match rng.u8(0..6) {
        0 => json!({"tube": {"diameter": height, "thickness": wall}}),
        1 => json!({"circle": {"diameter": round(0.5 * height)}}),
        2 => json!({"solid": {"height": round(0.5 * height), "width": round(0.5 * width)}}),
        3 => {
            json!({"welded_box": {"height": height, "width": width, "flange": round(1.2 * wall), "web": round(0.8 * wall)}})
        }
        4 => json!({"numbers": {"area": 2.6e-3, "Jy": 4e-6, "Jz": 9e-6, "Jo": 8e-6,
            "moduli": {"Wy": 7e-5, "Wz": 1.1e-4, "Wt": 1.4e-4, "Ay": 1.3e-3, "Az": 9e-4}}}),
        _ => given.clone(),
    }
}

/// The mass of a link in other words, or of two bodies.
fn mass(rng: &mut Rng, link: &mut Value) {
    let (given, com) = (link["mass"].clone(), link["com"].clone());
    let Some(whole) = given.as_f64() else { return };
    match rng.u8(0..3) {
        0 => {
            link["inertia"] =
                json!({"about": "com", "Ixx": 14, "Iyy": 16, "Izz": 20, "Ixy": 0.5, "Ixz": -1, "Iyz": 0.3});
        }
        1 => {
            // About the frame: those of a body at the origin, and the mass at its centre.
            let at: Vec<f64> = com.as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
            let [x, y, z] = at[..] else { return };
            let moment = |own: f64, a: f64, b: f64| round(own + whole * (a * a + b * b));
            link["inertia"] = json!({"about": "origin", "Ixx": moment(14.0, y, z), "Iyy": moment(16.0, x, z), "Izz": moment(20.0, x, y),
                "Ixy": round(-whole * x * y), "Ixz": round(-whole * x * z), "Iyz": round(-whole * y * z)});
        }
        _ => {
            for key in ["mass", "com", "inertia"] {
                link.as_object_mut().and_then(|link| link.remove(key));
            }
            let body = |name: &str, share: f64, x: f64| json!({"name": name, "mass": round(share * whole), "com": [x, 0.3, 0], "inertia": {"gyration": [0.3, 0.35, 0.4]}});
            link["bodies"] = json!([body("deck", 0.7, 0.3), body("rail", 0.3, 0.6)]);
        }
    }
}

/// The same gravity by a slope of the ground.
fn slope(tree: &mut Tree) {
    let gravity = gravity(tree);
    let [along, size] = [gravity[0].hypot(gravity[1]), gravity.iter().map(|g| g * g).sum::<f64>().sqrt()];
    tree["gravity"] = json!([0, 0, -size]);
    tree["slope"] = json!({"angle": along.atan2(-gravity[2]), "towards": gravity[1].atan2(gravity[0])});
}

/// Puts the hook of every fifth crane onto the ground, with random numbers of its own.
fn contact(seed: u64, tree: &mut Tree) {
    let mut rng = Rng::with_seed(seed ^ 0x6a6a);
    if rng.u8(0..5) != 0 {
        return;
    }
    // As soft as what floats: on most poses it carries some hundred newtons, and changes little else.
    let height = if rng.u8(0..4) == 0 { -5.0 } else { 4.0 };
    let at = [0.1, round(0.2 * rng.f64()), -0.1];
    tree["contacts"] =
        json!([{"name": "lies", "link": "hook", "at": at, "height": height, "stiffness": 200, "damping": 0.2}]);
}

/// Gives links of every other crane looks, which change no number.
fn shapes(seed: u64, tree: &mut Tree) {
    if seed.is_multiple_of(2) {
        return;
    }
    let mut rng = Rng::with_seed(seed ^ 0x54a9);
    for link in entries(tree, "links") {
        let (at, rotation) = (json!([round(rng.f64()), 0, 0.1]), json!([{"y": "20 deg"}, {"x": round(rng.f64())}]));
        let mut form = match rng.u8(0..8) {
            0 => json!({"box": {"size": [round(0.1 + rng.f64()), 0.2, 0.3]}}),
            1 => json!({"cylinder": {"diameter": 0.3, "length": 0.8, "axis": rng.choice(["x", "y", "z"])}}),
            2 => json!({"capsule": {"diameter": 0.3, "length": round(rng.f64())}}),
            3 => json!({"mesh": {"file": "part.stl", "scale": 0.001}}),
            _ => continue,
        };
        for shape in form.as_object_mut().into_iter().flat_map(serde_json::Map::values_mut) {
            (shape["at"], shape["rotation"]) = (at.clone(), rotation.clone());
        }
        link["shape"] = if rng.bool() { form } else { json!([form]) };
    }
}

/// Frames and joints with names of their own, a point in one of them, and a lamp at the end of the second arm.
fn named(seed: u64, tree: &mut Tree) {
    let mut rng = Rng::with_seed(seed ^ 0x3c3c);
    if rng.bool() {
        let turned = json!({"translation": [0.2, round(0.3 * rng.f64()), 0], "rotation": {"y": round(rng.f64())}});
        tree["frames"] = json!([{"name": "flange", "link": "hook", "transform": turned}, {"name": "yard"}]);
        push(tree, "points", json!({"name": "rim", "frame": "flange", "at": [0.1, round(0.2 * rng.f64()), 0]}));
        tree["joints"] = json!([{"name": "slewing", "coordinate": "column_psi"}, {"name": "weld", "at": 0.1}]);
    }
    let lamps = tree["links"].as_array_mut().and_then(|links| {
        let platform = links.iter().position(|link| link["name"] == "platform")?;
        Some((links, platform))
    });
    if let Some((links, platform)) = lamps {
        let at = rng.choice(["tip", "start"]);
        links.insert(
            platform + 1,
            json!({"name": "beacon", "on": {"link": "jib", "at": at}, "mass": 12, "com": [0.02, 0.1, 0]}),
        );
    }
}

/// An input that follows a motion, and a valve that is opened instead of a servo.
fn commanded(seed: u64, tree: &mut Tree) {
    let mut rng = Rng::with_seed(seed ^ 0x1d1d);
    let opened = rng.u8(0..3) == 0;
    let gust = tree.pointer_mut("/inputs/gust").filter(|_| rng.bool());
    if let Some(gust) = gust {
        *gust = json!({"motion": {"cubic": {"from": 0.7, "to": round(rng.f64()), "begin": 0.05, "duration": 0.3}}});
    }
    let holds = |tree: &Tree| {
        entry(tree, "drives", "coordinate", "stage_one_x").is_some_and(|drive| drive["motion"]["hold"].is_number())
    };
    if opened
        && holds(tree)
        && let Some(extend) = entry_mut(tree, "cylinders", "name", "extend")
        && let Some(valve) = extend.get_mut("valve").and_then(Value::as_object_mut)
    {
        valve.remove("gain");
        let opening = json!({"cubic": {"from": 0, "to": round(0.3 * rng.f64()), "begin": 0.05, "duration": 0.2}});
        valve.insert("opening".to_owned(), opening);
    }
}

/// A base that moves in some of the six ways.
fn base(seed: u64, tree: &mut Tree) {
    let mut rng = Rng::with_seed(seed ^ 0xba5e);
    let truck = entry_mut(tree, "links", "name", "truck").filter(|truck| truck["joint"] == "free" && rng.u8(0..4) == 0);
    if let Some(truck) = truck {
        let ways = ["x", "y", "z", "psi", "theta", "phi"];
        let kept: Vec<&str> =
            ways.into_iter().filter(|way| ["z", "theta", "phi"].contains(way) || rng.bool()).collect();
        truck["joint"] = json!({"free": kept});
    }
}

/// An emergency stop while most motions move.
fn halt(rng: &mut Rng) -> Value {
    json!({"at": round(0.2 + 0.5 * rng.f64()), "within": round(0.1 + 0.5 * rng.f64())})
}

/// A motion between the same positions, or a slow one without end.
fn motion(rng: &mut Rng, may_go_on: bool, quintic: Value) -> Value {
    match rng.u8(0..4) {
        3 if may_go_on => json!({"speed": {"rate": 0.05, "from": quintic["from"], "begin": 0.05, "ramp": 0.2}}),
        0 => json!({"cycloid": quintic}),
        1 => {
            let mut trapezoid = quintic;
            (trapezoid["begin"], trapezoid["blend"]) = (json!(0.05), json!(0.3));
            json!({"trapezoid": trapezoid})
        }
        _ => json!({"quintic": quintic}),
    }
}
