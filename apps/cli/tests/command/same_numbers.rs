//! One key, one number: what several commands print of one pose at rest is equal.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;

use super::{crane, folder, json, text};

/// Two beams of different strength: the section that is used most is not that with the greatest stress.
const TWO: &str = "format: 1
name: two_beams
parameters: {payload: {value: 200, unit: kg}}
materials:
  strong: {E: 2.1e11, G: 8e10, density: 7850, yield_stress: 900e6}
  weak: {E: 7e10, G: 2.6e10, density: 2700, yield_stress: 60e6}
links:
  - {name: boom, joint: {revolute: {axis: y}}, beam: {length: 3, sections: 2, material: strong, section: {box: {height: 0.1, width: 0.08, thickness: 0.005}}}}
  - {name: jib, beam: {length: 2, sections: 2, material: weak, section: {box: {height: 0.12, width: 0.1, thickness: 0.005}}}}
  - {name: load, mass: payload, com: [0, 0, 0]}
drives: [{coordinate: boom_theta, stiffness: 1e8, damping: 1e6, motion: {hold: 0}}]
points: [{name: tip, link: load, at: [0, 0, 0]}]
run: {duration: 0.02, output: 0.01}
";

/// The numbers of a pose by their keys; a second command must print the same.
#[derive(Default)]
struct Numbers(BTreeMap<String, (f64, &'static str)>);

impl Numbers {
    fn add(&mut self, crane: &str, from: &'static str, key: &str, value: f64) {
        let (known, other) = *self.0.entry(key.to_owned()).or_insert((value, from));
        // Commands that read the state of a run, or solve statics again, differ by the tolerance of statics.
        let close = (value - known).abs() <= 1e-7 * known.abs().max(1e-3);
        assert!(close, "{key} of {crane} is {known} by {other} and {value} by {from}");
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64()
}

#[test]
fn several_commands_print_one_number() {
    let out = folder("same_numbers");
    fs::create_dir_all(&out).expect("a folder");
    let two = out.join("two_beams.yaml");
    fs::write(&two, TWO).expect("a file");
    let two = two.to_str().expect("a path");
    let mut shared = 0;
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../specs/examples/telescopic_loader.yaml");
    for name in [two, example, "two_arms", "eight_link_hydraulic"] {
        let mut found = Numbers::default();
        let strength = json(&["strength", name, "--format", "json"]);
        for key in ["greatest_utilisation", "greatest_equivalent_stress", "tipping_margin"] {
            if let Some(value) = number(&strength[key]) {
                found.add(name, "strength", key, value);
            }
        }
        let modes = json(&["modes", name, "--format", "json"]);
        for (index, mode) in modes["undamped"].as_array().into_iter().flatten().take(3).enumerate() {
            found.add(name, "modes", &format!("frequency_{}", index + 1), number(&mode["frequency"]).expect("Hz"));
        }
        let results = out.join("run");
        let run =
            ["simulate", name, "--duration", "0.02", "--interval", "0.01", "--out", results.to_str().expect("a path")];
        let output = crane(&run);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let file = fs::read_dir(&results).expect("results").filter_map(Result::ok).map(|entry| entry.path());
        let file = file.filter(|path| path.extension().is_some_and(|end| end == "csv")).collect::<Vec<_>>();
        let csv = fs::read_to_string(&file[0]).expect("a table");
        let mut lines = csv.lines();
        let (header, first) = (lines.next().expect("columns"), lines.next().expect("the start"));
        for (column, value) in header.split(',').zip(first.split(',')) {
            let key = column.split(" [").next().expect("a name");
            found.add(name, "simulate", key, value.parse().expect("a number"));
        }
        let before = found.0.len();
        let mut more = 0;
        let sensitivity = json(&["sensitivity", name, "--all", "--format", "json"]);
        for output in sensitivity["outputs"].as_array().into_iter().flatten() {
            let (key, value) = (output["output"].as_str().expect("a name"), number(&output["value"]));
            found.add(name, "sensitivity", key, value.expect("a value"));
            more += 1;
        }
        // Outputs that no other command has are deflections, and stresses beam by beam.
        shared += more - (found.0.len() - before);
        fs::remove_dir_all(&results).expect("the folder of this test");
    }
    assert!(shared > 40, "{shared} numbers are printed by more than one command");
}
