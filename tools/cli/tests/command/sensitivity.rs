//! What moves what: by parameters, by places of the spec, and what cannot be answered.

use std::fs;

use super::{crane, folder, json, text};

/// The row of changes of an output with a number.
fn change<'a>(found: &'a serde_json::Value, output: &str, parameter: &str) -> &'a serde_json::Value {
    let rows = found["changes"].as_array().expect("changes");
    let is_it = |row: &&serde_json::Value| row["output"] == output && row["parameter"] == parameter;
    rows.iter().find(is_it).unwrap_or_else(|| panic!("{output} by {parameter} in {found:#}"))
}

/// A place of the spec has the derivative of a live parameter there: that of statics with two specs that differ in this number.
#[test]
fn numbers_of_the_spec_have_derivatives_by_their_places() {
    let height = "links.boom.beam.section.box.height";
    let found = json(&[
        "sensitivity",
        "two_arms",
        "--with",
        &format!("payload,{height},supports.rear_left.stiffness.2"),
        "--format",
        "json",
    ]);
    let parameters: Vec<&str> = found["parameters"]
        .as_array()
        .expect("parameters")
        .iter()
        .filter_map(|row| row["parameter"].as_str())
        .collect();
    assert!(parameters.len() == 3 && parameters.contains(&"payload") && parameters.contains(&height), "{parameters:?}");
    assert_eq!(found["change"].as_f64(), Some(0.1));
    let derivative = |output: &str| change(&found, output, height)["derivative"].as_f64().expect("a number");
    let at = |height: f64| {
        let place = folder("sensitivity");
        fs::create_dir_all(&place).expect("a folder");
        let file = place.join(format!("boom_{height}.yaml"));
        fs::write(&file, format!("extends: two_arms.yaml\nname: changed\nlinks: [{{name: boom, beam: {{section: {{box: {{height: {height:?}}}}}}}}}]\n"))
            .expect("a file");
        fs::write(file.with_file_name("two_arms.yaml"), include_str!("../../../../specs/two_arms.yaml"))
            .expect("a file");
        let found = json(&["statics", &file.to_string_lossy(), "--format", "json"]);
        found["points"].as_array().expect("points")[0]["z"].as_f64().expect("a number")
    };
    let expected = (at(0.2601) - at(0.2599)) / 2e-4;
    // Statics leaves 1e-10 of the forces, 1e-12 m, over the step.
    assert!(
        (derivative("log_centre_z") - expected).abs() < 1e-5 * expected.abs(),
        "{} {expected}",
        derivative("log_centre_z")
    );
    // A whole section: kg m² of the boom and its stiffness.
    assert!(derivative("frequency_1").is_finite() && derivative("greatest_utilisation") < 0.0);
}

#[test]
fn what_moves_what_is_drawn_and_written() {
    let place = folder("sensitivity_files");
    fs::create_dir_all(&place).expect("a folder");
    for file in ["moves.csv", "moves.svg"] {
        let file = place.join(file);
        let output =
            crane(&["sensitivity", "loader_tipping", "--hold", "column_psi=120deg", "-o", &file.to_string_lossy()]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let printed = text(&output.stdout);
        assert!(printed.contains("tipping_margin") && printed.contains('█'), "{printed}");
    }
    let csv = fs::read_to_string(place.join("moves.csv")).expect("a table");
    assert!(csv.starts_with("parameter,value,unit,change,load_centre_x [m]") && csv.lines().count() == 2, "{csv}");
    let svg = fs::read_to_string(place.join("moves.svg")).expect("a chart");
    assert!(svg.starts_with("<svg") && svg.contains("tipping_margin"), "{svg}");
}

/// A foot that lifts within the change is named.
#[test]
fn what_a_whole_change_does_beyond_is_a_caution() {
    let output = crane(&[
        "sensitivity",
        "loader_tipping",
        "--hold",
        "column_psi=90deg",
        "--hold",
        "extension_x=1.5",
        "--hold",
        "boom_psi=40deg",
        "--hold",
        "jib_psi=-40deg",
        "--set",
        "load=2500",
        "--change",
        "20%",
    ]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let printed = text(&output.stdout);
    assert!(printed.contains("caution: with load at 3000 kg"), "{printed}");
}

#[test]
fn what_cannot_be_answered_is_said() {
    for (arguments, title, help) in [
        (
            &["double_pendulum"][..],
            "double_pendulum has no live parameters",
            "--with links.boom.beam.section.box.height",
        ),
        (&["knuckle_boom", "--of", "hook"], "there is no output `hook`", "groups: points"),
        (&["knuckle_boom", "--with", "pay"], "knuckle_boom has no live parameter `pay`", "payload [kg]"),
        (&["knuckle_boom", "--with", "links.knuckel.mass"], "there is no `knuckel`", "did you mean `knuckle`?"),
        (&["knuckle_boom", "--with", "parameters.payload.value"], "is a live parameter", "write its name, `payload`"),
        (&["knuckle_boom", "--with", "links.knuckle"], "`links.knuckle` is not a number", "place of one number"),
        (&["cantilever", "--with", "links.beam.beam.sections"], "`links.beam.beam.sections` cannot change", "fixed"),
        (&["knuckle_boom", "--change", "0"], "0", "such as 10%"),
        (&["knuckle_boom", "-o", "moves.txt"], "cannot write moves.txt", ".csv"),
    ] {
        let output = crane(&[&["sensitivity"], arguments].concat());
        let said = text(&output.stderr);
        assert!(!output.status.success() && said.contains(title) && said.contains(help), "{arguments:?}: {said}");
    }
}
