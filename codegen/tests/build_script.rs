//! The build script and the library produce the same text, and their errors say what to do.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crane_codegen::{build, compile};

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

fn spec(name: &str) -> PathBuf {
    workspace().join(format!("specs/{name}.yaml"))
}

/// A separate folder for this test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Not a test: acts as a `build.rs`, in a separate process, for the spec named by `BUILD_SCRIPT_SPEC`.
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
fn build_script_and_library_write_the_same_bytes() {
    let name = "eight_link_rigid";
    let path = spec(name).display().to_string();
    let source = build::open(path.as_ref()).unwrap();
    let library = compile::compile(&source, None).unwrap().code.text;

    // A different process has different hash seeds, a different folder has different paths.
    let out = folder("out_dir");
    let built = build_script(&path, &workspace(), &out);
    assert!(built.status.success(), "{}", text(&built.stderr));
    assert!(library == fs::read_to_string(out.join(format!("{name}.rs"))).unwrap());
    // Cargo runs it again when this spec changes, or the one that it extends.
    for path in [path, spec("eight_link_flexible").display().to_string()] {
        assert!(text(&built.stdout).contains(&format!("cargo::rerun-if-changed={path}\n")), "{path}");
    }
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
fn warnings_are_passed_on_to_cargo() {
    let here = folder("warned");
    let implausible = fs::read_to_string(spec("cantilever")).unwrap().replacen("E: 210 GPa", "E: 210", 1);
    let line = 1 + implausible.lines().position(|line| line.contains("E: 210")).expect("a line");
    fs::write(here.join("soft.yaml"), implausible).unwrap();
    let title = "Young's modulus `E` of material `steel` is 210 Pa";
    let built = build_script("soft.yaml", &here, &here);
    assert!(built.status.success(), "{}", text(&built.stderr));
    let out = text(&built.stdout);
    assert!(out.contains(&format!("cargo::warning=soft.yaml:{line}:14: {title} [W001]\n")), "{out}");
}
