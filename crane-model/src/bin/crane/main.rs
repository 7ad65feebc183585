//! The `crane` command.

mod arguments;
mod compare;
mod eval;
mod figures;
mod files;
mod info;
mod modes;
mod npz;
mod problem;
mod report;
mod run;
mod selection;
mod simulate;
mod stability;
mod statics;

use std::{io, io::Write, process::ExitCode};

use clap::{CommandFactory, Parser};

use arguments::{Action, Arguments};
use problem::Outcome;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version come this way too. Nobody is left to tell where printing fails.
            let _ = error.print();
            return if error.use_stderr() { ExitCode::from(problem::USAGE) } else { ExitCode::SUCCESS };
        }
    };
    match act(&arguments, &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => problem.report(),
    }
}

fn act(arguments: &Arguments, out: &mut dyn Write) -> Outcome<()> {
    match &arguments.action {
        None => compare::compare(&arguments.compare, out),
        Some(Action::Statics(options)) => statics::statics(options, out),
        Some(Action::Simulate(options)) => simulate::simulate(options, out),
        Some(Action::Modes(options)) => modes::modes(options, out),
        Some(Action::Stability(options)) => stability::stability(options, out),
        Some(Action::Info(options)) => info::info(options, out),
        Some(Action::Eval(options)) => eval::eval(options, out),
        Some(Action::List(options)) => info::list(options.format, out),
        Some(Action::Completions { shell }) => {
            // Into memory first: the generator panics where the other end of a pipe is gone.
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Arguments::command(), "crane", &mut script);
            Ok(out.write_all(&script)?)
        }
    }
}
