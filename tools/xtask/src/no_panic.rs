//! Cranes without panics: a program that links only where the optimiser finds every path to a panic impossible.

use std::process::Command;

use crate::step::{cargo, finish};
use crate::workspace;

/// Every crate keeps what the optimiser of the whole program reads, and is compiled in one piece.
const PARTS: &str = "-C embed-bitcode=yes -C codegen-units=1";

/// Builds it, all crates optimised as one: a function is free of panics only if those it calls are.
///
/// With a target named, flags are for the target alone: the compiler, which runs in build scripts, is not built again.
pub fn check() -> Result<(), String> {
    let mut command = Command::new(cargo());
    command.args(["rustc", "--release", "--package", "no-std-crane", "--features", "no-panic", "--bin", "no-panic"]);
    command.args(["--target", &workspace::host()?]).env("RUSTFLAGS", PARTS);
    command.args(["--", "-C", "lto=fat"]);
    finish(command.current_dir(workspace::root()))
}
