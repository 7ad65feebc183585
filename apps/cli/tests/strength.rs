//! `crane strength` against the equilibrium of moments and against known motions.

use std::{fs, path::PathBuf, process::Command};

use serde_json::Value;

/// What the command says of a spec, as JSON, with further arguments.
fn strength(name: &str, spec: &str, arguments: &[&str]) -> Value {
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.yaml"));
    fs::write(&file, format!("format: 1\nname: {name}\n{spec}")).expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
    let output =
        command.arg("strength").arg(&file).args(["--format", "json"]).args(arguments).output().expect("it starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn assert_close(what: &str, actual: &Value, expected: f64, tolerance: f64) {
    let actual = actual.as_f64().unwrap_or_else(|| panic!("{what} is a number: {actual}"));
    assert!((actual / expected - 1.0).abs() < tolerance, "{what}: {actual} instead of {expected}");
}

/// A truck of 4 t, centred between four feet 3 m and 2 m apart, and a load 3 m in front of its centre and 5 m to the left.
const TRUCK: &str = "
parameters: {payload: {value: 100, unit: kg}}
links:
  - {name: truck, joint: free, mass: 4000, com: [0, 0, 0.5], inertia: {Ixx: 3000, Iyy: 3000, Izz: 3000}}
  - {name: load, placement: {transform: {translation: [3, 5, 1]}}, mass: payload, com: [0, 0, 0]}
supports:
  - {name: front_left, at: [1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: front_right, at: [1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_left, at: [-1.5, 1, 0], stiffness: [1e10, 1e10, 1e10]}
  - {name: rear_right, at: [-1.5, -1, 0], stiffness: [1e10, 1e10, 1e10]}
";
/// The feet deflect by micrometres, which changes the lever arm of the load by about as much.
const COMPLIANCE: f64 = 1e-5;

#[test]
fn a_truck_on_four_feet_tips_where_moments_say() {
    let report = strength("truck", TRUCK, &[]);
    // About the line of the left feet: 4000 kg at 1 m balance 100 kg at 4 m.
    assert_eq!(report["governing_line"], "front_left – rear_left");
    assert_close("margin", &report["tipping_margin"], 0.9, COMPLIANCE);
    let line = report["tipping"].as_array().expect("a table").iter().find(|line| line["from"] == "front_left");
    let line = line.expect("the line");
    assert_close("stabilising", &line["stabilising"], 4000.0 * 9.81, COMPLIANCE);
    assert_close("overturning", &line["overturning"], 400.0 * 9.81, COMPLIANCE);
    // (4000 + m)/4 − 5 m/4 − 3 · 1.5 m/9 = 0 at the opposite foot, on springs of equal stiffness.
    assert_eq!(report["critical_loads"]["first_foot"]["at"], "rear_right");
    assert_close("lift", &report["critical_loads"]["first_foot"]["load"], 1000.0 / 1.5, COMPLIANCE);
    // 4000 kg · 1 m = m · 4 m
    assert_eq!(report["critical_loads"]["tipping"]["at"], "front_left – rear_left");
    assert_close("tips", &report["critical_loads"]["tipping"]["load"], 1000.0, COMPLIANCE);
    // What the ground carries.
    let ground = &report["loads"][0];
    assert_eq!(ground["joint"], "ground");
    assert_close("weight", &ground["Fz"], -4100.0 * 9.81, 1e-12);
    assert_close("moment", &ground["Mx"], -500.0 * 9.81, COMPLIANCE);
}

/// Above the tipping load, the crane is reported to tip, and the critical loads are found below the given one.
#[test]
fn a_crane_that_tips_gets_a_caution() {
    let report = strength("overloaded", TRUCK, &["--set", "payload=1500"]);
    assert_close("margin", &report["tipping_margin"], 1.0 - 1500.0 * 4.0 / 4000.0, 10.0 * COMPLIANCE);
    let cautions = report["cautions"].to_string();
    assert!(cautions.contains("tips over the line front_left – rear_left"), "{cautions}");
    assert_close("tips", &report["critical_loads"]["tipping"]["load"], 1000.0, COMPLIANCE);
}

/// A quintic of 1 m in 2 s accelerates at most by `10/√3 · 1 m/(2 s)²`, after `(3 − √3)/6` of its time.
#[test]
fn a_hoist_carries_its_greatest_load_as_it_speeds_up() {
    let hoist = "
links: [{name: cage, joint: {prismatic: {axis: z}}, mass: 200, com: [0.3, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}]
drives: [{coordinate: cage_z, rigid: true, motion: {quintic: {from: 0, to: 1, duration: 2}}}]
run: {duration: 2, output: 0.001}
";
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("hoist.csv");
    let report = strength("hoist", hoist, &["--run", "-o", file.to_str().expect("a path")]);
    let peak = 10.0 / 3.0f64.sqrt() / 4.0;
    let extremes = report["extremes_of_loads"].as_array().expect("a table");
    let of = |component: &str| {
        let found = extremes.iter().find(|row| row["joint"] == "cage" && row["component"] == component);
        found.expect("a component of the joint").clone()
    };
    // Results 1 ms apart miss the peak of a parabola by 1e-6 of it.
    assert_close("Fz", &of("Fz")["minimum"], -200.0 * (9.81 + peak), 1e-6);
    assert_close("Fz", &of("Fz")["maximum"], -200.0 * (9.81 - peak), 1e-6);
    assert_close("My", &of("My")["maximum"], 0.3 * 200.0 * (9.81 + peak), 1e-6);
    assert_close("time", &of("Fz")["time_of_minimum"], 2.0 * (3.0 - 3.0f64.sqrt()) / 6.0, 2e-3);
    let table = fs::read_to_string(file).expect("the file");
    assert!(table.starts_with("t [s],ground_Fx [N]"), "{}", &table[..60]);
    assert_eq!(table.lines().count(), 2002);
}

/// A box 0.25 m high and 0.2 m wide, 8 mm thick, 2 m long, with 100 kg at 0.5 m beside its tip: bent, sheared and twisted at once.
const CANTILEVER: &str = "
materials: {steel: {E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: 355e6}}
links:
  - name: boom
    placement: {transform: {rotation: {x: 90 deg}}}
    beam: {length: 2, sections: 4, material: steel, safety_factor: 1.25, section: {box: {height: 0.25, width: 0.2, thickness: 0.008}}}
  - {name: load, mass: 100, com: [0, 0, 0.5]}
";

#[test]
fn a_cantilever_is_stressed_by_bending_shear_and_torsion() {
    let report = strength("cantilever", CANTILEVER, &[]);
    let (height, width, wall): (f64, f64, f64) = (0.25, 0.2, 0.008);
    let (inner_height, inner_width) = (height - 2.0 * wall, width - 2.0 * wall);
    let area = height * width - inner_height * inner_width;
    let second = (width * height.powi(3) - inner_width * inner_height.powi(3)) / 12.0;
    let first = (width * height.powi(2) - inner_width * inner_height.powi(2)) / 8.0;
    let weight = 9.81 * 7850.0 * area * 2.0;
    let normal = (981.0 * 2.0 + weight) * (height / 2.0) / second;
    let shear = (981.0 + weight) * first / (second * 2.0 * wall);
    let torsion = 981.0 * 0.5 / (2.0 * wall * (width - wall) * (height - wall));
    let equivalent = (normal.powi(2) + 3.0 * (shear + torsion).powi(2)).sqrt();
    let root = &report["stresses"][0];
    // The tip sinks by 0.3 mm, which tilts the load by 2e-4 rad, so that a part of it becomes a normal force.
    for (what, stress) in [("normal", normal), ("shear", shear), ("torsion", torsion), ("equivalent", equivalent)] {
        assert_close(what, &root[what], stress, 1e-4);
    }
    assert_close("utilisation", &report["greatest_utilisation"], 1.25 * equivalent / 355e6, 1e-4);
    assert_eq!(report["place_of_the_greatest_stress"], "boom, 0.000 m from its start");
    // The maximum is at the clamped end, whatever the sections; the deflection of 0.3 mm is known to a few percent.
    let change = &report["change_of_the_greatest_stress_with_twice_the_sections"];
    assert!(change.as_f64().expect("a number").abs() < 1e-5, "{change}");
    let end = report["sections"].as_array().and_then(|rows| rows.iter().rfind(|row| row["beam"] == "boom"));
    let end = end.expect("the last section");
    assert_eq!((&end["x"], &end["place"]), (&serde_json::json!(2.0), &serde_json::json!("at the end")));
    assert_close("load at the end", &end["Qy"], -981.0, 1e-4);
    assert!(report["tipping_margin"].is_null(), "the crane has no supports");
}

/// With twice the sections the crane has the same parameters: the maximum is still at the clamped end.
#[test]
fn finer_sections_are_those_of_the_same_parameters() {
    let spec = format!(
        "parameters: {{payload: {{value: 100, unit: kg}}}}{}",
        CANTILEVER.replace("mass: 100", "mass: payload")
    );
    let report = strength("set", &spec, &["--set", "payload=300"]);
    // As for the crane of 100 kg, with three times its deflection; with 100 kg the stress would be half as large.
    let change = &report["change_of_the_greatest_stress_with_twice_the_sections"];
    assert!(change.as_f64().expect("a number").abs() < 3e-5, "{change}");
}

/// The maximum is that of the utilisation where a beam has a yield stress, even though a beam without one is stressed more: `M = m g L + w L²/2`
/// at the beginning of the outer one.
#[test]
fn a_beam_without_a_yield_stress_is_not_used() {
    let section = "section: {box: {height: 0.25, width: 0.2, thickness: 0.008}}";
    let spec = format!(
        "
materials:
  iron: {{E: 2.1e11, G: 8.1e10, density: 7850}}
  steel: {{E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: 355e6}}
links:
  - {{name: inner, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, beam: {{length: 2, sections: 2, material: iron, {section}}}}}
  - {{name: outer, beam: {{length: 1, sections: 2, material: steel, safety_factor: 1.25, {section}}}}}
  - {{name: load, mass: 100, com: [0, 0, 0]}}
"
    );
    let report = strength("two_materials", &spec, &[]);
    let (height, width, wall): (f64, f64, f64) = (0.25, 0.2, 0.008);
    let (inner_height, inner_width) = (height - 2.0 * wall, width - 2.0 * wall);
    let second = (width * height.powi(3) - inner_width * inner_height.powi(3)) / 12.0;
    let first = (width * height.powi(2) - inner_width * inner_height.powi(2)) / 8.0;
    let weight = 9.81 * 7850.0 * (height * width - inner_height * inner_width);
    let normal = (981.0 + weight / 2.0) * (height / 2.0) / second;
    let equivalent = normal.hypot(3.0f64.sqrt() * (981.0 + weight) * first / (second * 2.0 * wall));
    // The inner beam tilts the outer one by 4e-4 rad.
    assert_close("utilisation", &report["greatest_utilisation"], 1.25 * equivalent / 355e6, 1e-4);
    assert_eq!(report["place_of_the_greatest_utilisation"], "outer, 0.000 m from its start");
    // The greatest stress is another one, of the inner beam where it is clamped.
    let normal = (981.0 * 3.0 + weight * 4.5) * (height / 2.0) / second;
    let of_root = normal.hypot(3.0f64.sqrt() * (981.0 + 3.0 * weight) * first / (second * 2.0 * wall));
    assert_close("stress", &report["greatest_equivalent_stress"], of_root, 1e-4);
    assert_eq!(report["place_of_the_greatest_stress"], "inner, 0.000 m from its start");
    let of_inner = report["stresses"][0]["equivalent"].as_f64().expect("a number");
    assert!(report["stresses"][0]["beam"] == "inner" && of_inner > 2.0 * equivalent, "{of_inner}");
}

/// Two stages on pads, two sections each. At every pad the normal stress is the moment of what is beyond it over the modulus: own weights and
/// load, whatever the pads within exert. Between pads and springs, elements used to share the forces of pads, and stresses were up to 16 % less.
#[test]
fn stages_are_stressed_at_their_pads() {
    let pads = "pads: {front: {stiffness: [4e9, 4e9, 8e7]}, rear: {stiffness: [4e9, 4e9, 8e7]}}";
    let beam = "length: 4, sections: 2, material: steel, section: {box: {height: 0.3, width: 0.3, thickness: 0.01}}";
    let spec = format!(
        "
materials: {{steel: {{E: 2.1e11, G: 8.1e10, density: 7850}}}}
links:
  - {{name: outer, beam: {{{beam}}}}}
  - {{name: one, joint: {{prismatic: {{axis: x}}}}, beam: {{{beam}, slides_in: {{beam: outer, overlap: 3.5, {pads}}}}}}}
  - {{name: two, joint: {{prismatic: {{axis: x}}}}, beam: {{{beam}, slides_in: {{beam: one, overlap: 3.5, {pads}}}}}}}
  - {{name: load, mass: 1000, com: [0, 0, 0]}}
drives:
  - {{coordinate: one_x, stiffness: 1e9, motion: {{hold: 2}}}}
  - {{coordinate: two_x, stiffness: 1e9, motion: {{hold: 2}}}}
run: {{duration: 0.02, output: 0.01}}
"
    );
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("stages.csv");
    let report = strength("stages", &spec, &["--run", "--file", file.to_str().expect("a name")]);
    let (side, inner): (f64, f64) = (0.3, 0.28);
    let (weight, load) = (9.81 * 7850.0 * (side * side - inner * inner), 9.81 * 1000.0);
    let modulus = (side.powi(4) - inner.powi(4)) / (6.0 * side);
    // Stage two is 1.5 m in stage one, which is 1.5 m in the outer beam; 2.5 m of each are outside.
    let front_of_two = weight * 2.5 * 1.25 + load * 2.5;
    let front_of_one = weight * 2.5 * 1.25 + weight * 4.0 * 3.0 + load * 5.0;
    // The front pad of stage two, from moments about its rear pad, has a lever of 1.5 m to that on stage one.
    let rear_of_two = weight * 1.5 * 0.75 + weight * 4.0 * 2.0 + load * 4.0;
    let rows = report["stresses"].as_array().expect("a table");
    for (beam, pads, x, moment) in [
        ("two", "two_front", 1.5, front_of_two),
        ("one", "one_front", 1.5, front_of_one),
        ("one", "two_rear", 2.5, rear_of_two),
    ] {
        for side in ["before", "after"] {
            let place = format!("{side} the pads {pads}");
            let here = |row: &&serde_json::Value| row["beam"] == beam && row["place"] == place.as_str();
            let row = rows.iter().find(here).unwrap_or_else(|| panic!("{beam}, {place}"));
            // Drives give way by 1e-5 m.
            assert_close("place", &row["x"], x, 1e-4);
            // The stages sag by 1 %: levers are shorter by half of its square, and weight has a part along them.
            assert_close(&place, &row["normal"], moment / modulus, 1e-3);
        }
    }
    // The file has the same stresses as the table, at its first time.
    let text = fs::read_to_string(file).expect("results");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let first: Vec<f64> =
        lines.next().expect("a row").split(',').map(|number| number.parse().expect("a number")).collect();
    let of_file =
        names.iter().zip(&first).filter(|(name, _)| name.contains("_normal_stress")).map(|(_, stress)| *stress);
    let (mut of_file, mut of_table): (Vec<f64>, Vec<f64>) =
        (of_file.collect(), rows.iter().map(|row| row["normal"].as_f64().expect("a number")).collect());
    of_file.sort_by(f64::total_cmp);
    of_table.sort_by(f64::total_cmp);
    assert_eq!(of_file.len(), of_table.len());
    for (one, other) in of_file.iter().zip(&of_table) {
        // The run begins at the pose at rest; stresses of 1 Pa are rounding beside 1e7 Pa.
        assert!((one - other).abs() < 1e-6 * of_table[of_table.len() - 1], "{one} in the file, {other} in the table");
    }
}

/// Along a run at rest, the bending moment has its minimum at the clamped end, `−(m g L + w L²/2)`, and its maximum, 0, at the free end.
#[test]
fn extremes_of_sections_have_their_own_places() {
    let report = strength("standing", &format!("{CANTILEVER}run: {{duration: 0.1, output: 0.05}}\n"), &["--run"]);
    let rows = report["extremes_of_sections"].as_array().expect("a table");
    let bending = rows.iter().find(|row| row["component"] == "Mz").expect("a component");
    let weight = 9.81 * 7850.0 * (0.25 * 0.2 - 0.234 * 0.184) * 2.0;
    // The tip sinks by 0.3 mm, which tilts the load, 0.5 m beside the beam.
    assert_close("minimum", &bending["minimum"], -(981.0 * 2.0 + weight), 1e-4);
    assert!(bending["maximum"].as_f64().expect("a number").abs() < 1.0, "{bending}");
    assert_eq!(
        (&bending["x_of_minimum"], &bending["x_of_maximum"]),
        (&serde_json::json!(0.0), &serde_json::json!(2.0))
    );
}

/// A beam on a hinge and a strut that bends under its own weight most where no spring is: with two sections the maximum between the springs is
/// missed, and the command says so.
#[test]
fn sections_too_few_for_the_maximum_are_noticed() {
    let beam = "
gravity: [0, -9.81, 0]
materials: {steel: {E: 2.1e11, G: 8.1e10, density: 7850}}
links:
  - name: beam
    joint: revolute
    beam: {length: 4, sections: 2, material: steel, section: {box: {height: 0.5, width: 0.4, thickness: 0.02}}}
connectors:
  - {name: strut, from: {at: [4, -10, 0]}, to: {link: beam, at: [4, 0, 0]}, law: {spring: {stiffness: 1e12, length: 10}}}
";
    let report = strength("sagging", beam, &[]);
    // Springs at 1 m and 3 m; with four sections at 0.5, 1.5, 2.5 and 3.5 m. Stresses are in units of the weight per length.
    let second = (0.4 * 0.5f64.powi(3) - 0.36 * 0.46f64.powi(3)) / 12.0;
    let first = (0.4 * 0.5f64.powi(2) - 0.36 * 0.46f64.powi(2)) / 8.0;
    let equivalent = |x: f64| {
        let (moment, force) = (x * (4.0 - x) / 2.0, 2.0 - x);
        (moment * 0.25 / second).hypot(3.0f64.sqrt() * force * first / (second * 0.04))
    };
    let change = equivalent(1.5) / equivalent(1.0) - 1.0;
    assert_close("change", &report["change_of_the_greatest_stress_with_twice_the_sections"], change, 1e-3);
    let cautions = report["cautions"].to_string();
    assert!(cautions.contains("when the number of sections doubles"), "{cautions}");
}

/// A clamped beam on a prop. With n sections, whose springs are at (i + 1/2) L / n, the prop carries
/// `R = 3/8 w L (1 − 1/(2 n²)) / (1 − 1/(4 n²))`: midpoint rules for `∫s³` and `∫s²`. What the beam carries at any place follows, also between the springs of
/// the finer beam. The strut yields by 1e-5 of what the beam does; the change is that of a difference, hence 1e-3.
#[test]
fn each_place_has_its_change_with_twice_the_sections() {
    let beam = |sections: &str| {
        format!(
            "
gravity: [0, -9.81, 0]
materials: {{steel: {{E: 2.1e11, G: 8.1e10, density: 7850, yield_stress: 355e6}}}}
links:
  - name: beam
    joint: {{revolute: {{axis: x}}}}
    beam: {{length: 4, sections: {sections}, material: steel, section: {{box: {{height: 0.5, width: 0.4, thickness: 0.02}}}}}}
drives: [{{coordinate: beam_phi, stiffness: 1e9, motion: {{hold: 0}}}}]
connectors:
  - {{name: strut, from: {{at: [4, -10, 0]}}, to: {{link: beam, at: [4, 0, 0]}}, law: {{spring: {{stiffness: 1e12, length: 10}}}}}}
"
        )
    };
    let report = strength("propped", &beam("2"), &[]);
    let second = (0.4 * 0.5f64.powi(3) - 0.36 * 0.46f64.powi(3)) / 12.0;
    let first = (0.4 * 0.5f64.powi(2) - 0.36 * 0.46f64.powi(2)) / 8.0;
    let equivalent = |n: f64, x: f64| {
        let (prop, s) = (1.5 * (1.0 - 0.5 / (n * n)) / (1.0 - 0.25 / (n * n)), 4.0 - x);
        let (moment, force) = (s * s / 2.0 - prop * s, prop - s);
        (moment * 0.25 / second).hypot(3.0f64.sqrt() * force * first / (second * 0.04))
    };
    let rows = report["stresses"].as_array().expect("a table");
    assert_eq!(rows[0]["x"], 0.0);
    assert_close("change", &rows[0]["change"], equivalent(4.0, 0.0) / equivalent(2.0, 0.0) - 1.0, 1e-3);
    // In the middle of a section, the other mesh has no place.
    for (row, x) in rows[1..].iter().zip([1.0, 3.0]) {
        assert!(row["x"] == x && row["change"].is_null(), "{row}");
    }
    assert!(rows.last().expect("the tip")["change"].is_null(), "nothing is carried beyond the strut");
    // The maximum is at the clamped end with both.
    for key in ["stress", "utilisation"] {
        let change = &report[format!("change_of_the_greatest_{key}_with_twice_the_sections")];
        assert_close(key, change, equivalent(4.0, 0.0) / equivalent(2.0, 0.0) - 1.0, 1e-3);
    }
    let rigid = strength("propped_rigid", &beam("rigid"), &[]);
    assert!(rigid["change_of_the_greatest_stress_with_twice_the_sections"].is_null(), "nothing to divide");
    assert!(rigid["stresses"][0].get("change").is_none());
}

/// A load that hangs on a rope alone: the joints that hold it to the tip carry what rounding leaves, which has no change.
#[test]
fn what_is_rounding_has_no_change_with_twice_the_sections() {
    let spec = "
links:
  - {name: beam, beam: {length: 2, sections: 2, material: {E: 2.1e11, G: 8.1e10, density: 7850}, section: {box: {height: 0.1, width: 0.1, thickness: 0.005}}}}
  - {name: along, joint: {prismatic: {axis: x}}}
  - {name: load, joint: {prismatic: {axis: z}}, mass: 100, com: [0, 0, 0]}
connectors:
  - {name: hoist, from: {at: [-0.5, 0, 1]}, over: [{link: beam, at: [2, 0, 0.1]}], to: {link: load, at: [0, 0, 0]}, law: {rope: {axial_stiffness: 12 MN, length: 4.2}}}
guess: {load_z: -1.5}
";
    let report = strength("rounding", spec, &[]);
    let rows = report["stresses"].as_array().expect("a table");
    let [first, .., last] = &rows[..] else { panic!("{report}") };
    assert_eq!(last["place"], "after the end and sheave of hoist");
    assert!(last["equivalent"].as_f64().is_some_and(|stress| stress > 0.0 && stress < 1.0), "{last}");
    assert!(last["change"].is_null() && first["change"].is_number(), "{first} {last}");
}

/// About three tonnes more than the boom can carry.
#[test]
fn a_boom_that_yields_gets_a_caution() {
    let report = strength("overstressed", &CANTILEVER.replace("mass: 100", "mass: 10000"), &[]);
    assert!(report["greatest_utilisation"].as_f64().expect("a number") > 1.0);
    let cautions = report["cautions"].to_string();
    assert!(cautions.contains("times the allowable stress"), "{cautions}");
}

#[test]
fn an_unknown_load_is_refused() {
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("other.yaml");
    fs::write(&file, format!("format: 1\nname: other\n{TRUCK}")).expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
    let output = command.arg("strength").arg(&file).args(["--load", "pay_load"]).output().expect("it starts");
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(message.contains("there is no live parameter `pay_load`") && message.contains("`payload`"), "{message}");
}

/// A sideways pull on the truck, 2 m above the ground, reduces the stabilising moment by its own moment.
#[test]
fn an_applied_load_tips() {
    let pull = "loads: [{name: pull, link: truck, at: [0, 0, 2], force: [0, 5000, 0]}]\n";
    let report = strength("pulled_truck", &format!("{TRUCK}{pull}"), &[]);
    let line = report["tipping"].as_array().expect("a table").iter().find(|line| line["from"] == "front_left");
    let line = line.expect("the line");
    assert_close("stabilising", &line["stabilising"], 4000.0 * 9.81 - 2.0 * 5000.0, COMPLIANCE);
    assert_close("overturning", &line["overturning"], 400.0 * 9.81, COMPLIANCE);
    // (4000 − 10000/9.81) kg · 1 m = m · 4 m
    let tips = (4000.0 - 10000.0 / 9.81) / 4.0;
    assert_close("tips", &report["critical_loads"]["tipping"]["load"], tips, COMPLIANCE);
    let ground = &report["loads"][0];
    assert_close("pull", &ground["Fy"], 5000.0, 1e-12);
    assert_close("weight", &ground["Fz"], -4100.0 * 9.81, 1e-12);
    assert_close("moment", &ground["Mx"], -500.0 * 9.81 - 2.0 * 5000.0, COMPLIANCE);
}

/// A crane whose feet lift, with a load on a joint of its own, whose mass may not be zero.
#[test]
fn critical_loads_are_found_or_their_absence_is_explained() {
    let manual = include_str!("../../../docs/manual/feet.md");
    let spec = manual.split("```yaml").nth(1).and_then(|rest| rest.split("```").next()).expect("a spec");
    let spec = spec.trim_start().trim_start_matches("format: 1\nname: lifting_truck\n");
    let loads: Vec<Value> = ["1000", "2800"]
        .map(|load| strength("lifting", spec, &["--set", &format!("load={load}")])["critical_loads"].clone())
        .into();
    assert_eq!(loads[0], loads[1]);
    let [first, tipping] = ["first_foot", "tipping"].map(|key| loads[0][key]["load"].as_f64().expect("a load"));
    // About the line of the feet that are nearest, 2 m in front of the middle; the boom is at 25°. Its drive gives way by
    // some 0.02 rad, which moves the load outwards by 2 % of its distance from that line.
    let out = 25.0f64.to_radians().cos();
    let moments = (8000.0 * 2.0 + 400.0 * 2.0 + 500.0 * (2.0 - 3.2 * out)) / (6.5 * out - 2.0);
    assert!(
        (tipping / moments - 1.0).abs() < 0.03 && (first / tipping - 1.0).abs() < 1e-5,
        "{first}, {tipping}, {moments}"
    );
    assert!(loads[0]["reasons"].as_object().expect("reasons").is_empty());

    let hanging = "parameters: {payload: {value: 100, unit: kg}}\nlinks: [{name: load, joint: {revolute: {axis: y}}, mass: payload, com: [0, 0, -1]}]\n";
    let report = strength("hanging", hanging, &[]);
    assert!(report["critical_loads"]["tipping"].is_null());
    assert_eq!(report["critical_loads"]["reasons"]["tipping"], "the crane has no supports");
}

/// 4000 kg at 1 m, 1.2 times, balance 100 kg at 4 m, 1.5 times; the truck of the spec has a margin of 0.9.
#[test]
fn combinations_have_their_own_margins_and_name_the_worst() {
    let combinations =
        "combinations:\n  - {name: working, weight: 1.2, masses: {payload: 1.5}}\n  - {name: as_written}\n";
    let report = strength("combined", &format!("{TRUCK}{combinations}"), &["--combinations"]);
    let rows = report["combinations"].as_array().expect("a table");
    assert_close("working", &rows[0]["tipping_margin"], 1.0 - 600.0 / 4800.0, COMPLIANCE);
    assert_close("as written", &rows[1]["tipping_margin"], 0.9, COMPLIANCE);
    let worst = report["worst_cases"].as_array().expect("a table");
    let ground = worst
        .iter()
        .find(|row| row["part"] == "ground" && row["quantity"] == "force of the joint")
        .expect("the ground");
    assert_eq!(
        (&ground["with_the_combination"], &ground["with_combination"]),
        (&"working".into(), &"as_written".into())
    );
    assert_close("weight", &ground["greatest"], (4000.0 * 1.2 + 150.0) * 9.81, COMPLIANCE);
}

/// The cautions of each combination carry its name, and a file that would not be written is refused.
#[test]
fn combinations_have_their_own_cautions() {
    let combinations = "combinations: [{name: heavy, masses: {payload: 7}}, {name: light, masses: {payload: 0.5}}]\n";
    let feet = TRUCK.replace("stiffness: [", "one_sided: true, stiffness: [");
    let report = strength("own_cautions", &format!("{feet}{combinations}"), &["--combinations"]);
    let cautions: Vec<&str> = report["cautions"].as_array().expect("a list").iter().filter_map(Value::as_str).collect();
    assert!(cautions.iter().any(|one| one.starts_with("heavy: ")), "{cautions:?}");
    assert!(!cautions.iter().any(|one| one.starts_with("light: ")), "{cautions:?}");
    for command in ["strength", "statics"] {
        let mut crane = Command::new(env!("CARGO_BIN_EXE_crane"));
        let output =
            crane.args([command, "knuckle_boom", "--combinations", "-o", "x.csv"]).output().expect("it starts");
        assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

/// A load that tips is that of the load's parameter, without its factor: 1.5 · 800 kg at 4 m balance 1.2 · 4000 kg at 1 m.
#[test]
fn a_load_that_tips_is_without_the_factors_of_its_combination() {
    let combinations = "combinations: [{name: working, weight: 1.2, masses: {payload: 1.5}}]\n";
    let truck = format!("{TRUCK}{combinations}");
    let by_option = strength("one_of_them", &truck, &["--combination", "working"]);
    let by_key = strength("by_key", &format!("{truck}combination: working\n"), &[]);
    for report in [by_option, by_key] {
        assert_close("margin", &report["tipping_margin"], 1.0 - 600.0 / 4800.0, COMPLIANCE);
        assert_close("tips", &report["critical_loads"]["tipping"]["load"], 800.0, COMPLIANCE);
    }
}

/// A cantilever that is bent slowly and let go again: one cycle of `F L/W`, and the life of a detail by hand.
#[test]
fn a_cantilever_that_is_bent_and_let_go_lives_as_long_as_its_detail() {
    let spec = "gravity: [0, 0, 0]
links:
  - name: beam
    beam: {length: 2, sections: 2, material: {E: 2.1e11, G: 8.1e10, density: 7850}, section: {box: {height: 0.1, width: 0.1, thickness: 0.005}}, damping: {beta: 1e-3}}
loads: [{name: pull, link: beam, at: [2, 0, 0], force: [0, 0, -3000], scale: {table: {times: [0, 4, 8], values: [0, 1, 0]}}}]
run: {duration: 8, output: 0.02}
";
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("bent_and_let_go.yaml");
    fs::write(&file, format!("format: 1\nname: bent\n{spec}")).expect("a file");
    let run = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_crane")).arg("fatigue").arg(&file).args(arguments).output().expect("it starts")
    };
    let output = run(&["--cycles", "1e5", "--category", "71MPa", "--category", "beam=80 MPa", "--format", "json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let modulus = (0.1_f64.powi(4) - 0.09_f64.powi(4)) / 12.0 / 0.05;
    let range = 3000.0 * 2.0 / modulus;
    // The load changes as slowly as the beam follows.
    assert_close("range", &report["greatest_range"], range, 1e-3);
    assert_close("life", &report["life"], 2e6 * (80e6 / range).powi(3), 3e-3);
    assert_close("s", &report["history_parameter"], 1e5 / 2e6, 1e-3);
    assert_eq!(report["class"], "S3");
    assert!(
        report["place_of_the_greatest_damage"].as_str().is_some_and(|place| place.starts_with("beam, 0.000 m")),
        "{report}"
    );
    for (arguments, wanted) in [
        (["--cycles", "1e5", "--category", "71"], "write 71MPa"),
        (["--cycles", "1e5", "--category", "boom=71MPa"], "beams are beam"),
        (["--cycles", "1e5", "--category", "71 kN"], "is a force"),
        (["--cycles", "0", "--category", "71MPa"], "above 0"),
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(text.contains(wanted), "{arguments:?}: {text}");
    }
}

/// Damages of several manoeuvres add up: half of the range, four times as often, does half of the damage.
#[test]
fn damages_of_several_manoeuvres_add_up() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("several_manoeuvres");
    fs::create_dir_all(&folder).expect("a folder");
    let file = |name: &str| folder.join(name).to_str().expect("a path").to_owned();
    let beam = "format: 1
name: beam
gravity: [0, 0, 0]
links:
  - name: beam
    beam: {length: 2, sections: 2, material: {E: 2.1e11, G: 8.1e10, density: 7850}, section: {box: {height: 0.1, width: 0.1, thickness: 0.005}}, damping: {beta: 1e-3}}
loads: [{name: pull, link: beam, at: [2, 0, 0], force: [0, 0, -3000], scale: {table: {times: [0, 4, 8], values: [0, 1, 0]}}}]
run: {duration: 8, output: 0.02}
";
    fs::write(file("beam.yaml"), beam).expect("a file");
    let other = |name: &str, rest: &str| {
        fs::write(file(name), format!("extends: beam.yaml\n{rest}\n")).expect("a file");
        format!("{}=4e5", file(name))
    };
    let half = other("half.yaml", "loads: [{name: pull, force: [0, 0, -1500]}]");
    let high = other("high.yaml", "loads: [{name: pull, scale: {table: {times: [0, 4, 8], values: [1, 1.2, 1]}}}]");
    let longer = other("longer.yaml", "links: [{name: beam, beam: {sections: 3}}]");
    let run = |also: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        command.args(["fatigue", &file("beam.yaml"), "--cycles", "1e5", "--category", "80MPa", "--format", "json"]);
        command.args(also.iter().flat_map(|also| ["--also", also]));
        command.output().expect("it starts")
    };
    let report = |also: &[&str]| {
        let output = run(also);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<Value>(&output.stdout).expect("JSON")
    };
    let found = report(&[&half]);
    let modulus = (0.1_f64.powi(4) - 0.09_f64.powi(4)) / 12.0 / 0.05;
    let endured = 2e6 * (80e6 / (3000.0 * 2.0 / modulus)).powi(3);
    // The load changes as slowly as the beam follows.
    assert_close("damage", &found["greatest_damage"], 1.5 * 1e5 / endured, 3e-3);
    assert_close("life", &found["life"], endured / 1.5, 3e-3);
    assert_close("s", &found["history_parameter"], (1e5 + 4e5 / 8.0) / 2e6, 1e-3);
    assert_close("part", &found["manoeuvres"][1]["part_of_the_damage"], 1.0 / 3.0, 1e-3);
    assert_close("first", &found["cycles"][0]["part_of_the_damage"], 2.0 / 3.0, 1e-3);
    assert_eq!(found["cautions"], serde_json::json!([]));
    // From nothing to 1.2 of the force, of which the second one has the last sixth alone.
    let cautions = report(&[&high])["cautions"].to_string();
    assert!(cautions.contains("from one manoeuvre to another"), "{cautions}");
    for (also, wanted) in [
        (longer.as_str(), "other places along its beams"),
        ("half.yaml", "write `--also half.yaml=1000`"),
        (&half.replace("4e5", "0"), "is not above 0"),
        (&half.replace("half", "beam"), "is given twice"),
    ] {
        let output = run(&[also]);
        assert_eq!(output.status.code(), Some(2), "{also}");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(text.contains(wanted), "{also}: {text}");
    }
}

/// A stage of 3.8 m whose rear pad is at its start, and its front pad where the other beam ends, a load of 10 kN at its tip. The steel is worst off where
/// the front pad ends: there the moment is that of the overhang, and when the pad is elsewhere less, in proportion to the way from the rear pad.
#[test]
fn steel_that_a_pad_sweeps_is_counted_where_it_is() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("swept");
    fs::create_dir_all(&folder).expect("a folder");
    let beam = |length: f64, box_of: &str, more: &str| {
        format!(
            "beam: {{length: {length}, sections: 4, material: {{E: 210 GPa, G: 81 GPa, density: 7850}}, section: {{box: {box_of}}}, damping: {{beta: 5 ms}}{more}}}"
        )
    };
    let pads = ", slides_in: {beam: boom, overlap: 3.5, pads: {front: {stiffness: [200 kN/mm, 200 kN/mm, 4e6], damping: [200 kN s/m, 200 kN s/m, 4e3]}, \
                rear: {stiffness: [200 kN/mm, 200 kN/mm, 0], damping: [200 kN s/m, 200 kN s/m, 0]}}}";
    let spec = |name: &str, motion: &str, scale: &str| {
        let path = folder.join(name);
        let text = format!(
            "format: 1\nname: swept\ngravity: [0, 0, 0]\nlinks:\n- {{name: boom, {}}}\n- {{name: stage, joint: {{prismatic: {{axis: x}}}}, {}}}\n\
             loads: [{{name: tip, link: stage, at: [3.8, 0, 0], force: [0, -10000, 0]{scale}}}]\n\
             drives: [{{coordinate: stage_x, stiffness: 2e7, damping: 2e5, motion: {motion}}}]\nrun: {{duration: 20, output: 0.1}}\n",
            beam(4.0, "{height: 300 mm, width: 220 mm, thickness: 8 mm}", ""),
            beam(3.8, "{height: 260 mm, width: 180 mm, thickness: 7 mm}", pads),
        );
        fs::write(&path, text).expect("a file");
        path.to_str().expect("a path").to_owned()
    };
    let run = |arguments: &[&str]| -> Value {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        command.arg("fatigue").args(arguments).args(["--cycles", "1e5", "--category", "71MPa", "--format", "json"]);
        let output = command.output().expect("it starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let modulus = (0.18 * 0.26_f64.powi(3) - 0.166 * 0.246_f64.powi(3)) / 12.0 / 0.13;
    // Of a tip load with the front pad at `pad` m, where it is or between both pads.
    let stress = |pad: f64, x: f64| 1e4 * (3.8 - pad) * x / pad / modulus;
    let damage = |range: f64| 1e5 / 2e6 * (range / 71e6).powi(3);
    // The drive yields by a micrometre, and the motion has ended as slowly as the beam follows: 2e-4 of the range.
    let out = folder.join("out.csv");
    let found = run(&[
        &spec("moved.yaml", "{cubic: {from: 0.4, to: 2.4, duration: 20}}", ""),
        "-o",
        out.to_str().expect("a path"),
    ]);
    let range = stress(1.1, 1.1) - stress(3.1, 1.1);
    assert_close("range", &found["greatest_range"], range, 2e-4);
    assert_close("damage", &found["greatest_damage"], damage(range), 6e-4);
    assert_eq!(found["place_of_the_greatest_damage"], "stage, 1.100 m from its start, swept by the pads stage_front");
    let places = found["fatigue"].as_array().expect("a table");
    let of =
        |what: &str| places.iter().filter(|row| row["beam"] == "stage" && row["place"] == what).collect::<Vec<_>>();
    assert!(of("before the pads stage_front").is_empty() && of("after the pads stage_front").is_empty());
    // Sections are 0.95 m long: 2 m are 9 intervals of less than a quarter.
    assert_eq!(of("swept by the pads stage_front").len(), 10);
    let header = fs::read_to_string(&out).expect("a table");
    assert!(
        header.starts_with("t [s],") && header.contains("stage_swept_by_pads_stage_front_10_normal_stress"),
        "{header}"
    );
    // Another manoeuvre with the pad elsewhere adds its damage to the same steel.
    let scale = ", scale: {table: {times: [0, 10, 20], values: [0, 1, 0]}}";
    let [out, half] =
        [("out.yaml", 2.4), ("half.yaml", 1.4)].map(|(name, x)| spec(name, &format!("{{hold: {x}}}"), scale));
    let found = run(&[&out, "--also", &format!("{half}=1e5")]);
    let rows = found["fatigue"].as_array().expect("a table");
    let both = rows.iter().filter(|row| row["place"] == "swept by the pads stage_front").max_by(|a, b| {
        let [a, b] = [a, b].map(|row| row["damage"].as_f64().unwrap_or(f64::NAN));
        a.total_cmp(&b)
    });
    let both = both.expect("a place");
    assert_close("place", &both["x"], 1.1, 2e-3);
    assert_close("both", &both["damage"], damage(stress(1.1, 1.1)) + damage(stress(2.1, 1.1)), 2e-3);
}

/// A four-bar that is cut at the pin of its rocker on the ground, and at that on its coupler, has the same factors.
#[test]
fn factors_do_not_depend_on_where_a_loop_is_cut() {
    let spec = |rest: &str| {
        format!(
            "format: 1\nname: four_bar\nlinks:
- {{name: base}}
- {{name: crank, on: base, placement: {{transform: {{rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: 3, com: [0.2, 0, 0], inertia: {{Ixx: 0.01, Iyy: 0.04, Izz: 0.04}}}}
- {{name: coupler, placement: {{transform: {{translation: [0.4, 0, 0]}}}}, joint: revolute, mass: 5, com: [0.5, 0, 0], inertia: {{Ixx: 0.1, Iyy: 0.5, Izz: 0.5}}}}
{rest}
drives: [{{coordinate: crank_psi, rigid: true, motion: {{quintic: {{from: 45 deg, to: 120 deg, duration: 0.5}}}}}}]
run: {{duration: 0.5, output: 0.002}}\n"
        )
    };
    let rocker = "mass: 6, com: [0.45, 0, 0], inertia: {Ixx: 0.1, Iyy: 0.4, Izz: 0.4}";
    let at_ground = format!(
        "- {{name: rocker, placement: {{transform: {{translation: [1.1, 0, 0]}}}}, joint: revolute, {rocker}}}
loop_joints: [{{name: g, from: {{at: [1.2, 0, 0]}}, to: {{link: rocker, at: [0.9, 0, 0]}}, joint: {{pin: {{axis: [0, 1, 0], to_axis: [0, 0, 1]}}}}}}]
guess: {{coupler_psi: -12 deg, rocker_psi: -120 deg}}"
    );
    let at_coupler = format!(
        "- {{name: rocker, on: base, placement: {{transform: {{translation: [1.2, 0, 0], rotation: {{x: 90 deg}}}}}}, joint: revolute, {rocker}}}
loop_joints: [{{name: g, from: {{link: coupler, at: [1.1, 0, 0]}}, to: {{link: rocker, at: [0.9, 0, 0]}}, joint: {{pin: {{axis: [0, 0, 1]}}}}}}]
guess: {{coupler_psi: -12 deg, rocker_psi: 110 deg}}"
    );
    let report = |name: &str, rest: &str| {
        let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        fs::write(&file, spec(rest)).expect("a file");
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        let output = command.arg("factors").arg(&file).args(["--tolerance", "1e-8", "--format", "json"]).output();
        let output = output.expect("it starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<Value>(&output.stdout).expect("JSON")
    };
    let [ground, coupler] = [report("at_ground.yaml", &at_ground), report("at_coupler.yaml", &at_coupler)];
    let factor = |report: &Value, quantity: &str| {
        let rows = report["factors"].as_array().expect("a table");
        rows.iter().find(|row| row["quantity"] == quantity).expect("a quantity")["factor"].clone()
    };
    // Of the two pins, each has its factor wherever the loop is cut. The runs differ by errors of 1e-8 per step.
    for (one, other) in [("rocker", "g"), ("g", "rocker"), ("coupler", "coupler"), ("crank", "crank")] {
        let [one, other] = [(&ground, one), (&coupler, other)]
            .map(|(report, joint)| factor(report, &format!("force of joint {joint}")));
        assert_close("pin", &other, one.as_f64().expect("a number"), 1e-5);
    }
    assert_close("greatest", &coupler["greatest_factor"], ground["greatest_factor"].as_f64().expect("a number"), 1e-5);
    // A component depends on the axes of its joint.
    assert!(factor(&ground, "g_force_x").is_null() && factor(&ground, "g_force_z").is_null());
}

/// A load that comes at once onto a spring without damping lets it swing by as much as it deflects: (M + 2m)/(M + m) of the force at rest.
#[test]
fn a_load_that_comes_at_once_counts_twice() {
    let spec = "format: 1\nname: sudden\nparameters: {load: {value: 90, unit: kg}}
links: [{name: hook, joint: {prismatic: {axis: z}}, mass: load, com: [0, 0, 0]}]
drives: [{coordinate: hook_z, stiffness: 5e4, motion: {hold: 0}}]
analyses: [statics, dynamics, modes, internal_forces]
run: {duration: 2, output: 0.01}
events: [{name: load, at: 0.5, set: {load: 590}}]
";
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("sudden.yaml");
    fs::write(&file, spec).expect("a file");
    let run = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_crane")).arg("factors").arg(&file).args(arguments).output().expect("it starts")
    };
    let output = run(&[
        "--hoisting-class",
        "hc2",
        "--hoisting-speed",
        "0.5",
        "--tabulated",
        "--tolerance",
        "1e-8",
        "--format",
        "json",
    ]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    // Results are 0.01 s apart, a period is 0.68 s: a peak between two of them is missed by up to (ω h/2)²/2 = 1.1e-3 of the swing.
    assert_close("factor", &report["greatest_factor"], (90.0 + 1000.0) / 590.0, 1e-3);
    assert_close("tabulated", &report["tabulated_factor"], 1.1 + 0.34 * 0.5, 1e-12);
    let tabulated = report["tabulated"].as_array().expect("a table");
    assert_eq!(tabulated.len(), 18);
    // What is of no single source has no name of a standard.
    let named = |row: &&Value| row["source"].as_str().is_some_and(|source| source.starts_with("EN "));
    assert_eq!(tabulated.iter().filter(named).map(|row| row["edition"].clone()).collect::<Vec<_>>(), ["2006"; 4]);
    let force = &report["factors"][0];
    assert_eq!(force["quantity"], "hook_z_drive_force");
    assert_close("at rest before", &force["minimum_at_rest"], 90.0 * 9.81, 1e-6);
    assert_close("at rest after", &force["maximum_at_rest"], 590.0 * 9.81, 1e-6);
    assert_eq!(report["events"][0]["from"], 90.0);
    let output = run(&["--hoisting-class", "hc2"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("--hoisting-speed"), "{output:?}");
}
