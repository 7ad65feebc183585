//! The `crane` command over the shipped cranes.

use std::process::ExitCode;

use crane_cli::Fleet;

fn main() -> ExitCode {
    crane_cli::main(Fleet::new(crane_specs::SPECS, crane_specs::all()))
}
