//! Every warning has a spec in `tests/implausible` that triggers it and a snapshot of its message; no crane that is shipped
//! or documented triggers one.

use std::collections::BTreeSet;
use std::path::Path;

use crane_codegen::diagnostic::CATALOGUE;
use crane_codegen::{Diagnostics, SourceFile, build, check, read};

/// Warnings about a spec without mistakes.
fn warnings(name: &str, text: &str) -> Diagnostics {
    let source = SourceFile::new(name, text);
    let checked = read(&source).and_then(check).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
    checked.warnings
}

/// Codes of the warnings about a spec, in the order of the file.
fn codes(diagnostics: &Diagnostics) -> Vec<&'static str> {
    diagnostics.mistakes().iter().map(|warning| warning.code).collect()
}

/// Files of a folder of this repository, by name, in order; only YAML.
fn specs(folder: &str) -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut specs: Vec<_> = std::fs::read_dir(folder)
        .expect("a folder of specs")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "yaml"))
        .map(|path| {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            // Merged with the spec that it extends.
            (name, build::open(&path).unwrap_or_else(|failure| panic!("{failure}")).text)
        })
        .collect();
    specs.sort();
    specs
}

#[test]
fn each_implausible_spec_gives_its_warning() {
    let mut shown = BTreeSet::new();
    for (name, text) in specs("tests/implausible") {
        let diagnostics = warnings(&format!("{name}.yaml"), &text);
        insta::with_settings!({ prepend_module_to_snapshot => false, snapshot_path => "implausible_messages", omit_expression => true }, {
            insta::assert_snapshot!(name.as_str(), diagnostics.to_string());
        });
        if let Some((code, _)) = name.split_once('_').filter(|(code, _)| code.starts_with('W')) {
            assert!(codes(&diagnostics).iter().all(|other| *other == code), "{name}: {diagnostics}");
            assert!(!diagnostics.is_empty(), "{name} is plausible");
            shown.insert(code.to_owned());
        }
    }
    for rule in CATALOGUE.iter().filter(|rule| rule.code.starts_with('W')) {
        assert!(shown.contains(rule.code), "no implausible spec for {}: {}", rule.code, rule.about);
    }
}

/// A pad that is exact in one direction may hold the twist as stiffly as the other one.
#[test]
fn a_pad_that_is_exact_in_one_direction_may_hold_the_twist() {
    let text = include_str!("implausible/W063_order_of_pads.yaml");
    let free = text.replace("front: {stiffness: [2e7, 2e6, 2e7]}", "front: {exact: [z], stiffness: [2e7, 0, 2e7]}");
    assert_ne!(free, text);
    assert_eq!(codes(&warnings("free.yaml", &free)), Vec::<&str>::new());
}

#[test]
fn mistakes_of_unit_are_noticed() {
    let spec = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/own-crane/crane.yaml"));
    let spec = spec.expect("the example").replace("\r\n", "\n");
    let section = "{height: 200 mm, width: 150 mm, thickness: 6 mm}";
    let in_mm = "{height: 200, width: 150, thickness: 6}";
    for (slip, replaced, expected) in [
        ("E in GPa", &[("E: 210 GPa", "E: 210")][..], &["W001"][..]),
        ("E in MPa", &[("E: 210 GPa", "E: 210000")], &["W001"]),
        ("lengths in mm", &[("length: 4", "length: 4000"), (section, in_mm)], &["W005", "W004"]),
        ("section in mm", &[(section, in_mm)], &["W004"]),
        ("motion in degrees", &[("to: 45 deg", "to: 45")], &["W008"]),
        ("rotation in degrees", &[("{x: 90 deg}", "{x: 90}")], &["W008"]),
        ("density in t/m³", &[("density: 7850", "density: 7.85")], &["W003"]),
        ("G above E", &[("G: 81 GPa", "G: 300 GPa")], &["W002"]),
        ("payload in t", &[("value: 300", "value: 0.3")], &["W010"]),
    ] {
        let mut text = spec.clone();
        for (from, to) in replaced {
            assert_eq!(text.matches(from).count(), 1, "{slip}: `{from}` in the example");
            text = text.replace(from, to);
        }
        assert_eq!(codes(&warnings(slip, &text)), expected, "{slip}");
    }
}

#[test]
fn shipped_and_described_cranes_are_plausible() {
    let mut cranes: Vec<(String, String)> = specs("../specs");
    cranes.extend(specs("../examples/own-crane"));
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let pages = std::fs::read_dir(docs.join("manual")).expect("the manual").map(|entry| entry.expect("a page").path());
    let pages = pages.filter(|page| page.extension().is_some_and(|extension| extension == "md"));
    for page in pages.chain([docs.join("SPEC.md"), docs.join("../README.md")]) {
        let text = std::fs::read_to_string(&page).expect("a page");
        let blocks = text.split("```yaml\n").skip(1).filter_map(|rest| rest.split("```").next());
        let whole = blocks.filter(|block| block.contains("format:"));
        cranes.extend(whole.map(|block| (page.display().to_string(), block.to_owned())));
    }
    assert!(cranes.len() > 10, "the folders were searched");
    for (name, text) in cranes {
        let diagnostics = warnings(&name, &text);
        assert!(diagnostics.is_empty(), "{diagnostics}");
    }
}

#[test]
fn a_published_robot_that_misses_the_triangle_inequality_passes() {
    // Link 3 of the PUMA 560 [Armstrong, Khatib, Burdick 1986]: 0.086 kg m² exceeds 0.066 + 0.0125.
    let text = "format: 1\nname: puma\nlinks:\n  - name: forearm\n    joint: revolute\n    mass: 4.8\n    \
        com: [0, -0.0141, 0.0702]\n    inertia: {Ixx: 0.066, Iyy: 0.086, Izz: 0.0125}\n";
    assert_eq!(codes(&warnings("puma", text)), ["W011"]);
}

/// The value to which a parameter is set is checked like the one in the spec.
#[test]
fn values_of_parameters_are_looked_at() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/knuckle_boom.yaml"));
    let source = SourceFile::new("knuckle_boom.yaml", text.expect("a spec"));
    let with = |value| {
        let checked = crane_codegen::compile::check(&source).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        codes(&checked.warnings_with(&[("payload", value)]))
    };
    assert_eq!(with(800.0), [""; 0]);
    assert_eq!(with(0.3), ["W010"]);
    assert_eq!(with(8e5), ["W010"]);
}

/// An angle that is written in degrees is one; the same number set is in radians, and another parameter that is set does not matter.
#[test]
fn angles_that_are_set_are_in_radians() {
    let text = "format: 1\nname: arm\nparameters: {load: {value: 10, unit: kg}, tilt: {value: 400 deg}}\nlinks:\n  \
        - {name: arm, joint: {revolute: {axis: y}}, mass: load, com: [1, 0, 0]}\n\
        drives: [{coordinate: arm_theta, stiffness: 1e5, motion: {hold: tilt}}]\n";
    let source = SourceFile::new("arm.yaml", text);
    let with = |set: &[(&str, f64)]| {
        let checked = crane_codegen::compile::check(&source).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        codes(&checked.warnings_with(set))
    };
    assert_eq!(with(&[]), [""; 0]);
    assert_eq!(with(&[("load", 11.0)]), [""; 0]);
    assert_eq!(with(&[("tilt", 45.0)]), ["W008"]);
}

/// Beyond which beam a point is depends on the beam that it names, not on the first one.
#[test]
fn a_point_is_within_its_own_beam() {
    let beam = |name: &str, length: f64| {
        format!(
            "  - {{name: {name}, joint: {{revolute: {{axis: y}}}}, beam: {{length: {length}, sections: rigid, material: steel, section: {{box: {{height: 0.3, width: 0.2, thickness: 0.008}}}}}}}}\n"
        )
    };
    let text = format!(
        "format: 1\nname: two\nmaterials: {{steel: {{E: 2.1e11, G: 8.1e10, density: 7850}}}}\nlinks:\n{}{}\
         loop_joints: [{{name: h, from: {{at: [3.5, 0, 0]}}, to: {{link: long, at: [2.5, 0, 0]}}, joint: ball}}]\n",
        beam("short", 1.0),
        beam("long", 4.0)
    );
    assert!(!codes(&warnings("two", &text)).contains(&"W047"));
}
