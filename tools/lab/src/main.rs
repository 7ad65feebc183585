//! The command `crane-lab` over the shipped cranes.

use std::process::ExitCode;

use crane_lab::Fleet;

fn main() -> ExitCode {
    crane_lab::main(Fleet::new(crane_specs::SPECS, Vec::new()))
}
