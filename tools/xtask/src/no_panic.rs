//! Cranes without panics: a program that links only where the optimiser finds every path to a panic impossible.

use std::process::Command;

use crate::step::{cargo, finish};
use crate::workspace;

/// All crates optimised as one: a function is free of panics only if those it calls are.
const WHOLE: [&str; 2] = ["profile.release.lto=\"fat\"", "profile.release.codegen-units=1"];

/// Builds it. With a target named, this holds for the target alone: the compiler, which runs in build scripts, is not built again.
pub fn check() -> Result<(), String> {
    let mut command = Command::new(cargo());
    command.args(["build", "--release", "--package", "no-std-crane", "--features", "no-panic", "--bin", "no-panic"]);
    command.args(["--target", &workspace::host()?]).args(WHOLE.iter().flat_map(|setting| ["--config", setting]));
    finish(command.current_dir(workspace::root()))
}
