//! The `crane` command over the shipped cranes.

use std::process::ExitCode;

use crane_cli::Fleet;

fn main() -> ExitCode {
    crane_cli::main(&Fleet { all: crane_specs::all, specs: crane_specs::SPECS })
}
