//! Cranes of YAML files, without a crate of their own.

use std::{
    env, fs,
    path::PathBuf,
    process::{Command, Output},
};

/// Where cargo builds quickly.
const UNOPTIMISED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/unoptimised");

/// The command, with compiled cranes kept in a folder for this test.
fn crane(arguments: &[&str]) -> Output {
    let cache = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("own_cranes");
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
    command.args(arguments).current_dir(UNOPTIMISED).env("CRANE_CACHE", cache).output().expect("the command starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A shipped spec, changed, as a file.
fn spec(name: &str, from: &str, to: &str) -> String {
    let shipped = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../specs/knuckle_boom.yaml");
    let shipped = fs::read_to_string(shipped).expect("a spec");
    assert!(shipped.contains(from));
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&file, shipped.replacen(from, to, 1)).expect("a file");
    file.to_str().expect("a path").to_owned()
}

#[test]
fn shipped_cranes_are_checked_explained_and_generated_by_name() {
    let checked = crane(&["check", "cantilever"]);
    let report = text(&checked.stdout);
    assert!(report.starts_with("cantilever: valid; ") && report.contains(" 24 coordinates"), "{report}");
    assert!(text(&crane(&["explain", "cantilever"]).stdout).starts_with("cantilever: "));
    let module = crane(&["generate", "double_pendulum"]);
    assert!(text(&module.stdout).contains("from double_pendulum.yaml; do not edit."), "{}", text(&module.stderr));
    for command in ["check", "explain", "generate"] {
        let unknown = crane(&[command, "cantilevr"]);
        assert_eq!(unknown.status.code(), Some(2), "{command}");
        assert!(text(&unknown.stderr).contains("did you mean `cantilever`?"), "{}", text(&unknown.stderr));
    }
}

#[test]
fn a_valid_spec_is_confirmed_and_mistakes_are_drawn() {
    let sound = crane(&["check", &spec("sound.yaml", "420", "421")]);
    assert!(sound.status.success(), "{}", text(&sound.stderr));
    assert!(text(&sound.stdout).starts_with("knuckle_boom: valid; 5 bodies, 4 coordinates"), "{}", text(&sound.stdout));
    for command in ["check", "statics", "run", "report"] {
        let wrong = crane(&[command, &spec("wrong.yaml", "mass: 420", "mass: -420")]);
        let message = text(&wrong.stderr);
        assert_eq!(wrong.status.code(), Some(1), "{command}: {message}");
        assert!(message.contains("error[E031]") && message.contains("wrong.yaml:"), "{command}: {message}");
    }
    let picture = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("explained.svg");
    let explained =
        crane(&["explain", &spec("explained.yaml", "420", "421"), "--svg", picture.to_str().expect("a path")]);
    assert!(text(&explained.stdout).contains("main_boom") && text(&explained.stdout).contains("left out"));
    assert!(fs::read_to_string(picture).is_ok_and(|svg| svg.starts_with("<svg") && svg.contains(">extension_x<")));
    let missing = crane(&["check", "no_such.yaml"]);
    assert_eq!(missing.status.code(), Some(1));
    assert!(text(&missing.stderr).contains("no_such.yaml"), "{}", text(&missing.stderr));
}

#[test]
fn warnings_are_drawn_and_end_a_strict_command() {
    let light = spec("light.yaml", "value: 800", "value: 0.8");
    let warned = "warning[W010]: the mass of body `load` is 0.8 kg";
    let checked = crane(&["check", &light]);
    let message = text(&checked.stderr);
    assert!(
        checked.status.success() && message.contains(warned) && message.contains("light.yaml: 1 warning"),
        "{message}"
    );
    assert!(text(&checked.stdout).starts_with("knuckle_boom: valid"));
    // Also if a parameter is set to such a value.
    let set = crane(&["statics", "knuckle_boom", "--set", "payload=0.8"]);
    assert!(set.status.success() && text(&set.stderr).contains(warned), "{}", text(&set.stderr));
    assert_eq!(crane(&["statics", "knuckle_boom", "--set", "payload=0.8", "--strict"]).status.code(), Some(1));
    for command in ["check", "statics", "run"] {
        let strict = crane(&[command, "--strict", &light]);
        assert_eq!(strict.status.code(), Some(1), "{command}: {}", text(&strict.stderr));
        assert!(
            text(&strict.stderr).contains(warned) && strict.stdout.is_empty(),
            "{command}: {}",
            text(&strict.stderr)
        );
    }
}

#[test]
fn a_spec_computes_to_the_bit_what_the_shipped_crane_does() {
    // The same crane with another hash, compiled to machine code, which is kept.
    let file = spec("knuckle.yaml", "title: Planar", "title: A planar");
    let compiled = crane(&["eval", &file, "--compile", "--q", "0.1,0.2,0.3,0.4", "--v", "1,2,3,4"]);
    assert!(compiled.status.success(), "{}", text(&compiled.stderr));
    let shipped = crane(&["eval", "knuckle_boom", "--q", "0.1,0.2,0.3,0.4", "--v", "1,2,3,4"]);
    let numbers = |output: &Output| -> serde_json::Value {
        let mut report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        report.as_object_mut().expect("an object").remove("spec_hash").expect("a hash");
        report
    };
    assert_eq!(numbers(&compiled), numbers(&shipped));
    // Kept: the second time nothing is compiled; parameters, options and exit codes are passed on.
    let again = crane(&["statics", &file, "--compile", "--set", "payload=1", "--format", "json"]);
    assert!(again.status.success(), "{}", text(&again.stderr));
    assert!(text(&again.stderr).contains("compiled earlier"), "{}", text(&again.stderr));
    assert!(serde_json::from_slice::<serde_json::Value>(&again.stdout).is_ok_and(|report| report["pose"].is_array()));
    let refused = crane(&["statics", &file, "--set", "payload"]);
    assert_eq!(refused.status.code(), Some(2));

    // The kept program runs without cargo, and a corrupted one is compiled again.
    let cache = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("own_cranes");
    let statics = |path: Option<&str>| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        command.args(["statics", &file, "--compile"]).current_dir(UNOPTIMISED).env("CRANE_CACHE", &cache);
        if let Some(path) = path {
            command.env("PATH", path).env_remove("CARGO");
        }
        command.output().expect("the command starts")
    };
    let alone = statics(Some(""));
    assert!(alone.status.success(), "{}", text(&alone.stderr));
    let mut folders = fs::read_dir(&cache).expect("a cache").filter_map(|entry| Some(entry.ok()?.path()));
    let folder = folders.find(|path| path.display().to_string().contains("crane-knuckle_boom"));
    fs::write(folder.expect("a kept crane").join("program"), "rubbish").expect("a file");
    let mended = statics(None);
    assert!(mended.status.success() && mended.stdout == alone.stdout, "{}", text(&mended.stderr));
    assert!(text(&mended.stderr).contains("compiling it again"), "{}", text(&mended.stderr));
}

#[test]
fn without_a_folder_of_ones_own_nothing_is_compiled() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
    command.args(["statics", "knuckle_boom", "--compile"]);
    for name in ["CRANE_CACHE", "XDG_CACHE_HOME", "HOME"] {
        command.env_remove(name);
    }
    let refused = command.output().expect("the command starts");
    assert_eq!(refused.status.code(), Some(1));
    assert!(text(&refused.stderr).contains("set CRANE_CACHE to a folder of your own"), "{}", text(&refused.stderr));
}

#[test]
fn a_spec_runs_live_without_cargo_from_any_folder() {
    let file = spec("live.yaml", "title: Planar", "title: A planar");
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("live");
    fs::create_dir_all(&folder).expect("a folder");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_crane"));
        let output = command.args(arguments).current_dir(&folder).env("PATH", "").env_remove("CARGO").output();
        let output = output.expect("the command starts");
        assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
        text(&output.stdout)
    };
    for command in ["info", "modes", "stability"] {
        run(&[command, &file]);
    }
    run(&["run", &file, "--duration", "0.5", "--out", "."]);
    assert!(folder.join("knuckle_boom.html").exists());
    // The same pose as machine code finds, up to rounding.
    let pose = |crane: &str| -> Vec<f64> {
        let report: serde_json::Value =
            serde_json::from_str(&run(&["statics", crane, "--format", "json"])).expect("JSON");
        let rows = report["pose"].as_array().expect("a table");
        rows.iter().map(|row| row["value"].as_f64().expect("a number")).collect()
    };
    let (live, compiled) = (pose(&file), pose("knuckle_boom"));
    let off = live.iter().zip(&compiled).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1e-10 && live.len() == 4, "{off:e}");
}

#[test]
fn the_module_of_a_spec_is_the_same_from_any_folder() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let elsewhere = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("elsewhere");
    fs::create_dir_all(&elsewhere).expect("a folder");
    let path = root.join("specs/eight_link_rigid.yaml");
    let path = path.to_str().expect("a path");
    let at = |folder: &PathBuf, arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_crane"))
            .args(arguments)
            .current_dir(folder)
            .output()
            .expect("the command starts")
    };
    let written = at(&elsewhere, &["generate", path, "-o", "crane.rs"]);
    assert!(written.status.success(), "{}", text(&written.stderr));
    let printed = at(&root, &["generate", "specs/eight_link_rigid.yaml"]);
    assert!(text(&printed.stdout) == fs::read_to_string(elsewhere.join("crane.rs")).expect("a module"));
}

#[test]
fn explain_shows_chain_coordinates_omissions_and_costs() {
    let root = env!("CARGO_MANIFEST_DIR");
    let shown = crane(&["explain", &format!("{root}/../../specs/eight_link_flexible.yaml"), "--operations"]);
    let shown = text(&shown.stdout);
    for expected in [
        "boom_4                     51.013     20  T(0.8750, 0.0000, 0.0000) Rz(boom_4_psi) Ry(boom_4_theta) Rx(boom_4_phi)",
        "telescope_z              m          2.000000",
        "∂T/∂q and ∂²T/∂q∂q: `analyses` does not include derivatives",
        "unsimplified",
    ] {
        assert!(shown.contains(expected), "{expected}\n{shown}");
    }
}
