//! Functional mock-up units, exported by the command and run by `FMPy`.

use std::process::Command;

use crate::python::CHECKS;
use crate::{step, workspace};

const TESTS: &str = "tools/fmu/tests";

/// Runs the tests of units, with the command that is built.
pub fn check() -> Result<(), String> {
    let mut command = Command::new(CHECKS.python());
    command
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", TESTS, "--durations", "5", TESTS])
        .arg("--command")
        .arg(workspace::target().join("release/crane"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .current_dir(workspace::root());
    step::finish(&mut command)
}
