//! What drives, cylinders and the pump must be able to do, by hand, and parts of lists that can.

use std::{fs, path::Path};

use serde_json::Value;

use super::{crane, folder, refused, text};

/// A wheel of 50 kg m² that turns by 3 rad within 4 s, and 100 kg that rise by 1.5 m, both with the trapezoidal speed of which a quarter is spent accelerating: 1 rad/s
/// and 0.5 m/s. The run ends a second later.
const MOVED: &str = "format: 1
name: moved
links:
  - {name: wheel, joint: {revolute: {axis: z}}, mass: 10, com: [0, 0, 0], inertia: {Ixx: 30, Iyy: 30, Izz: 50}}
  - {name: load, joint: {prismatic: {axis: z}}, mass: 100, com: [0, 0, 0]}
drives:
  - {coordinate: wheel_psi, rigid: true, motion: {trapezoid: {from: 0, to: 3, duration: 4}}}
  - {coordinate: load_z, rigid: true, motion: {trapezoid: {from: 0, to: 1.5, duration: 4}}}
run: {duration: 5, output: 0.001}
";

/// 100 kg on an arm of 2 m that a cylinder lifts slowly from level by 20°.
const LIFTED: &str = "format: 1
name: lifted
links: [{name: post}, {name: arm, joint: {revolute: {axis: y}}, mass: 100, com: [2, 0, 0]}]
drives: [{coordinate: arm_theta, rigid: true, motion: {quintic: {from: 0, to: -20 deg, duration: 20}}}]
cylinders:
  - {name: lift, coordinate: arm_theta, foot: {link: post, at: [0, 0, -1]}, head: {link: arm, at: [1, 0, 0]}, bore: 0.1, rod: 0.06, retracted: 1.3, stroke: 0.5}
pump: {max_flow: 1e-3}
run: {duration: 22, output: 0.01}
";

fn found(folder: &Path, spec: &str, parts: &str) -> Value {
    let (file, list) = (folder.join("crane.yaml"), folder.join("parts.csv"));
    fs::create_dir_all(folder).expect("a folder");
    fs::write(&file, spec).expect("a file");
    fs::write(&list, parts).expect("a file");
    let [file, list] = [&file, &list].map(|path| path.to_str().expect("a path"));
    let output = crane(&["drives", file, "--parts", list, "--format", "json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn assert_close(row: &Value, key: &str, expected: f64, tolerance: f64) {
    let number = row[key].as_f64().unwrap_or(f64::NAN);
    assert!((number / expected - 1.0).abs() < tolerance, "{key}: {number}, not {expected}");
}

/// Results are 1 ms apart, and efforts jump between them: the work of 25 J is off by 50 W for half of that, 1e-3 of it.
const JUMPS: f64 = 2e-3;

#[test]
fn duties_of_a_wheel_and_a_hoist_by_hand() {
    let parts = "part,torque [N m],rated_torque [N m],speed [rpm],power [kW],ratio\ndirect,60,40,12,0.06,\nweak,45,40,12,1,\ngeared,6,4,110,0.06,10\n";
    let report = found(&folder("motors"), MOVED, parts);
    let [wheel, load] = [0, 1].map(|row| &report["duties"][row]);
    let by_hand = [
        (wheel, [50.0, 50.0 * 0.4_f64.sqrt(), 1.0, 50.0, 25.0]),
        // 100 kg with 9.81 + 0.5, 9.81 and 9.81 − 0.5 m/s².
        (
            load,
            [
                1031.0,
                ((1031_f64.powi(2) + 3.0 * 981_f64.powi(2) + 931_f64.powi(2)) / 5.0).sqrt(),
                0.5,
                515.5,
                981.0 * 1.5,
            ],
        ),
    ];
    for (row, numbers) in by_hand {
        for (key, number) in ["effort", "rms_effort", "rate", "power", "work"].into_iter().zip(numbers) {
            assert_close(row, key, number, JUMPS);
        }
    }
    assert_close(wheel, "braking_work", 25.0, JUMPS);
    assert_eq!(load["braking_work"], 0.0);
    let parts = report["parts"].as_array().expect("a table");
    let names: Vec<&Value> = parts.iter().map(|row| &row["part"]).collect();
    assert_eq!(names, ["geared", "direct", "weak"]);
    assert!(parts.iter().all(|row| row["for"] == "wheel_psi"));
    // 10 rad/s of 110/min; 50 of 60 N m.
    assert_close(&parts[0], "used", 10.0 / (110.0 * std::f64::consts::TAU / 60.0), JUMPS);
    assert_close(&parts[1], "used", 50.0 / 60.0, JUMPS);
    assert_eq!((&parts[0]["of"], &parts[0]["suffices"]), (&"speed".into(), &"yes".into()));
    assert_eq!(parts[2]["short_of"], serde_json::json!(["torque 50 of 45 N m"]));
    let report = found(&folder("hoists"), MOVED, "part,force [kN],power [kW]\nhoist,1.1,0.5\n");
    assert_eq!(report["parts"][0]["short_of"], serde_json::json!(["power 0.5155 of 0.5 kW"]));
}

/// With oil on the side that is not loaded, the piston of another part carries that on its own ring, too.
#[test]
fn parts_have_the_back_pressure_of_the_spec() {
    let spec = LIFTED.replace("retracted: 1.3", "back_pressure: 5 bar, retracted: 1.3");
    let report = found(&folder("back_pressure"), &spec, "part,bore [mm],rod [mm]\nsame,100,60\nthin,80,40\n");
    let duty = &report["cylinder_duties"][0];
    let [push, pressure, flow] = ["push", "pressure", "flow"].map(|key| duty[key].as_f64().unwrap_or(f64::NAN));
    let parts = report["parts"].as_array().expect("a table");
    let of = |name: &str| parts.iter().find(|row| row["part"] == name).cloned().unwrap_or_default();
    // Of the same size, the same numbers.
    assert_close(&of("same"), "pressure", pressure, 1e-12);
    assert_close(&of("same"), "flow", flow, 1e-12);
    let [piston, ring] = [0.08 * 0.08, 0.08 * 0.08 - 0.04 * 0.04].map(|square| std::f64::consts::FRAC_PI_4 * square);
    assert_close(&of("thin"), "pressure", (push + 5e5 * ring) / piston, 1e-12);
}

/// The lever arm of the cylinder is cos((90° + θ)/2) m, its length 2 sin((90° + θ)/2) m.
#[test]
fn duties_of_a_cylinder_and_its_pump_by_hand() {
    let parts = "part,bore [mm],rod [mm],pressure [bar],stroke [mm],retracted [mm]
thin,40,20,20,300,1400
good,50,30,20,300,1400
short,50,30,20,200,1400
long,50,30,20,300,1450
";
    let report = found(&folder("cylinders"), LIFTED, parts);
    let lift = &report["cylinder_duties"][0];
    let push = 100.0 * 9.81 * 2.0 * 20_f64.to_radians().cos() / 55_f64.to_radians().cos();
    // Accelerations of 5e-3 rad/s² are 1e-3 of the weight, and none at the end, where the push is greatest.
    assert_close(lift, "push", push, 1e-4);
    assert_close(lift, "shortest", 2_f64.sqrt(), 1e-9);
    assert_close(lift, "longest", 2.0 * 55_f64.to_radians().sin(), 1e-9);
    let area = std::f64::consts::FRAC_PI_4 * 0.1 * 0.1;
    assert_close(lift, "pressure", push / area, 1e-4);
    assert_close(lift, "flow", area * lift["speed"].as_f64().unwrap_or(f64::NAN), 1e-9);
    let of_pump = |name: &str| {
        let rows = report["summary"].as_array().expect("a table");
        rows.iter().find(|row| row["quantity"] == name).cloned().unwrap_or_default()
    };
    // The pump lifts the weight; below 0.6 l/min, of 0.5 % of the oil at both ends of the motion, its pressure counts in part.
    assert_close(&of_pump("energy of the pump"), "value", 981.0 * 2.0 * 20_f64.to_radians().sin(), 3e-3);
    let parts = report["parts"].as_array().expect("a table");
    let of = |name: &str| parts.iter().find(|row| row["part"] == name).cloned().unwrap_or_default();
    let of_good = std::f64::consts::FRAC_PI_4 * 0.05 * 0.05;
    assert_close(&of("good"), "used", push / of_good / 20e5, 1e-4);
    assert_eq!(of("good")["suffices"], "yes");
    let short = |name: &str| of(name)["short_of"].clone();
    assert_eq!(short("thin"), serde_json::json!(["pressure 25.58 of 20 bar"]));
    assert_eq!(short("short"), serde_json::json!(["stroke 224.1 of 200 mm", "length 1638 of 1600 mm"]));
    assert_eq!(short("long"), serde_json::json!(["retracted 1450 mm where it is 1414 mm long"]));
    let report = found(&folder("pumps"), LIFTED, "part,flow [l/min],pressure [bar]\npump,8,3\n");
    let short = report["parts"][0]["short_of"].to_string();
    assert!(short.contains("flow") && short.contains("of 8 l/min") && short.contains("of 3 bar"), "{short}");
}

#[test]
fn lists_that_cannot_be_used_are_refused() {
    let folder = folder("bad_parts");
    fs::create_dir_all(&folder).expect("a folder");
    let list = folder.join("parts.csv");
    let path = list.to_str().expect("a path");
    for (content, wanted) in [
        ("part,torque\n", &["has no rows"][..]),
        ("part,mass\nA,1\n", &["none of the columns `torque`, `force`, `bore` and `flow`", "torque [N m]"]),
        ("part,torque,bore\nA,1,1\n", &["or several of them"]),
        ("part,torque,sped\nA,1,1\n", &["the column `sped`, which motors do not have", "rated_torque, speed"]),
        ("torque\n1\n", &["no column `part`"]),
        ("part,torque [kN]\nA,1\n", &["line 2", "torque"]),
        ("part,torque\nA,0\n", &["line 2", "`0` is not above 0"]),
        ("part,torque\nA,\n", &["line 2", "the torque is empty"]),
        ("part,torque,torque\nA,1,1\n", &["the column `torque` twice"]),
        ("part,torque,efficiency\nA,1,90\n", &["line 2", "above 1", "efficiency [%]"]),
        ("part,bore,rod\nA,0.05,0.05\n", &["not thinner than the bore"]),
        ("part;torque\nA;1\n", &["semicolons"]),
        ("part,torque\nA\n", &["line 2", "1 fields, but the header names 2"]),
    ] {
        fs::write(&list, content).expect("a file");
        refused(&["drives", "knuckle_boom", "--parts", path], wanted);
    }
}
