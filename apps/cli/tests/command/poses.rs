//! Poses of `--hold` and `--range`.

use std::fs;

use serde_json::Value;

use super::{crane, folder, json, refused, text};

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

/// A beam clamped at a drive that turns it, with a load at its tip: a cantilever at any angle.
const ARM: &str = "format: 1
name: arm
parameters: {payload: {value: 200, unit: kg}}
links:
  - name: arm
    placement: {transform: {rotation: {x: 90 deg}}}
    joint: revolute
    beam:
      length: 4
      sections: 8
      material: {E: 2.1e11, G: 8.1e10, density: 50, yield_stress: 355e6}
      section: {box: {height: 0.2, width: 0.15, thickness: 0.006}}
  - {name: load, mass: payload, com: [0, 0, 0], inertia: {gyration: [0.1, 0.1, 0.1]}}
drives: [{coordinate: arm_psi, stiffness: 1e10, motion: {quintic: {from: 0, to: 1, duration: 3}}}]
points: [{name: tip, link: load, at: [0, 0, 0]}]
";

fn arm() -> String {
    let out = folder("arm");
    fs::create_dir_all(&out).expect("a folder");
    let file = out.join("arm.yaml");
    fs::write(&file, ARM).expect("a file");
    file.to_str().expect("a path").to_owned()
}

#[test]
fn deflection_over_angle_is_that_of_a_cantilever() {
    let file = arm();
    let csv = folder("poses").join("new/arm.csv");
    let csv_name = csv.to_str().expect("a path");
    let range = ["--range", "arm=0:60deg:3", "-o", csv_name, "--format", "json"];
    let found = json(&[&["statics", &file][..], &range].concat());
    let rows = found["poses"].as_array().expect("rows");
    assert_eq!(rows.len(), 3);
    // F L³/(3 E I) across the beam; sections of order 2 leave 1/(2 n²) of it at n = 8, the small second-order effects add 1e-4.
    let inertia = (0.15 * 0.2_f64.powi(3) - 0.138 * 0.188_f64.powi(3)) / 12.0;
    for (row, degrees) in rows.iter().zip([0.0, 30.0, 60.0_f64]) {
        assert!((number(&row["arm_psi"]) - degrees.to_radians()).abs() < 1e-12);
        let expected = 200.0 * 9.81 * degrees.to_radians().cos() * 64.0 / (3.0 * 2.1e11 * inertia);
        for key in ["deflection_by_flexibility", "deflection_by_the_load"] {
            let off = number(&row[key]) / expected - 1.0;
            assert!(off.abs() < 0.012, "{key} at {degrees}°: {off}");
        }
        assert!((number(&row["radius"]) - 4.0 * degrees.to_radians().cos()).abs() < 0.03);
        assert_eq!(row["status"], "stable");
    }
    assert_eq!(found["units"]["poses"]["arm_psi"], "rad");
    let table = fs::read_to_string(&csv).expect("a table");
    assert!(
        table.starts_with(
            "arm_psi [rad],radius of tip from the world's origin [m],height [m],deflection by flexibility [m]"
        ),
        "{table}"
    );
    assert!(csv.with_extension("svg").exists());
    // The only row of a pose that is held is the same as that of a range.
    let held = json(&["statics", &file, "--hold", "arm_psi=30deg", "--format", "json"]);
    let tip = held["points"].as_array().and_then(|rows| rows.iter().find(|row| row["point"] == "tip")).expect("a row");
    assert!((number(&tip["x"]) - number(&rows[1]["radius"])).abs() < 1e-9, "{tip}");
}

/// What the mesh leaves out is that of the crane with its inputs: the same as where they are written.
#[test]
fn estimates_of_the_mesh_are_with_the_inputs() {
    let out = folder("inputs");
    fs::create_dir_all(&out).expect("a folder");
    let of = |name: &str, value: f64, more: &[&str]| {
        let file = out.join(format!("{name}.yaml"));
        let pulled = format!(
            "inputs: {{pull: {{value: {value}, unit: N}}}}\nloads: [{{name: pull, link: arm, at: [4, 0, 0], force: [0, 1, 0], axes: link, scale: {{input: pull}}}}]\n"
        );
        fs::write(&file, format!("{ARM}{pulled}")).expect("a file");
        let changes = json(&[&["statics", file.to_str().expect("a path"), "--format", "json"], more].concat());
        number(&changes["changes_of_positions_with_twice_the_sections"]["tip"])
    };
    let (set, written) = (of("zero", 0.0, &["--input", "pull=1500"]), of("five", 1500.0, &[]));
    assert!(written > 1e-6 && (set / written - 1.0).abs() < 1e-9, "{set} for {written}");
}

/// A beam that is given element by element has no sections to double.
#[test]
fn what_the_mesh_leaves_out_is_told_or_why_not() {
    let out = folder("elements");
    fs::create_dir_all(&out).expect("a folder");
    let file = out.join("elements.yaml");
    let element = "{length: 0.5, mass: 5, com: [0.2, 0, 0], inertia: {gyration: [0.1, 0.1, 0.1]}}";
    let beam = format!(
        "format: 1\nname: jib\nlinks: [{{name: jib, beam: {{length: 1, elements: [{element}, {element}], \
         springs: [{{stiffness: {{psi: 1e5, theta: 1e5, phi: 1e5}}}}]}}}}]\npoints: [{{name: tip, link: jib, at: [1, 0, 0]}}]\n"
    );
    fs::write(&file, beam).expect("a file");
    let told = text(&crane(&["statics", file.to_str().expect("a path")]).stdout);
    assert!(told.contains("twice the sections  not computed: no beam has a number of `sections`"), "{told}");
}

/// A clamped beam has no rigid form to compare it with: the column is missing, and the others are there.
#[test]
fn a_crane_that_only_bends_has_poses_too() {
    let found = json(&["statics", "cantilever", "--range", "tip_mass=1:2:2", "--format", "json"]);
    let rows = found["poses"].as_array().expect("rows");
    assert_eq!(rows.len(), 2);
    for row in rows {
        assert_eq!(row["status"], "stable");
        assert!(row["deflection_by_flexibility"].is_null(), "{row}");
    }
}

#[test]
fn strength_and_modes_over_poses() {
    let file = arm();
    let found = json(&["strength", &file, "--range", "arm=0:60deg:2", "--format", "json"]);
    let stress = |row: usize| number(&found["poses"][row]["equivalent_stress"]);
    // M/W at the root: within 7 % with 8 sections, as the outermost spring is half a section away. In Pa.
    let modulus = (0.15 * 0.2_f64.powi(3) - 0.138 * 0.188_f64.powi(3)) / 12.0 / 0.1;
    let expected = 200.0 * 9.81 * 4.0 / modulus;
    assert!((stress(0) / expected - 1.0).abs() < 0.07, "{} {expected}", stress(0));
    assert!((stress(1) / stress(0) - 0.5).abs() < 0.02, "{}", stress(1) / stress(0));
    assert_eq!(found["units"]["poses"]["equivalent_stress"], "Pa");
    let found = json(&["modes", &file, "--range", "payload=100:400:2", "--count", "1", "--format", "json"]);
    let frequency = |row: usize| number(&found["poses"][row]["frequency_1"]);
    // The beam has no mass: the frequency falls with the root of the load.
    assert!((frequency(0) / frequency(1) - 2.0).abs() < 0.02, "{}", frequency(0) / frequency(1));
    assert!(found["poses"][0].get("frequency_2").is_none());
}

#[test]
fn poses_that_mean_nothing_are_refused() {
    refused(&["statics", "knuckle_boom", "--hold", "hook_theta=0"], &["has no drive", "driven are"]);
    refused(&["statics", "knuckle_boom", "--hold", "payload=3"], &["live parameter, not a drive", "--set payload=3"]);
    refused(
        &["statics", "knuckle_boom", "--hold", "main_boom_theta=up"],
        &["`up` is not a valid value for main_boom_theta", "30deg"],
    );
    refused(&["modes", "knuckle_boom", "--range", "mainboom=0:1:2"], &["no drive and no live parameter"]);
    refused(&["strength", "knuckle_boom", "-o", "x.csv"], &["`--file` needs `--run` or `--range`"]);
    let output = crane(&["modes", "knuckle_boom", "--count", "2"]);
    assert!(text(&output.stdout).contains("2 more rows with `--all`"), "{}", text(&output.stdout));
}

#[test]
fn a_drive_is_held_or_varied_and_held_once() {
    let hold = ["statics", "knuckle_boom", "--hold", "main_boom_theta=-1"];
    let also = |more: &[&'static str]| [&hold[..], more].concat();
    let expected = ["`main_boom_theta` is held and varied", "leave `--hold` or `--range` of it out"];
    refused(&also(&["--range", "main_boom_theta=-1:0:3"]), &expected);
    refused(&also(&["--hold", "main_boom=-0.5"]), &["`main_boom_theta` is held twice"]);
}

/// A drive that is held is where it is held: neither the input that moves it nor the one that offsets it counts.
#[test]
fn held_drives_are_where_they_are_held() {
    let spec = "format: 1
name: held
inputs: {lever: {value: 0.5, unit: rad}, trim: {value: 0.2, unit: rad}}
links: [{name: arm, joint: {revolute: {axis: y}}, mass: 10, com: [1, 0, 0]}]
drives: [{coordinate: arm_theta, stiffness: 1e9, motion: {input: lever}, offset: trim}]
";
    let file = folder("held_drives").join("held.yaml");
    std::fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
    std::fs::write(&file, spec).expect("a file");
    let angle = |arguments: &[&str]| {
        let found = json(&[&["statics", &file.to_string_lossy(), "--format", "json"], arguments].concat());
        found["pose"][0]["value"].as_f64().expect("an angle")
    };
    assert!((angle(&[]) - 0.7).abs() < 1e-6);
    assert!((angle(&["--hold", "arm_theta=0.3"]) - 0.3).abs() < 1e-6);
}
