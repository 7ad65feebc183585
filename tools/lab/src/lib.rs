//! Measurements and stress tests of the methods and models of the command `crane`.
//!
//! `work-precision` runs compiled cranes: it compiles a program of this library with these cranes.

mod arguments;
mod stress;
mod work_precision;

use std::{io, process::ExitCode, sync::Arc};

use clap::CommandFactory;

use arguments::{Action, Arguments};
use crane_cli::Console;
pub use crane_cli::Registry;

/// Does what the arguments of the process ask for, with the cranes of a registry or of a YAML file that the arguments name.
pub fn main(mut registry: Registry) -> ExitCode {
    let (command, console) = (Arguments::command(), Console::of_process());
    crane_cli::with_arguments(command, console, &mut io::stdout().lock(), |arguments: Arguments, console, out| {
        registry.console = Arc::clone(console);
        match &arguments.action {
            Action::WorkPrecision(options) => work_precision::work_precision(options, &registry, out),
            Action::Stress(options) => stress::stress(options, &registry, out),
        }
    })
    .into()
}
