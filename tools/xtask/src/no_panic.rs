//! Cranes without panics: a program that links only if the optimiser proves every path to a panic impossible.

use std::process::Command;

use crate::step::{cargo, run_to_end};
use crate::workspace;

/// Every crate keeps its bitcode for link-time optimisation, and is compiled as one unit.
const PARTS: &str = "-C embed-bitcode=yes -C codegen-units=1";

/// Builds it, all crates optimised as one: a function is free of panics only if those it calls are.
///
/// With an explicit target, flags apply to the target only: the compiler, which runs in build scripts, is not built again.
pub fn check_no_panic() -> Result<(), String> {
    let mut command = Command::new(cargo());
    command.args(["rustc", "--release", "--package", "no-std-crane", "--features", "no-panic", "--bin", "no-panic"]);
    command.args(["--target", &workspace::host_triple()?]).env("RUSTFLAGS", PARTS);
    command.args(["--", "-C", "lto=fat"]);
    run_to_end(command.current_dir(workspace::root()))
}
