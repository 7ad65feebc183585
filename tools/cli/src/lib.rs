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

use std::{env, io, io::Write, process::ExitCode};

use clap::{Command, CommandFactory, FromArgMatches};

use arguments::Arguments;
use problem::{Outcome, Problem};
pub use selection::{Carried, Registry};

/// Parts for other commands that work with cranes, with [`files`] and [`refinement`].
pub mod toolbox {
    pub use crate::arguments::{Analysis, Choice, Format, Limits, Parameters, Step, Timing, seconds};
    pub use crate::compiled::{Library, run_with};
    pub use crate::figures::{Curve, Mark, PALETTE, Panel};
    pub use crate::integration::{progress, styled};
    pub use crate::problem::{Outcome, Problem};
    pub use crate::simulate::{file_list, write_figure};
    pub use crate::spec_file::load;
    pub use crane_page::tables::{Cell, Grid, Report};
}

/// Does what the arguments of the process ask for, with the cranes of a registry or of a YAML file that the arguments name.
pub fn main(registry: Registry) -> ExitCode {
    completions::answer(registry.shipped());
    with_arguments(help::grouped(Arguments::command()), |arguments: Arguments, out| {
        screen::choose(&arguments.manner);
        guard::watch()?;
        command::execute(arguments, registry, out)?;
        screen::unaccepted().map_or(Ok(()), Err)
    })
}

/// Reads the arguments of the process, as `command` describes them, and acts on them; returns the exit code.
pub fn with_arguments<A: FromArgMatches>(
    mut command: Command,
    act: impl FnOnce(A, &mut dyn Write) -> Outcome<()>,
) -> ExitCode {
    let parsed = command
        .try_get_matches_from_mut(env::args_os())
        .and_then(|matches| A::from_arg_matches(&matches).map_err(|error| error.format(&mut command)));
    let arguments = match parsed {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version arrive here too. If printing fails, there is no one to inform.
            if error.use_stderr() && screen::is_json() {
                return ExitCode::from(screen::report(&Problem::arguments(&error)));
            }
            let _ = error.print();
            return if error.use_stderr() { ExitCode::from(problem::USAGE) } else { ExitCode::SUCCESS };
        }
    };
    match act(arguments, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => ExitCode::from(screen::report(&problem)),
    }
}
