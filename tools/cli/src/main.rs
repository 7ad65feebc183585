//! The `crane` command over the shipped cranes, of which those of the default run are compiled.

use std::process::ExitCode;

use crane_cli::Fleet;

crane_model::cranes! { eight_link_flexible, eight_link_rigid }

fn main() -> ExitCode {
    crane_cli::main(Fleet::new(crane_specs::SPECS, all()))
}
