//! Generated code where the target has fused multiply-adds: other bits, to be compared within a tolerance.

use std::process::Command;

use crate::step::{cargo, run_to_end};
use crate::workspace;

/// Tests that compare results of generated code, and of machine code made at run time, with results computed in another way.
const TESTS: [&str; 4] = ["interpreter", "accuracy", "sin_cos", "native"];

/// Builds and runs them with AVX2 and fused multiply-adds, which a build for all machines of the architecture may not use.
///
/// With an explicit target, flags apply to the target only: the compiler, which runs in build scripts, is not built again.
pub fn check_fused() -> Result<(), String> {
    if !has_fma() {
        println!("this machine has no AVX2 with fused multiply-adds");
        return Ok(());
    }
    let mut command = Command::new(cargo());
    command
        .args(["test", "--release", "--package", "crane-tests", "--package", "crane-live"])
        .current_dir(workspace::root());
    command.args(TESTS.iter().flat_map(|test| ["--test", test]));
    command.args(["--target", &workspace::host_triple()?]).env("RUSTFLAGS", "-C target-cpu=x86-64-v3");
    run_to_end(&mut command)
}

#[cfg(target_arch = "x86_64")]
fn has_fma() -> bool {
    std::arch::is_x86_feature_detected!("fma") && std::arch::is_x86_feature_detected!("avx2")
}

#[cfg(not(target_arch = "x86_64"))]
fn has_fma() -> bool {
    false
}
