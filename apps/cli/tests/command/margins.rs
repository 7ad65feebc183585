//! Margins of loops: of a spec whose margins are known, over poses, as a table and as a map, and what cannot be answered.

use std::f64::consts::FRAC_PI_2;
use std::fs;

use super::{crane, folder, json, refused, text};

/// A turntable with the moment of inertia 10 kg m² plus that of a load, on an effort.
const TURNTABLE: &str = "format: 1\nname: turntable\nparameters: {load: {value: 0, unit: kg}}\ninputs: {torque: {unit: N m}}\nlinks:\n\
     - {name: table, joint: revolute, bodies: [{name: disc, mass: 5, com: [0, 0, 0], inertia: {Ixx: 5, Iyy: 5, Izz: 10}}, {name: load, mass: load, com: [1, 0, 0]}]}\n\
     drives: [{coordinate: table_psi, effort: {input: torque}}]\n";

/// The phase margin of `(p + d s) e^(−T s)/(J s²)` is atan(d ω/p) − ω T with `J ω² = |p + i d ω|`.
#[test]
fn a_turntable_has_the_margins_of_its_formula() {
    let path = folder("margins");
    fs::create_dir_all(&path).expect("a folder");
    let spec = path.join("turntable.yaml");
    fs::write(&spec, TURNTABLE).expect("a file");
    let spec = spec.to_string_lossy().into_owned();
    let (p, d, delay) = (40.0, 30.0, 0.08);
    let loop_of = ["--on", "table_psi_drive_torque", "--p", "40", "--d", "30", "--delay", "0.08"];
    let found = json(&[&["margins", &spec][..], &loop_of, &["--range", "load=0:30:3", "--format", "json"]].concat());
    let rows = found["margins"].as_array().expect("rows");
    assert_eq!(rows.len(), 3);
    for (row, inertia) in rows.iter().zip([10.0_f64, 25.0, 40.0]) {
        let ratio: f64 = (d / inertia).powi(2);
        let omega = (0.5 * (ratio + (ratio * ratio + 4.0 * (p / inertia).powi(2)).sqrt())).sqrt();
        let number = |key: &str| row[key].as_f64().expect("a number");
        assert!((number("crossover") - omega).abs() < 1e-7, "{row}");
        assert!((number("phase_margin") - ((d * omega / p).atan() - omega * delay)).abs() < 1e-7, "{row}");
        assert_eq!(row["stable"], "yes");
    }
    assert_eq!(found["stable_loops"], 3);
    // A loop of the rate alone: 1/(J s), with a quarter of a turn of margin.
    let rate = json(&[
        "margins",
        &spec,
        "--on",
        "torque",
        "--measure",
        "table_psi_rate",
        "--p",
        "20",
        "--delay",
        "0.1",
        "--format",
        "json",
    ]);
    let phase = rate["margins"][0]["phase_margin"].as_f64().expect("a number");
    assert!((phase - (FRAC_PI_2 - 2.0 * 0.1)).abs() < 1e-7, "{phase}");
    // With a lead that crosses at 4 rad/s: p √((1 + 1.2²)/(1 + 0.12²)) = 10 · 4.
    let of_rate = ["margins", &spec, "--on", "torque", "--measure", "table_psi_rate"];
    let p = (40.0 * ((1.0 + 0.12_f64.powi(2)) / (1.0 + 1.2_f64.powi(2))).sqrt()).to_string();
    let found =
        json(&[&of_rate[..], &["--p", &p, "--delay", "0.1", "--lead", "0.3,0.03", "--format", "json"]].concat());
    let phase = found["margins"][0]["phase_margin"].as_f64().expect("a number");
    assert!((phase - (FRAC_PI_2 + 1.2_f64.atan() - 0.12_f64.atan() - 4.0 * 0.1)).abs() < 1e-7, "{phase}");
    // A loop that is unstable lacks phase: π/2 − 2.
    let unstable = text(&crane(&[&of_rate[..], &["--p", "20", "--delay", "1", "-q"]].concat()).stdout);
    assert!(unstable.contains("-24.592"), "{unstable}");
}

#[test]
fn margins_are_written_as_a_table_and_as_a_map() {
    let path = folder("margins_files");
    fs::create_dir_all(&path).expect("a folder");
    let ranges = ["--range", "main_boom_theta=0:60deg:3", "--range", "knuckle_theta=-60deg:0:2"];
    for (name, begins) in [("margins.csv", "main_boom_theta [rad],knuckle_theta [rad],stable"), ("margins.svg", "<svg")]
    {
        let file = path.join(name);
        let asked = ["margins", "knuckle_boom", "--on", "main_boom_theta_rate", "--p", "0.6", "--delay", "0.1", "-o"];
        let output = crane(&[&asked[..], &[&*file.to_string_lossy()], &ranges].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let written = fs::read_to_string(&file).expect("a file");
        assert!(written.starts_with(begins), "{written:.200}");
        let printed = text(&output.stdout);
        assert!(printed.contains("acts on") && printed.contains("main_boom_theta_rate"), "{printed}");
    }
    let map = fs::read_to_string(path.join("margins.svg")).expect("a map");
    assert!(map.contains("phase margin") && map.contains("knuckle_theta [°]"), "{map:.400}");
    assert!(map.contains("p 0.6, dead time 0.1"), "{map:.400}");
}

/// A valve's loop about the pose that it holds.
#[test]
fn a_loop_acts_on_a_valve() {
    let found = json(&[
        "margins",
        "eight_link_hydraulic",
        "--on",
        "boom_cylinder_valve",
        "--measure",
        "boom_cylinder_length",
        "--p",
        "2",
        "--format",
        "json",
    ]);
    assert_eq!(found["margins"][0]["status"], "ok", "{found:#}");
    assert_eq!(found["loop"]["units"], "1 per m");
}

/// Loops of the reference crane that grow far from the axis, by all roots of 1 + L in another program: −0.1247 at 7.15 rad/s and −0.0050 at
/// 2.635 rad/s, as printed there.
#[test]
fn a_loop_that_grows_has_a_negative_damping_ratio() {
    for (on, p, damping, at) in [("boom_psi_rate", "5", -0.1247, 7.15), ("column_psi_rate", "0.8", -0.0050, 2.635)] {
        let asked = ["margins", "eight_link_flexible", "--on", on, "--p", p, "--delay", "0.06", "--lag", "0.05"];
        let found = json(&[&asked[..], &["--format", "json"]].concat());
        let row = &found["margins"][0];
        assert_eq!((&row["stable"], &row["status"]), (&"no".into(), &"ok".into()), "{row}");
        let number = |key: &str| row[key].as_f64().expect("a number");
        assert!((number("damping_ratio") - damping).abs() < 6e-5, "{row}");
        assert!((number("at") - at).abs() < 6e-3, "{row}");
    }
}

/// A dead time in the wrong unit: unstable, without a list of motions, and the reason; longer than any, refused.
#[test]
fn a_dead_time_that_is_not_in_seconds_is_told() {
    for delay in ["65", "65000", "1e6"] {
        let asked =
            ["margins", "knuckle_boom", "--on", "main_boom_theta", "--p", "1", "--delay", delay, "--format", "json"];
        let row = &json(&asked)["margins"][0];
        assert_eq!(row["stable"], "no", "{delay}: {row}");
        assert!(row["damping_ratio"].is_null() && row["phase_margin"].is_f64(), "{delay}: {row}");
        assert!(row["status"].as_str().is_some_and(|status| status.contains("is it in s?")), "{delay}: {row}");
    }
    for (option, time) in [("--delay", "1e7"), ("--filter", "1e18"), ("--lag", "1e300")] {
        let asked = ["margins", "knuckle_boom", "--on", "main_boom_theta", "--p", "1", option, time];
        refused(&asked, &["out of range", "a time in s"]);
    }
}

#[test]
fn loops_that_cannot_be_are_refused() {
    refused(
        &["margins", "knuckle_boom", "--on", "main_bom_theta", "--p", "1"],
        &["main_bom_theta", "did you mean `main_boom_theta`"],
    );
    refused(&["margins", "knuckle_boom", "--on", "main_boom_theta"], &["all gains are zero", "`--p 1.3`"]);
    refused(
        &["margins", "knuckle_boom", "--on", "main_boom_theta", "--p", "1", "--measure", "x"],
        &["nothing `x` to measure"],
    );
    refused(&["margins", "knuckle_boom", "--on", "main_boom_theta", "--p", "1", "--delay", "-1"], &["at least 0"]);
    refused(&["margins", "knuckle_boom", "--on", "main_boom_theta", "--p", "1", "-o", "a.pdf"], &["`.csv`", "`.svg`"]);
    let map = ["margins", "knuckle_boom", "--on", "main_boom_theta", "--p", "1", "-o", "a.svg"];
    refused_without_output(&map, "a map has two axes");
    // The torque of a drive without a load: its gain does not fall.
    let output = crane(&[
        "margins",
        "knuckle_boom",
        "--on",
        "main_boom_theta",
        "--d",
        "2",
        "--measure",
        "main_boom_theta_prescribed",
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("not below 1 at high frequencies"), "{}", text(&output.stderr));
}

fn refused_without_output(arguments: &[&str], expected: &str) {
    let output = crane(arguments);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains(expected), "{}", text(&output.stderr));
}
