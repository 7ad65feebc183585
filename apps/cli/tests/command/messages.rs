//! What the command says besides results: colours, JSON, severity, quiet.

use std::{
    ffi::OsString,
    fs,
    io::{Read, pipe},
    process::{Command, Output},
};

use crane_cli::{Console, Registry};
use serde_json::Value;

use super::{crane, folder, json, refused, text};

/// A spec with a warning: a length in mm.
const WARNED: &str = "../../codegen/tests/implausible/W005_length_in_mm.yaml";
/// A spec with a mistake.
const BAD: &str = "../../codegen/tests/bad/E010_misspelt_key.yaml";

#[test]
fn errors_are_json_where_json_is_asked_for() {
    for (arguments, code, words) in [
        (&["statics", "no_crane", "--format", "json"][..], 2, "no crane `no_crane`"),
        (&["statics", "--format=json", "--colour"], 2, "--colour"),
        (&["statics", BAD, "--format", "json"], 1, "[E010]"),
    ] {
        let output = crane(arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        let error: Value =
            serde_json::from_slice(&output.stderr).unwrap_or_else(|_| panic!("{}", text(&output.stderr)));
        assert!(error["error"]["message"].as_str().is_some_and(|message| message.contains(words)), "{error}");
        assert_eq!(error["error"]["code"], code);
    }
    let output = crane(&["statics", BAD, "--format", "json"]);
    let error: Value = serde_json::from_slice(&output.stderr).expect("JSON");
    assert_eq!(error["error"]["diagnostics"][0]["code"], "E010");
}

/// Negative values of options are read as such, so that the answer is about the value.
#[test]
fn negative_values_are_values() {
    for (arguments, words) in [
        (&["fatigue", "cantilever", "--cycles", "-5", "--category", "71MPa"][..], "above 0"),
        (&["envelope", "cantilever", "--load-factor", "-1"], "above 0"),
        (&["statics", "cantilever", "--bend-limit", "-1"], "--bend-limit"),
        (&["fatigue", "cantilever", "--cycles", "1", "--category", "-71MPa"], "behind `=`"),
        (&["fatigue", "cantilever", "--cycles", "1", "--category=-71MPa"], "above 0"),
    ] {
        let output = crane(arguments);
        let error = text(&output.stderr);
        assert!(error.contains(words) && !error.contains("-- -"), "{arguments:?}: {error}");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn scripts_fail_on_what_they_name() {
    let code = |arguments: &[&str]| crane(arguments).status.code();
    assert_eq!(code(&["check", WARNED]), Some(0));
    assert_eq!(code(&["check", WARNED, "--fail-on", "warning"]), Some(3));
    assert_eq!(code(&["check", WARNED, "--fail-on", "caution"]), Some(0));
    // A load beyond what the crane carries.
    let heavy = ["strength", "eight_link_flexible", "--set", "load_mass=4000", "--bend-limit", "0.01"];
    assert_eq!(code(&heavy), Some(0));
    assert_eq!(code(&[&heavy[..], &["--fail-on", "warning,caution"]].concat()), Some(3));
    let output = crane(&["check", WARNED, "--quiet"]);
    assert!(output.stderr.is_empty() && output.status.success());
}

/// Commands that one process runs share no manner, no warnings, no cautions and no files that they have read.
#[test]
fn a_command_says_the_same_after_others_as_alone() {
    let out = folder("one_process");
    fs::create_dir_all(&out).expect("a folder");
    let warned = out.join("warned.yaml");
    let warned = warned.to_str().expect("a path");
    let commands = [
        (3, &["info", warned, "--format", "json", "--fail-on", "warning"][..]),
        (0, &["info", warned]),
        (3, &["statics", warned, "--fail-on", "caution"]),
        (0, &["info", "eight_link_rigid", "--fail-on", "warning,caution"]),
        // Over a file that the others have read.
        (0, &["explain", "eight_link_rigid", "--svg", warned]),
    ];
    let copy = || fs::copy(WARNED, warned).expect("a spec");
    copy();
    let alone = commands.map(|(_, arguments)| crane(arguments));
    copy();
    for ((code, arguments), Output { status, stdout, stderr }) in commands.into_iter().zip(alone) {
        let (mut messages, end) = pipe().expect("a pipe");
        let words = [&["crane"], arguments].concat().iter().map(OsString::from).collect();
        let (mut results, mut said) = (Vec::new(), Vec::new());
        let registry = Registry::new(crane_specs::SPECS, Vec::new());
        let ended = crane_cli::run(registry, Console::new(words, end, [false; 2]), &mut results);
        messages.read_to_end(&mut said).expect("the command has ended");
        assert_eq!((Some(ended.into()), Some(code)), (status.code(), status.code()), "{arguments:?}");
        assert_eq!([results, said].map(|bytes| text(&bytes)), [stdout, stderr].map(|bytes| text(&bytes)));
    }
}

#[test]
fn colours_are_for_terminals_and_those_who_force_them() {
    let run = |variables: &[(&str, &str)]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        command.args(["check", BAD]).env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
        text(&command.envs(variables.iter().copied()).output().expect("the command starts").stderr)
    };
    assert!(!run(&[]).contains('\x1b'));
    assert!(run(&[("CLICOLOR_FORCE", "1")]).contains("\x1b["));
    assert!(!run(&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]).contains('\x1b'));
}

#[test]
fn several_specs_are_checked_at_once() {
    let output = crane(&["check", "knuckle_boom", BAD, "cantilever"]);
    assert_eq!(output.status.code(), Some(1));
    let report = text(&output.stdout);
    assert!(report.contains("knuckle_boom: valid") && report.contains("cantilever: valid"), "{report}");
    assert!(text(&output.stderr).contains("error[E010]"));
    let output = crane(&["check", "knuckle_boom", BAD, "--format", "json"]);
    let all: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!([&all[0]["valid"], &all[1]["valid"]], [true, false]);
}

#[test]
fn help_offers_only_what_a_command_does() {
    let help = |command: &str| text(&crane(&[command, "--help"]).stdout);
    assert!(!help("run").contains("--ensemble") && help("simulate").contains("--ensemble"));
    assert!(help("compare").contains("otherwise bdf"));
    assert!(help("compare").contains("--input"));
    assert!(help("run").contains("--interval") && !help("run").contains("--output"));
    refused(&["run", "knuckle_boom", "--ensemble", "t.csv"], &["--ensemble"]);
}

#[test]
fn angles_are_set_in_degrees_too() {
    let out = folder("angles");
    fs::create_dir_all(&out).expect("a folder");
    let spec = out.join("arm.yaml");
    let text = "format: 1\nname: arm\nparameters: {lift: {value: 0.1, unit: rad}}\nlinks:\n  - {name: arm, joint: revolute, mass: 10, \
                com: [1, 0, 0]}\ndrives: [{coordinate: arm_psi, stiffness: 1e5, motion: {hold: lift}}]\n";
    fs::write(&spec, text).expect("a spec");
    let pose = |setting: &str| {
        let found = json(&["statics", spec.to_str().expect("a path"), "--set", setting, "--format", "json"]);
        found["pose"].clone()
    };
    assert_eq!(pose("lift=30deg"), pose("lift=0.5235987755982988"));
}

#[test]
fn examples_are_printed_and_valid() {
    let list = text(&crane(&["example"]).stdout);
    assert!(list.contains("loader_crane") && list.contains("knuckle_boom"), "{list}");
    refused(&["example", "loader_cran"], &["did you mean `loader_crane`?"]);
    let out = folder("example");
    fs::create_dir_all(&out).expect("a folder");
    for name in ["loader_crane", "parallel_harvester", "telescopic_loader", "knuckle_boom", "eight_link_hydraulic"] {
        let printed = crane(&["example", name]);
        let spec = out.join(format!("{name}.yaml"));
        fs::write(&spec, &printed.stdout).expect("a spec");
        let spec = spec.to_str().expect("a path");
        let checked = crane(&["check", spec, "--fail-on", "warning"]);
        assert!(checked.status.success(), "{name}: {}", text(&checked.stderr));
        if ["loader_crane", "parallel_harvester", "telescopic_loader"].contains(&name) {
            let found = json(&["statics", spec, "--format", "json"]);
            let steps = found["cranes"][0]["newton_steps"].as_u64().expect("a count");
            assert!(found["stable"] == true && steps <= 5, "{steps} Newton steps");
        }
    }
}

#[test]
fn explain_and_its_picture_number_coordinates_alike() {
    let out = folder("numbers");
    let svg = out.join("chain.svg");
    let output = crane(&["explain", "eight_link_flexible", "--svg", svg.to_str().expect("a path")]);
    let report = text(&output.stdout);
    let line = report.lines().find(|line| line.contains(" boom_psi ")).expect("a coordinate").trim_start();
    let number = line.split_whitespace().next().expect("a number");
    let picture = fs::read_to_string(&svg).expect("a picture");
    let cells: Vec<&str> = picture.split("</text>").map(|text| text.rsplit('>').next().unwrap_or_default()).collect();
    let column = cells.iter().position(|cell| *cell == "boom_psi").expect("a row");
    assert_eq!(cells[column - 1], number);
    assert!(!report.contains("unsimplified"));
    assert!(text(&crane(&["explain", "double_pendulum", "--operations"]).stdout).contains("unsimplified"));
}

/// One MB is less than any process has.
#[cfg(target_os = "linux")]
#[test]
fn a_command_ends_before_it_takes_all_memory() {
    let run = |limit: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        let out = folder("little_memory");
        command.args(["simulate", "--duration", "1000", "--out"]).arg(out).env("CRANE_MEMORY", limit);
        command.output().expect("the command starts")
    };
    let output = run("1");
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.contains("MB of memory") && message.contains("are more than the 1 MB of CRANE_MEMORY"),
        "{message}"
    );
    let output = run("much");
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
}
