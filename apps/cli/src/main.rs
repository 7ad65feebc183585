//! The `crane` command over the shipped cranes, of which those of the default run are compiled.

use std::process::ExitCode;

use crane_cli::Registry;

crane_model::cranes! { eight_link_flexible, eight_link_rigid }

fn main() -> ExitCode {
    crane_cli::main(Registry::new(crane_specs::SPECS, all()))
}
