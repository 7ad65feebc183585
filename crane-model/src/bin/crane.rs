//! The `crane` command over the shipped cranes.

use std::process::ExitCode;

use crane_model::{
    command::{self, Fleet},
    cranes,
};

fn main() -> ExitCode {
    command::main(&Fleet { all: cranes::all, specs: cranes::SPECS })
}
