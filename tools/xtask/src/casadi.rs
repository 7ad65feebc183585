//! The check with CasADi, in `tools/casadi`.

use std::process::Command;

use crate::{python, step, workspace};

fn check_script() -> Command {
    let mut command = Command::new(python::python());
    command.arg(workspace::root().join("tools/casadi/check.py")).current_dir(workspace::root());
    command
}

/// The derivations obey the laws of mechanics, and an error of 1e-8 in any quantity is noticed.
pub fn self_test() -> Result<(), String> {
    step::finish(check_script().arg("--self-test"))
}

/// Every generated function of every shipped crane and of random cranes.
pub fn check() -> Result<(), String> {
    step::finish(check_script().arg("--evaluate").arg(workspace::target().join("release/evaluate")))
}
