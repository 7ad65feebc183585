//! The `crane` command, over any cranes.
//!
//! The program `crane` runs it over the shipped cranes; another crate can run it over its own:
//!
//! ```ignore
//! crane_model::cranes! { my_crane }
//!
//! fn main() -> std::process::ExitCode {
//!     let specs = &[("my_crane", include_str!("../crane.yaml"))];
//!     crane_cli::main(crane_cli::Registry::new(specs, all()))
//! }
//! ```

mod arguments;
mod book;
mod check;
mod combinations;
mod command;
mod compare;
mod compiled;
mod completions;
mod drives;
mod ensemble;
mod envelope;
mod eval;
mod example;
mod exchange;
mod explain;
mod factors;
mod fatigue;
mod figures;
pub mod files;
mod fmu;
mod generate;
mod guard;
mod help;
mod info;
mod integration;
mod journal;
mod linearisation;
mod linearise;
mod margins;
mod modes;
mod new;
mod npz;
mod page;
mod parameter_table;
mod picture;
mod poses;
mod problem;
mod quantity;
pub mod refinement;
mod run;
mod screen;
mod selection;
mod sensitivity;
mod sheet;
mod simulate;
mod spec_file;
mod stability;
mod start;
mod state_space;
mod statics;
mod strength;
mod variants;

use std::{io, io::Write, process::ExitCode, sync::Arc};

use clap::{Command, CommandFactory, FromArgMatches};

use arguments::Arguments;
use problem::{Outcome, Problem};
pub use screen::Console;
pub use selection::{Carried, Registry};

/// Parts for other commands that work with cranes, with [`files`] and [`refinement`].
pub mod toolbox {
    pub use crate::arguments::{Analysis, Choice, Format, Limits, Parameters, Step, Timing, seconds};
    pub use crate::compiled::{Library, run_with};
    pub use crate::figures::{Curve, Mark, PALETTE, Panel};
    pub use crate::problem::{Outcome, Problem};
    pub use crate::simulate::{file_list, write_figure};
    pub use crate::spec_file::load;
    pub use crane_page::tables::{Cell, Grid, Report};
}

/// Does what the arguments of the process ask for, with the cranes of a registry or of a YAML file that the arguments name.
pub fn main(registry: Registry) -> ExitCode {
    completions::answer(registry.shipped());
    run(registry, Console::of_process(), &mut io::stdout().lock()).into()
}

/// Does what the words of a console ask for, with such cranes, and writes the results to `out`; returns the exit code.
///
/// Help, and what is wrong with arguments that cannot be read, go to the streams of the process, except as JSON.
pub fn run(mut registry: Registry, console: Console, out: &mut dyn Write) -> u8 {
    let command = help::grouped(Arguments::command());
    with_arguments(command, console, out, |arguments: Arguments, console, out| {
        console.choose(&arguments.manner);
        guard::watch(console)?;
        registry.console = Arc::clone(console);
        command::execute(arguments, registry, out)?;
        console.unaccepted().map_or(Ok(()), Err)
    })
}

/// Reads the words of a console, as `command` describes them, and acts on them; returns the exit code.
pub fn with_arguments<A: FromArgMatches>(
    command: Command,
    console: Console,
    out: &mut dyn Write,
    act: impl FnOnce(A, &Arc<Console>, &mut dyn Write) -> Outcome<()>,
) -> u8 {
    let arguments = match arguments::read(command, &console.words) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version arrive here too. If printing fails, there is no one to inform.
            if error.use_stderr() && console.is_json() {
                return console.report(&Problem::arguments(&error));
            }
            let _ = error.print();
            return if error.use_stderr() { problem::USAGE } else { 0 };
        }
    };
    let console = Arc::new(console);
    act(arguments, &console, out).map_or_else(|problem| console.report(&problem), |()| 0)
}
