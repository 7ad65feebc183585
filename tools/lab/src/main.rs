//! The command `crane-lab` over the shipped cranes.

use std::process::ExitCode;

use crane_lab::Registry;

fn main() -> ExitCode {
    crane_lab::main(Registry::new(crane_specs::SPECS, Vec::new()))
}
