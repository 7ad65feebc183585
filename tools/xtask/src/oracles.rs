//! Other libraries: `tools/casadi` derives every quantity, `tools/peers` computes the dynamics, and is timed.

use std::process::Command;

use crate::python::CHECKS;
use crate::{step, workspace};

fn python_script(path: &str) -> Command {
    let mut command = CHECKS.interpreter_command();
    command.arg(workspace::root().join(path)).current_dir(workspace::root());
    command
}

fn run_on_generated_code(path: &str) -> Result<(), String> {
    step::run_to_end(&mut on_generated_code(path))
}

fn on_generated_code(path: &str) -> Command {
    let mut command = python_script(path);
    command.arg("--evaluate").arg(workspace::target().join("release/evaluate"));
    command
}

const CHECK: &str = "tools/casadi/check.py";
const MOTION: &str = "tools/casadi/motion.py";
const AGREE: &str = "tools/peers/agree.py";
const MEASURE: &str = "tools/peers/measure.py";

/// CasADi's derivations obey the laws of mechanics, and an error of 1e-8 in any quantity is noticed.
pub fn check_oracles() -> Result<(), String> {
    step::run_to_end(python_script(CHECK).arg("--self-test"))
}

/// Specs that are interpreted, with what no shipped crane has.
const INTERPRETED: [&str; 5] = [
    "specs/examples/telescopic_loader.yaml",
    "tools/casadi/efforts.yaml",
    "tools/casadi/geared.yaml",
    "tools/casadi/pads.yaml",
    "tools/casadi/pins.yaml",
];

/// Every generated function of every shipped crane and of random cranes; functions of further specs, interpreted.
pub fn check_generated_code() -> Result<(), String> {
    run_on_generated_code(CHECK)?;
    step::run_to_end(on_generated_code(CHECK).args(INTERPRETED.iter().flat_map(|spec| ["--crane", spec])))
}

/// Pinocchio and MuJoCo agree with each other, and an error of 1e-7 in A, e or q̈ is noticed.
pub fn check_peers() -> Result<(), String> {
    step::run_to_end(python_script(AGREE).arg("--self-test"))
}

/// A, e and q̈ of the same cranes.
pub fn compare_with_peers() -> Result<(), String> {
    run_on_generated_code(AGREE)
}

/// Exported cranes in Pinocchio and MuJoCo, imported robots in the compiler.
pub fn check_exchange() -> Result<(), String> {
    let program = |name: &str| workspace::target().join("release").join(name);
    let mut command = python_script("tools/peers/exchange.py");
    step::run_to_end(command.arg("--crane").arg(program("crane")).arg("--evaluate").arg(program("evaluate")))
}

/// Runs of shipped cranes against `SciPy`'s Radau on `CasADi`'s equations of motion.
pub fn check_motion() -> Result<(), String> {
    step::run_to_end(python_script(MOTION).arg("--command").arg(workspace::target().join("release/crane")))
}

/// Arms on hydraulic cylinders, beside Exudyn's.
pub fn check_hydraulics() -> Result<(), String> {
    let mut command = python_script("tools/peers/hydraulics.py");
    step::run_to_end(command.arg("--command").arg(workspace::target().join("release/crane")))
}

/// The environment of the checks.
pub fn prepare_python() -> Result<(), String> {
    CHECKS.prepare()
}

/// Times the generated functions and other libraries, and writes docs/performance.md; the words after the task are options.
pub fn measure_performance() -> Result<(), String> {
    CHECKS.prepare()?;
    step::run_to_end(python_script(MEASURE).args(std::env::args().skip(2)))
}

/// The measurement in its quick form, without Pinocchio: its templates compile for four minutes.
pub fn rehearse_performance() -> Result<(), String> {
    step::run_to_end(python_script(MEASURE).args(["--quick", "--without", "pinocchio"]))
}
