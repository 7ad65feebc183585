//! The `crane` command over the shipped cranes.

use std::process::ExitCode;

use crane_cli::Fleet;

include!(concat!(env!("OUT_DIR"), "/cranes.rs"));

fn main() -> ExitCode {
    crane_cli::main(Fleet::new(SPECS, all()))
}
