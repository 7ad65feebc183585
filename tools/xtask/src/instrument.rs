//! The page as an instrument: the engine for WebAssembly (`apps/instrument`), built into one HTML file by `apps/report/instrument`.

use std::path::PathBuf;
use std::process::Command;

use crate::{report, step, workspace};

const TARGET: &str = "wasm32-unknown-unknown";
/// The page, below the root.
pub const PAGE: &str = "out/instrument.html";
/// The engine is small before it is fast, except where `Cargo.toml` says otherwise. Build scripts and macros have settings of their own and are shared
/// with all other builds; link-time optimisation would not be.
const SMALL: (&str, &str) = ("CARGO_PROFILE_RELEASE_OPT_LEVEL", "s");
/// The runtime, too: what takes time is the interpreter. What is only read and drawn is smaller still.
const SMALLER: [&str; 4] = [
    "--config",
    "profile.release.package.crane-model.opt-level=\"s\"",
    "--config",
    "profile.release.package.crane-page.opt-level=\"z\"",
];
/// No names and lines; room on the stack, as programs have it; and the most memory that a spec may take.
const FINISH: [&str; 6] =
    ["-C", "strip=symbols", "-C", "link-arg=-zstack-size=8388608", "-C", "link-arg=--max-memory=1073741824"];

/// The engine: installs its target if it is missing, and builds it.
fn build_engine() -> Result<PathBuf, String> {
    let sysroot = Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).output();
    let installed = sysroot.is_ok_and(|found| PathBuf::from(String::from_utf8_lossy(&found.stdout).trim()).exists());
    if !installed {
        step::run_to_end(Command::new("rustup").args(["target", "add", TARGET]))
            .map_err(|error| format!("{error}; Rust for {TARGET} is needed: `rustup target add {TARGET}`"))?;
    }
    let mut build = Command::new(step::cargo());
    build
        .args([
            "rustc",
            "--release",
            "--target",
            TARGET,
            "--package",
            "crane-instrument",
            "--lib",
            "--crate-type",
            "cdylib",
        ])
        .args(SMALLER)
        .arg("--")
        .args(FINISH)
        .env(SMALL.0, SMALL.1)
        .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS", "-C target-feature=+simd128")
        .current_dir(workspace::root());
    step::run_to_end(&mut build)?;
    Ok(workspace::target().join(TARGET).join("release/crane_instrument.wasm"))
}

/// Builds the page, `out/instrument.html`.
pub fn build_page() -> Result<(), String> {
    write_page().map(|_| println!("{PAGE}: open it in a browser"))
}

/// Builds the page, and returns the engine in it.
pub fn write_page() -> Result<PathBuf, String> {
    report::prepare_packages()?;
    let engine = build_engine()?;
    let page = workspace::root().join(PAGE);
    std::fs::create_dir_all(workspace::root().join("out")).map_err(|error| format!("out: {error}"))?;
    step::run_to_end(report::command_in_folder("node").arg("instrument/build.js").args([&engine, &page]))?;
    Ok(engine)
}

/// Builds the page, compares the engine's numbers with those of the command, and uses the page in headless Chromium.
pub fn check_instrument() -> Result<(), String> {
    let engine = write_page()?;
    let command = workspace::target().join("release/crane");
    step::run_to_end(report::command_in_folder("node").arg("instrument/numbers.js").args([&engine, &command]))?;
    let page = workspace::root().join(PAGE);
    let linked = page.with_file_name("to_instrument.html");
    let options = ["report", "knuckle_boom", "--duration", "0.1", "--instrument", "instrument.html", "-o"];
    step::run_to_end(Command::new(command).args(options).arg(&linked))?;
    step::run_to_end(report::command_in_folder("node").arg("instrument/test.js").args([page, linked]))
}
