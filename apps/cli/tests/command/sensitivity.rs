//! What moves what: by parameters, by places of the spec, and what cannot be answered.

use std::fs;

use crane_codegen::SourceFile;
use crane_codegen::compile::check;
use serde_json::Value;

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
        let path = folder("sensitivity");
        fs::create_dir_all(&path).expect("a folder");
        let file = path.join(format!("boom_{height}.yaml"));
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
    let path = folder("sensitivity_files");
    fs::create_dir_all(&path).expect("a folder");
    for file in ["moves.csv", "moves.svg"] {
        let file = path.join(file);
        let output =
            crane(&["sensitivity", "loader_tipping", "--hold", "column_psi=120deg", "-o", &file.to_string_lossy()]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let printed = text(&output.stdout);
        assert!(printed.contains("tipping_margin") && printed.contains('█'), "{printed}");
    }
    let csv = fs::read_to_string(path.join("moves.csv")).expect("a table");
    assert!(csv.starts_with("parameter,value,unit,change,load_centre_x [m]") && csv.lines().count() == 2, "{csv}");
    let svg = fs::read_to_string(path.join("moves.svg")).expect("a chart");
    assert!(svg.starts_with("<svg") && svg.contains("tipping_margin"), "{svg}");
}

/// Of the peak, the extremes, the end and the integral of columns; the others are central differences of the same runs with another payload.
#[test]
fn what_moves_a_run_is_the_difference_of_runs() {
    const OUTPUTS: &str = "knuckle_theta_drive_torque.peak,load_centre_x.maximum,load_centre_z.minimum,\
                           load_centre_z.final,main_boom_theta_drive_torque.integral,load_centre_vz.integral";
    let run = |more: &[&str]| {
        let run =
            ["sensitivity", "knuckle_boom", "--run", "--duration", "2", "--interval", "0.01", "--tolerance", "1e-10"];
        json(&[&run[..], &["--of", OUTPUTS, "--format", "json"], more].concat())
    };
    let value = |found: &Value, index: usize| found["outputs"][index]["value"].as_f64().expect("a number");
    let (found, less, more) = (run(&[]), run(&["--set", "payload=799"]), run(&["--set", "payload=801"]));
    let outputs: Vec<&str> = OUTPUTS.split(',').collect();
    for (index, output) in outputs.iter().enumerate() {
        let own = change(&found, output, "payload")["derivative"].as_f64().expect("a number");
        let expected = 0.5 * (value(&more, index) - value(&less, index));
        // Of a pose at rest that hangs straight, and of extremes that lie between two results.
        assert!((own - expected).abs() < 1e-3 * expected.abs() + 1e-7, "{output}: {own:e} for {expected:e}");
        let change = change(&found, output, "payload")["change"].as_f64().expect("a number");
        assert!((change / (80.0 * own) - 1.0).abs() < 1e-12, "{output}: {change:e} for 80 kg");
    }
    assert_eq!(found["outputs"][4]["unit"], "N m s");
    // The integral of a velocity is the way from the place at rest, to the error of the trapezoidal rule.
    let rest = json(&["statics", "knuckle_boom", "--format", "json"]);
    let is_it = |row: &&Value| row.as_object().is_some_and(|row| row.values().any(|value| value == "load_centre"));
    let point = rest["points"].as_array().and_then(|rows| rows.iter().find(is_it)).expect("a point");
    let way = value(&found, 3) - point["z"].as_f64().expect("a number");
    assert!(way.abs() > 1e-3 && (value(&found, 5) - way).abs() < 1e-4, "{} for {way}", value(&found, 5));
    assert!(found["outputs"][0]["place"].as_str().is_some_and(|place| place.starts_with("at ")));
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
        (&["cantilever", "--with", "links.beam.beam.sections"], "cannot change: ", "small steps"),
        (
            &["knuckle_boom", "--run", "--of", "load_centre_z.mean"],
            "there is no `mean` of a column",
            "`load_centre_z.peak`",
        ),
        (
            &["knuckle_boom", "--run", "--of", "load_center_z"],
            "no column `load_center_z`",
            "did you mean `load_centre_z`?",
        ),
        (&["knuckle_boom", "--run", "--of", "drive_work.final"], "`drive_work` has no derivatives", "another column"),
        (&["knuckle_boom", "--run", "--duration", "-1"], "`--duration -1` is not a valid", "positive number"),
        (&["knuckle_boom", "--run", "--largest-load"], "cannot be used with", "Usage"),
        (&["knuckle_boom", "--duration", "3"], "--run", "Usage"),
        (
            &["two_arms", "--with", "links.boom.beam.material.E"],
            "`links.boom.beam.material` is `steel`",
            "`materials.steel.E`",
        ),
        (&["two_arms", "--with", "run.duration"], "`run.duration` moves nothing", "crane at rest"),
        (&["two_arms", "--with", "boom"], "no live parameter `boom`", "by their places"),
        (&["two_arms", "--largest-load"], "no live parameters besides the load", "places"),
        (&["loader_tipping", "--largest-load", "--with", "load"], "`load` is the load, which is found", "--load"),
        (&["knuckle_boom", "--change", "0"], "0", "such as 10%"),
        (&["knuckle_boom", "-o", "moves.txt"], "cannot write moves.txt", ".csv"),
    ] {
        let output = crane(&[&["sensitivity"], arguments].concat());
        let said = text(&output.stderr);
        assert!(!output.status.success() && said.contains(title) && said.contains(help), "{arguments:?}: {said}");
    }
}

/// Numbers of a spec have the units that their messages name; the places are those of shipped cranes. All keys: `units` of the compiler's tests.
#[test]
fn numbers_of_the_spec_have_their_units() {
    let spec = |name: &str| {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../specs/");
        SourceFile::new(name, std::fs::read_to_string(format!("{path}{name}.yaml")).expect("a spec"))
    };
    for (name, place, unit) in [
        ("two_arms", "drives.boom_psi.stiffness", "N m/rad"),
        ("two_arms", "links.boom.beam.length", "m"),
        ("two_arms", "materials.steel.E", "Pa"),
        ("two_arms", "gravity.2", ""),
        ("cantilever", "materials.steel.density", "kg/m³"),
        ("loader_tipping", "supports.left.at.1", "m"),
        ("loader_tipping", "links.nowhere.mass", ""),
    ] {
        assert_eq!(check(&spec(name)).unwrap().unit_at(place), unit, "{name}: {place}");
    }
}

/// The largest load of a pose is that of the chart, and its derivative that of two charts.
#[test]
fn the_largest_load_is_that_of_the_chart() {
    let pose = ["--hold", "column_psi=90deg", "--hold", "boom_psi=40deg", "--tipping", "0.2"];
    let found = json(
        &[
            &[
                "sensitivity",
                "loader_tipping",
                "--largest-load",
                "--with",
                "links.boom.beam.length,supports.left.at.1",
                "--format",
                "json",
            ],
            &pose[..],
        ]
        .concat(),
    );
    let of = &found["largest_load"];
    assert_eq!((of["parameter"].as_str(), of["unit"].as_str()), (Some("load"), Some("kg")), "{of:#}");
    let out = folder("sensitivity_chart");
    let chart = json(&[
        "envelope",
        "loader_tipping",
        "--range",
        "column_psi=90deg",
        "--range",
        "boom_psi=40deg",
        "--tipping",
        "0.2",
        "--format",
        "json",
        "--out",
        &out.to_string_lossy(),
    ]);
    let least = &chart["least"];
    let number = |value: &Value| value.as_f64().expect("a number");
    // Loads of a chart are exact to 1e-6; poses that are reached in strides differ by that of Newton's method.
    assert!((number(&of["load"]) - number(&least["load"])).abs() < 3e-6 * number(&of["load"]), "{of:#} {least:#}");
    assert!((number(&of["radius"]) - number(&least["radius"])).abs() < 1e-5, "{of:#} {least:#}");
    assert_eq!((&of["limit"], &of["of"]), (&least["limit"], &least["of"]));
    let length = change(&found, "largest_load", "links.boom.beam.length");
    assert!(number(&length["derivative"]) < 0.0 && length["error"].is_null(), "{length:#}");
    let printed = crane(
        &[&["sensitivity", "loader_tipping", "--largest-load", "--with", "links.boom.beam.length"], &pose[..]].concat(),
    );
    let printed = text(&printed.stdout);
    assert!(
        printed.contains("limited by") && printed.contains("at a radius of") && printed.contains("largest_load"),
        "{printed}"
    );
}

/// A number that cannot be a live parameter: differences, marked as such.
#[test]
fn fixed_numbers_change_by_differences() {
    let path = folder("sensitivity_fixed");
    fs::create_dir_all(&path).expect("a folder");
    fs::write(path.join("two_arms.yaml"), include_str!("../../../../specs/two_arms.yaml")).expect("a file");
    let file = path.join("solid.yaml");
    let solid = "extends: two_arms.yaml\nname: solid\nlinks: [{name: boom, beam: {section: {solid: {height: 0.2, width: 0.1}}}}]\n";
    fs::write(&file, solid).expect("a file");
    let height = "links.boom.beam.section.solid.height";
    let with = format!("payload,{height}");
    let found = json(&["sensitivity", &file.to_string_lossy(), "--with", &with, "--format", "json"]);
    let methods: Vec<(&str, &str)> = found["parameters"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|row| Some((row["parameter"].as_str()?, row["method"].as_str()?)))
        .collect();
    assert!(methods.contains(&(height, "differences")) && methods.contains(&("payload", "exact")), "{methods:?}");
    let row = change(&found, "boom_equivalent_stress", height);
    let [derivative, error] = ["derivative", "error"].map(|key| row[key].as_f64().expect("a number"));
    // Bending stress falls with the square of the height, 2/h, less what the weight adds.
    let stress =
        found["outputs"].as_array().into_iter().flatten().find(|row| row["output"] == "boom_equivalent_stress");
    let stress = stress.and_then(|row| row["value"].as_f64()).expect("a stress");
    assert!(derivative < -stress / 0.2 && error < 1e-4 * derivative.abs(), "{row:#}");
    let cautions = found["cautions"].to_string();
    assert!(cautions.contains("differences of whole cranes"), "{cautions}");
}

/// Bars of a page are the numbers of the command that it names.
#[test]
fn what_moves_what_on_a_page_is_what_the_command_prints() {
    let path = folder("sensitivity_page");
    fs::create_dir_all(&path).expect("a folder");
    let page = path.join("two_arms.html");
    let output = crane(&[
        "report",
        "two_arms",
        "--sensitivity",
        "--duration",
        "0.1",
        "--output",
        "0.05",
        "-o",
        &page.to_string_lossy(),
    ]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let page = fs::read_to_string(&page).expect("a page");
    let data = page.split("id=\"data\">").nth(1).and_then(|rest| rest.split("</script>").next()).expect("data");
    let data: Value = serde_json::from_str(data).expect("JSON");
    let moves = &data["moves"];
    let command = moves["command"].as_str().expect("a command");
    let arguments: Vec<&str> = command.split(' ').skip(1).chain(["--format", "json"]).collect();
    let found = json(&arguments);
    let mut compared = 0;
    for output in moves["outputs"].as_array().expect("outputs") {
        for bar in output["bars"].as_array().expect("bars") {
            let name = output["output"].as_str().expect("a name");
            let row = change(&found, name, bar["number"].as_str().expect("a number"));
            assert_eq!(bar["relative"], row["relative"], "{name}: {bar:#} {row:#}");
            compared += 1;
        }
    }
    assert!(compared > 10, "{moves:#}");
}
