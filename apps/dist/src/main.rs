//! The command `crane` for computers without Rust and without the source tree: `cargo xtask release` builds it.

use std::process::ExitCode;

use crane_cli::{Carried, Registry};

include!(concat!(env!("OUT_DIR"), "/carried.rs"));

fn main() -> ExitCode {
    crane_cli::main(Registry::new(crane_specs::SPECS, vec![]).carrying(CARRIED))
}
