//! What others wrote: licences, sources and advisories of dependencies, and the oldest compiler that builds the crates.

use std::process::Command;

use crate::python::LINTS;
use crate::{step, workspace};

/// Licences, sources and bans by deny.toml; advisories where their database can be had.
pub fn check_dependencies() -> Result<(), String> {
    LINTS.prepare()?;
    let deny = || {
        let mut command = LINTS.command("cargo-deny");
        command.arg("check").current_dir(workspace::root());
        command
    };
    step::run_to_end(deny().args(["licenses", "bans", "sources"]))?;
    let advisories = deny().arg("advisories").output().map_err(|error| format!("cargo-deny: {error}"))?;
    let printed = String::from_utf8_lossy(&advisories.stderr);
    if printed.contains("failed to fetch advisory database") {
        println!("advisories: skipped, the database cannot be had here");
        return Ok(());
    }
    print!("{printed}");
    if advisories.status.success() { Ok(()) } else { Err("advisories, see above".to_owned()) }
}

/// The crates that others build on, with the compiler that the manifest names, where rustup has it.
pub fn check_oldest_compiler() -> Result<(), String> {
    let manifest = workspace::read_file("Cargo.toml")?;
    let oldest = manifest.split("rust-version = \"").nth(1).and_then(|rest| rest.split('"').next());
    let oldest = oldest.ok_or("Cargo.toml names no rust-version")?;
    let installed = Command::new("rustup").args(["toolchain", "list"]).output();
    let installed = installed.map(|list| String::from_utf8_lossy(&list.stdout).into_owned()).unwrap_or_default();
    if !installed.lines().any(|line| line.starts_with(oldest)) {
        println!("Rust {oldest}: skipped, not installed (`rustup toolchain install {oldest}`)");
        return Ok(());
    }
    let mut cargo = Command::new("cargo");
    cargo.args([&format!("+{oldest}"), "check", "--release"]).env_remove("RUSTUP_TOOLCHAIN").env_remove("CARGO");
    step::run_to_end(cargo.current_dir(workspace::root()))
}
