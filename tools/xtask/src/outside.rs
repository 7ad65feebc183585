//! Checks of the command from outside, in Python: functional mock-up units run by `FMPy`, random cranes computed in several
//! ways, and JSON against its schemas.

use crate::python::CHECKS;
use crate::{step, workspace};

/// Runs the tests of functional mock-up units.
pub fn check_units() -> Result<(), String> {
    run_python_tests("apps/fmu/tests", &[])
}

/// Runs the tests of what the command prints as JSON.
pub fn check_output() -> Result<(), String> {
    run_python_tests("apps/cli/tests/output", &[])
}

/// Compares what random cranes compute in the Python package with what the command writes, and with functional mock-up units and C that
/// it makes. The package must be installed.
pub fn check_ways() -> Result<(), String> {
    let combinations = workspace::target().join("release/combinations");
    run_python_tests("tests/combinations/ways", &["--combinations", &combinations.to_string_lossy()])
}

/// Runs the tests of a folder with the built command and other arguments.
fn run_python_tests(tests: &str, arguments: &[&str]) -> Result<(), String> {
    let mut command = CHECKS.interpreter_command();
    command
        .args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", tests, "--durations", "5", tests])
        .arg("--command")
        .arg(workspace::target().join("release/crane"))
        .args(arguments)
        .current_dir(workspace::root());
    step::run_to_end(&mut command)
}
