//! Error against run time, as `crane-lab work-precision` measures it.

use std::{
    env, fs,
    path::PathBuf,
    process::{Command, Output},
};

use serde_json::Value;

/// The command, where cargo builds quickly.
fn lab(arguments: &[&str]) -> Output {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/unoptimised");
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane-lab"));
    command.args(arguments).current_dir(folder).output().expect("the command starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn json(arguments: &[&str]) -> Value {
    let output = lab(arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// A separate folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    folder
}

/// Wrong arguments end with code 2 and say what was meant.
fn refused(arguments: &[&str], expected: &[&str]) {
    let output = lab(arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
    for words in expected {
        assert!(message.contains(words), "{arguments:?}: `{words}` not in: {message}");
    }
}

#[test]
fn work_precision_of_every_method() {
    let (out, page) = (folder("work_precision"), folder("work_precision_page"));
    let page = page.join("error.md");
    let arguments = ["work-precision", "knuckle_boom", "--quick", "--duration", "1", "--format", "json"];
    let [out, page] = [&out, &page].map(|path| path.to_str().expect("a path"));
    let report = json(&[&arguments[..], &["--out", out, "--page", page]].concat());
    // The two reference solutions agree to 1e-11 of the load path, so the errors are those of the methods.
    let rows = report["methods"].as_array().expect("rows");
    let error = |method: &str, what: &str| -> Vec<f64> {
        let of = rows.iter().filter(|row| row["method"] == method);
        of.map(|row| row[what].as_f64().expect("a number")).collect()
    };
    for method in ["rk4", "dopri5", "rosw4", "bdf"] {
        for what in ["load_path", "torques", "energy"] {
            let errors = error(method, what);
            assert!(!errors.is_empty() && errors.iter().all(|error| error.is_finite()), "{method} {what}: {errors:?}");
        }
        assert!(error(method, "wall_ms").iter().all(|wall| *wall > 0.0));
    }
    // The finer tolerance is a hundredth of the coarse one. The error of a step includes the efforts of the drives, which makes the
    // path at the coarse tolerance several times more accurate than requested: only a factor of five is required.
    // The path within one second is 0.08 m long, so the finer tolerance is 1.2e-4 of it.
    for (method, most) in [("rosw4", 1e-4), ("bdf", 2e-4)] {
        let [coarse, fine] = error(method, "load_path")[..] else { panic!("two tolerances: {rows:?}") };
        assert!(fine < 0.2 * coarse && fine < most, "{method}: {coarse:e} {fine:e}");
    }
    // Each error that users ask for has a cheapest run, not cheaper for a smaller error.
    let least: Vec<f64> = report["least"]
        .as_array()
        .expect("rows")
        .iter()
        .filter(|row| row["method"] == "rosw4")
        .map(|row| row["wall_ms"].as_f64().expect("a number"))
        .collect();
    assert!(least.len() == 3 && least.is_sorted(), "{least:?}");
    let written = fs::read_to_string(page).expect("a page");
    assert!(written.starts_with("# Error against run time") && written.contains("(images/error_work_precision.svg)"));
    for file in ["knuckle_boom_methods.csv", "knuckle_boom_least.csv", "knuckle_boom_work_precision.svg"] {
        assert!(PathBuf::from(out).join(file).exists(), "{file}");
    }
}

#[test]
fn work_precision_refuses_senseless_options() {
    refused(&["work-precision", "--sections", "3"], &["two or more different numbers", "`none`"]);
    refused(&["work-precision", "--sections", "many"], &["2,4,8"]);
    refused(&["work-precision", "--sections", "none", "--duration", "0"], &["`--duration 0`", "positive"]);
    refused(&["work-precision", "knuckle_bom"], &["there is no crane `knuckle_bom`", "`knuckle_boom`"]);
}

#[test]
fn a_chaotic_motion_has_no_reference_for_long() {
    let output = lab(&["work-precision", "double_pendulum", "--quick", "--duration", "60"]);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("differ by") && message.contains("`--duration "), "{message}");
}

#[test]
fn the_error_of_sections_obeys_the_law_of_a_cantilever() {
    // At the tip only: a point on an element follows a different law.
    let changes = "extends: cantilever
name: cantilever
links: [{name: beam, beam: {sections: 3}}]
points: [{name: middle, remove: true}]
";
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let [file, out] = ["short_cantilever.yaml", "short_cantilever"].map(|name| folder.join(name).display().to_string());
    fs::write(&file, changes).expect("a file");
    let arguments = ["--quick", "--sections", "1,2", "--duration", "0.2", "--format", "json", "--out", &out];
    let report = json(&[&["work-precision", &file][..], &arguments].concat());
    // A tip force P bends it by 1 − 1/(4n²) of the beam's PL³/3EI, its own weight W by 1 − 1/(2n²) of WL³/8EI.
    let (tip, beam) = (20.0, 2.0 * 0.06 * 0.04 * 7850.0);
    let (by_tip, by_own) = (tip / 3.0, beam / 8.0);
    for (row, n) in report["sections"].as_array().expect("rows").iter().zip([1.0, 2.0]) {
        let error = row["static_deflection"].as_f64().expect("a number");
        let law = (by_tip / 4.0 + by_own / 2.0) / (by_tip + by_own) / (n * n);
        // Deflections are 1 % of the length, so their squares amount to 1e-4.
        assert!((error / law - 1.0).abs() < 1e-2, "{n} sections: {error} {law}");
    }
    // The limit is extrapolated from these two, so the error of one is four times that of the other.
    let off = |row: usize| report["sections"][row]["frequencies"].as_f64().expect("a number");
    assert!((off(0) / off(1) - 4.0).abs() < 1e-9, "{} {}", off(0), off(1));
    assert!(!report["advice"].as_array().expect("rows").is_empty());
}
