//! A crane compared with itself with rigid beams, and with another one; its small motions as matrices.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use serde_json::Value;

/// A boom of two sections with a load on its tip, held by the spring of its drive.
const BOOM: &str = "format: 1
name: boom
parameters: {payload: {value: 300, unit: kg}}
materials: {steel: {E: 2.1e11, G: 8.1e10, density: 7850}}
links:
  - name: boom
    placement: {transform: {rotation: {x: 90 deg}}}
    joint: revolute
    beam: {length: 4, sections: 2, material: steel, section: {box: {height: 0.2, width: 0.15, thickness: 0.006}}}
  - {name: load, mass: payload, com: [0, 0, 0], inertia: {Ixx: 1, Iyy: 1, Izz: 1}}
drives: [{coordinate: boom_psi, stiffness: 4e6, damping: 2e4, motion: {hold: 0}}]
points: [{name: tip, link: load, at: [0, 0, 0]}]
guess: {boom_1_psi: 0.001}
run: {duration: 0.1, output: 0.05}
";

/// An empty folder of a test, with the spec in it.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("comparison_{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("boom.yaml"), BOOM).expect("a file");
    folder
}

fn crane(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_crane")).current_dir(folder).args(arguments).output().expect("it starts")
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let output = crane(folder, arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Height of the tip at rest.
fn height(report: &Value) -> f64 {
    report["points"][0]["z"].as_f64().expect("a number")
}

/// The drive's spring gives way by `m g L / k`, and nothing else deflects: `δ = L · (m_total g L_eff)/k`.
#[test]
fn a_rigid_twin_bends_nowhere() {
    let folder = folder("twin");
    let rigid = json(&folder, &["statics", "boom.yaml", "--rigid", "--format", "json"]);
    let area = 0.2 * 0.15 - 0.188 * 0.138;
    let moment = 9.81 * (300.0 * 4.0 + 7850.0 * area * 4.0 * 2.0);
    let expected = -4.0 * moment / 4e6;
    // Angles of 0.005: their sine and the lever's cosine are off by 1e-5 of them.
    assert!((height(&rigid) / expected - 1.0).abs() < 3e-5, "{} instead of {expected}", height(&rigid));
    assert_eq!(rigid["pose"].as_array().map(Vec::len), Some(1), "no elements");

    // The same as a spec with `sections: rigid` written into it.
    let written = BOOM.replace("sections: 2", "sections: rigid").replace("guess: {boom_1_psi: 0.001}\n", "");
    fs::write(folder.join("written.yaml"), written).expect("a file");
    assert_eq!(height(&json(&folder, &["statics", "written.yaml", "--format", "json"])), height(&rigid));

    let again = crane(&folder, &["statics", "written.yaml", "--rigid"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("rigid already"));
}

#[test]
fn a_crane_is_compared_with_itself_and_with_another() {
    let folder = folder("pair");
    let report = json(&folder, &["compare", "boom.yaml", "--format", "json", "--out", "twins"]);
    let [rigid, flexible] = [&["--rigid"][..], &[]]
        .map(|more| height(&json(&folder, &[&["statics", "boom.yaml", "--format", "json"], more].concat())));
    let apart = report["deflection"][0]["z"].as_f64().expect("a number");
    assert!((apart - (flexible - rigid)).abs() < 1e-12, "{apart} m, {flexible} m, {rigid} m");
    assert!(apart < -1e-3, "a boom of steel sinks by some millimetres: {apart}");
    for file in ["report.html", "comparison_deviation.svg", "boom.csv", "boom_rigid.csv"] {
        assert!(folder.join("twins").join(file).is_file(), "{file}");
    }

    // Two versions of a file with the same crane name.
    fs::write(folder.join("longer.yaml"), BOOM.replace("length: 4", "length: 5")).expect("a file");
    let arguments =
        ["compare", "boom.yaml", "longer.yaml", "--set", "payload=100", "--format", "json", "--out", "pair"];
    let report = json(&folder, &arguments);
    let longer = json(&folder, &["statics", "longer.yaml", "--set", "payload=100", "--format", "json"]);
    let shorter = json(&folder, &["statics", "boom.yaml", "--set", "payload=100", "--format", "json"]);
    let apart = report["deflection"][0]["z"].as_f64().expect("a number");
    assert!((apart - (height(&longer) - height(&shorter))).abs() < 1e-12, "{apart}");
    assert!(folder.join("pair/boom_other.csv").is_file());

    let unknown = crane(&folder, &["compare", "boom.yaml", "--set", "pay=1"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&unknown.stderr).contains("has no live parameter `pay`"));
}

/// `K x = ω² A x` and `xᵀ A x = 1`, from the numbers of the file.
#[test]
fn matrices_have_the_modes_of_the_table() {
    let folder = folder("matrices");
    let report = json(&folder, &["modes", "boom.yaml", "--matrices", "boom.json", "--format", "json"]);
    let text = fs::read_to_string(folder.join("boom.json")).expect("a file");
    let written: Value = serde_json::from_str(&text).expect("JSON");
    let numbers = |value: &Value| -> Vec<f64> {
        value.as_array().expect("an array").iter().map(|x| x.as_f64().expect("a number")).collect()
    };
    let matrix =
        |name: &str| -> Vec<Vec<f64>> { written[name].as_array().expect("a matrix").iter().map(numbers).collect() };
    let times = |matrix: &[Vec<f64>], x: &[f64]| -> Vec<f64> {
        matrix.iter().map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum()).collect()
    };
    let (mass, stiffness) = (matrix("mass"), matrix("stiffness"));
    let squares = numbers(&written["omega_squared"]);
    assert_eq!(written["coordinates"].as_array().map(Vec::len), Some(squares.len()));
    for (shape, square) in matrix("shapes").iter().zip(&squares) {
        let (momentum, force) = (times(&mass, shape), times(&stiffness, shape));
        let norm: f64 = momentum.iter().zip(shape).map(|(p, x)| p * x).sum();
        assert!((norm - 1.0).abs() < 1e-9, "{norm}");
        let size = force.iter().map(|f| f.abs()).fold(0.0, f64::max);
        for (force, momentum) in force.iter().zip(&momentum) {
            assert!((force - square * momentum).abs() < 1e-8 * size.max(square.abs()), "{force}, {square} {momentum}");
        }
    }
    let frequency = report["undamped"][0]["frequency"].as_f64().expect("a number");
    assert!((squares[0].sqrt() / std::f64::consts::TAU / frequency - 1.0).abs() < 1e-12);

    assert!(crane(&folder, &["modes", "boom.yaml", "--matrices", "boom.npz"]).status.success());
    assert!(fs::read(folder.join("boom.npz")).expect("a file").starts_with(b"PK\x03\x04"));
    let other = crane(&folder, &["modes", "boom.yaml", "--matrices", "boom.txt"]);
    assert_eq!(other.status.code(), Some(2));
}

/// Poses are printed only on request.
#[test]
fn poses_are_printed_on_request() {
    let folder = folder("text");
    let text = |arguments: &[&str]| String::from_utf8(crane(&folder, arguments).stdout).expect("text");
    let short = text(&["statics", "boom.yaml"]);
    assert!(!short.contains("boom_1_psi") && short.contains("With `--all` also: Pose"), "{short}");
    let whole = text(&["statics", "boom.yaml", "--all"]);
    assert!(whole.contains("boom_1_psi") && whole.contains(" °"), "{whole}");
}

/// What has one name is one thing, wherever it stands in a spec; what only one crane has, stands alone.
#[test]
fn cranes_are_compared_by_names() {
    let folder = folder("names");
    let spec = |first: &str, second: &str, more: &str| {
        let drive = |name: &str| {
            let stiffness = if name == "column" { "1e6" } else { "4e6" };
            format!("  - {{coordinate: {name}_psi, stiffness: {stiffness}, damping: 2e4, motion: {{hold: 0}}}}\n")
        };
        let foot = |name: &str| {
            let y = if name == "column" { 1.0 } else { -1.5 };
            format!("  - {{name: {name}, at: [0, {y}, 0], stiffness: [1e7, 1e7, 1e7], damping: [1e4, 1e4, 1e4]}}\n")
        };
        format!(
            "format: 1\nname: x\nlinks:\n  - {{name: truck, joint: free, mass: 2000, com: [0, 0, 0.5], inertia: {{gyration: [1, 1, 1]}}}}\n  \
             - {{name: column, placement: {{transform: {{translation: [0, 0, 1]}}}}, joint: revolute, mass: 100, com: [0, 0, 0.5], inertia: {{gyration: [0.2, 0.2, 0.2]}}}}\n  \
             - {{name: boom, placement: {{transform: {{translation: [0, 0, 1], rotation: {{x: 90 deg}}}}}}, joint: revolute, mass: 200, com: [1, 0, 0], inertia: {{gyration: [0.2, 0.6, 0.6]}}}}\n\
             supports:\n{}{}  - {{name: front, at: [1, 0, 0], stiffness: [1e7, 1e7, 1e7]}}\ndrives:\n{}{}points:\n{more}  - {{name: tip, link: boom, at: [2, 0, 0]}}\n\
             run: {{duration: 0.02, output: 0.01}}\n",
            foot(first),
            foot(second),
            drive(first),
            drive(second)
        )
    };
    fs::write(folder.join("one.yaml"), spec("column", "boom", "")).expect("a file");
    let other = spec("boom", "column", "  - {name: root, link: boom, at: [0, 0, 0]}\n");
    fs::write(folder.join("other.yaml"), other.replace("name: x", "name: y")).expect("a file");
    let both = json(&folder, &["compare", "one.yaml", "other.yaml", "--format", "json"]);
    let alone = json(&folder, &["statics", "one.yaml", "--format", "json"]);
    for (table, of) in [("drives", "drive"), ("reactions", "support"), ("pose", "coordinate"), ("points", "point")] {
        let rows = both[table].as_array().expect(table);
        assert_eq!(rows.len(), alone[table].as_array().expect(table).len() + usize::from(table == "points"), "{table}");
        for row in alone[table].as_array().expect(table) {
            let pair = rows.iter().find(|pair| pair[of] == row[of]).unwrap_or_else(|| panic!("{table}: {row}"));
            let (own, of_both) = (numbers(row), numbers(pair));
            assert_eq!(of_both.len(), 2 * own.len(), "{pair}");
            for number in own {
                // Newton's method ends at 1e-10 of forces of 1e4 N.
                let same = of_both.iter().filter(|other| (**other - number).abs() < 1e-5).count();
                assert!(same >= 2, "{table}: {row}, {pair}");
            }
        }
    }
}

/// All numbers of a row.
fn numbers(row: &Value) -> Vec<f64> {
    match row {
        Value::Object(fields) => fields.values().flat_map(numbers).collect(),
        other => other.as_f64().into_iter().collect(),
    }
}
