//! The command, the build script and the library call: the same text, and errors that say what to do.
#![cfg(feature = "cli")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crane_codegen::{SourceFile, compile};

const COMMAND: &str = env!("CARGO_BIN_EXE_crane-codegen");

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

fn spec(name: &str) -> PathBuf {
    workspace().join(format!("specs/{name}.yaml"))
}

/// A folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn run(arguments: &[&str], at: &Path) -> Output {
    Command::new(COMMAND).args(arguments).current_dir(at).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Not a test: what a `build.rs` does, in a process of its own, for the spec named by `BUILD_SCRIPT_SPEC`.
#[test]
#[ignore = "run by the tests of the build script"]
fn act_as_build_script() {
    if let Some(spec) = std::env::var_os("BUILD_SCRIPT_SPEC") {
        crane_codegen::build::compile_spec(spec);
    }
}

/// Runs the build script of a spec.
fn build_script(spec: &str, at: &Path, out: &Path) -> Output {
    Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "act_as_build_script", "--nocapture"])
        .current_dir(at)
        .env("BUILD_SCRIPT_SPEC", spec)
        .env("OUT_DIR", out)
        .output()
        .unwrap()
}

#[test]
fn command_build_script_and_library_write_the_same_bytes() {
    let name = "eight_link_rigid";
    let path = spec(name).display().to_string();
    let source = SourceFile::new(path.clone(), fs::read_to_string(&path).unwrap());
    let library = compile::compile(&source, None).unwrap().code.text;

    // Another process has other hash seeds, another folder other paths.
    let elsewhere = folder("elsewhere");
    let written = run(&["generate", &path, "-o", "crane.rs"], &elsewhere);
    assert!(written.status.success(), "{}", text(&written.stderr));
    assert!(library == fs::read_to_string(elsewhere.join("crane.rs")).unwrap());
    let printed = run(&["generate", &format!("specs/{name}.yaml")], &workspace());
    assert!(library == text(&printed.stdout));

    let out = folder("out_dir");
    let built = build_script(&path, &workspace(), &out);
    assert!(built.status.success(), "{}", text(&built.stderr));
    assert!(library == fs::read_to_string(out.join(format!("{name}.rs"))).unwrap());
    assert!(text(&built.stdout).contains(&format!("cargo::rerun-if-changed={path}\n")));
}

#[test]
fn a_bad_spec_ends_a_build_with_a_headline_and_a_drawing() {
    let here = folder("bad_build");
    let bad = fs::read_to_string(spec("double_pendulum")).unwrap().replacen("mass:", "masss:", 1);
    fs::write(here.join("bad.yaml"), bad).unwrap();
    let built = build_script("bad.yaml", &here, &here);
    assert_eq!(built.status.code(), Some(1));
    let (out, err) = (text(&built.stdout), text(&built.stderr));
    assert!(out.contains("cargo::error=bad.yaml:") && out.contains("`masss`"), "{out}");
    assert!(err.contains("masss") && err.contains("`mass`"), "{err}");
    assert!(!here.join("double_pendulum.rs").exists(), "nothing is written");
}

#[test]
fn a_missing_file_is_named() {
    let output = run(&["check", "no_such.yaml"], &workspace());
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).starts_with("no_such.yaml: "), "{}", text(&output.stderr));
}

#[test]
fn wrong_arguments_end_with_2() {
    for arguments in [&["generat", "x.yaml"][..], &["check"], &[], &["generate", "x.yaml", "--al"]] {
        let output = run(arguments, &workspace());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!output.stderr.is_empty());
    }
}

#[test]
fn explain_shows_chain_coordinates_omissions_and_costs() {
    let output = run(&["explain", "specs/eight_link_flexible.yaml"], &workspace());
    let shown = text(&output.stdout);
    for expected in [
        "boom_4                     51.013     20  T(0.8750, 0.0000, 0.0000) Rz(boom_4_psi) Ry(boom_4_theta) Rx(boom_4_phi)",
        "telescope_z              m          2.000000",
        "∂T/∂q and ∂²T/∂q∂q: `analyses` does not ask for derivatives",
        "unsimplified",
    ] {
        assert!(shown.contains(expected), "{expected}\n{shown}");
    }
}

#[test]
fn check_counts_bodies_and_coordinates() {
    let output = run(&["check", "specs/eight_link_flexible.yaml"], &workspace());
    assert_eq!(text(&output.stdout), "specs/eight_link_flexible.yaml: sound; 12 bodies, 25 coordinates\n");
}

#[test]
fn warnings_are_drawn_passed_on_to_cargo_and_fail_a_strict_check() {
    let here = folder("warned");
    let implausible = fs::read_to_string(spec("cantilever")).unwrap().replacen("E: 2.1e11", "E: 210", 1);
    fs::write(here.join("soft.yaml"), implausible).unwrap();
    let title = "Young's modulus `E` of material `steel` is 210 Pa";

    let checked = run(&["check", "soft.yaml"], &here);
    assert!(checked.status.success());
    let err = text(&checked.stderr);
    assert!(err.contains(&format!("warning[W001]: {title}")) && err.contains("soft.yaml: 1 warning"), "{err}");
    assert!(text(&checked.stdout).starts_with("soft.yaml: sound"));

    let strict = run(&["check", "--strict", "soft.yaml"], &here);
    assert_eq!(strict.status.code(), Some(1));
    assert!(text(&strict.stderr).contains(title) && strict.stdout.is_empty());

    let built = build_script("soft.yaml", &here, &here);
    assert!(built.status.success(), "{}", text(&built.stderr));
    let out = text(&built.stdout);
    assert!(out.contains(&format!("cargo::warning=soft.yaml:16:14: {title} [W001]\n")), "{out}");
}
