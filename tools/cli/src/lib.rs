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
mod check;
mod compare;
mod completions;
mod ensemble;
mod envelope;
mod eval;
mod example;
mod exchange;
mod figures;
pub mod files;
mod fmu;
mod generate;
mod help;
mod info;
mod integration;
mod journal;
mod linearisation;
mod linearise;
mod modes;
mod new;
mod npz;
mod own;
mod page;
mod parameter_table;
mod poses;
mod problem;
pub mod refinement;
mod run;
mod screen;
mod selection;
mod simulate;
mod stability;
mod start;
mod statics;
mod strength;
mod variants;

use std::{env, io, io::Write, process::ExitCode};

use clap::{Command, CommandFactory, FromArgMatches};

use arguments::{Action, Arguments};
use problem::{Outcome, Problem};
pub use selection::Registry;

/// Parts for other commands that work with cranes, with [`files`] and [`refinement`].
pub mod toolbox {
    pub use crate::arguments::{Analysis, Choice, Format, Limits, Parameters, Step, Timing, seconds};
    pub use crate::figures::{Curve, Mark, PALETTE, Panel};
    pub use crate::integration::{progress, record, styled};
    pub use crate::own::{Library, load, run_with};
    pub use crate::problem::{Outcome, Problem};
    pub use crate::simulate::{file_list, write_figure};
    pub use crane_page::tables::{Cell, Grid, Report};
}

/// Does what the arguments of the process ask for, with the cranes of a registry or of a YAML file that the arguments name.
pub fn main(registry: Registry) -> ExitCode {
    completions::answer(registry.shipped());
    with_arguments(help::grouped(Arguments::command()), |arguments: Arguments, out| {
        screen::choose(&arguments.manner);
        act(arguments, registry, out)?;
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

fn act(mut arguments: Arguments, mut registry: Registry, out: &mut dyn Write) -> Outcome<()> {
    if let Some(choice) = arguments.action.as_mut().and_then(Action::choice) {
        if choice.compile {
            return own::compiled(choice, &registry);
        }
        if let Some(file) = choice.file() {
            choice.name = registry.add_file(file, choice.strict)?;
        }
        if choice.rigid {
            choice.name = registry.add_rigid(&choice.name, "leave `--rigid` out")?;
        }
        let name = choice.name.clone();
        if let Some(poses) = arguments.action.as_ref().and_then(Action::poses) {
            poses::hold(poses, &name, &mut registry)?;
        }
    }
    if let Some(Action::Compare(options)) = &mut arguments.action {
        compare::load(options, &mut registry)?;
    }
    let registry = &registry;
    if let Some(asked) = arguments.action.as_ref().and_then(poses::asked) {
        return poses::rows(&asked, registry, out);
    }
    match &arguments.action {
        None if registry.has(compare::CRANES) => {
            screen::remark(&format!(
                "crane without a command compares {} with {} and writes to {}; `crane --help` lists the commands",
                compare::CRANES[0],
                compare::CRANES[1],
                arguments.compare.folder.out.display()
            ));
            compare::compare(&arguments.compare, registry, out)
        }
        None => Ok(help::grouped(Arguments::command()).print_help()?),
        Some(Action::Compare(options)) => compare::compare_pair(options, registry, out),
        Some(Action::Run(options)) => run::run(options, registry, out),
        Some(Action::Statics(options)) => statics::statics(&options.analysis, registry, out),
        Some(Action::Simulate(options)) => match &options.ensemble.table {
            Some(table) => ensemble::simulate(options, table, registry, out),
            None => simulate::simulate(&options.run, registry, out),
        },
        Some(Action::Modes(options)) => modes::modes(options, registry, out),
        Some(Action::Linearise(options)) => linearise::linearise(options, registry, out),
        Some(Action::Stability(options)) => stability::stability(options, registry, out),
        Some(Action::Strength(options)) => strength::strength(options, registry, out),
        Some(Action::Envelope(options)) => envelope::envelope(options, registry, out),
        Some(Action::Report(options)) => page::report(options, registry, out),
        Some(Action::Info(options)) => info::info(options, registry, out),
        Some(Action::Eval(options)) => eval::eval(options, registry, out),
        Some(Action::New(options)) => new::new(options, registry, out),
        Some(Action::Check(options)) => check::check(options, registry, out),
        Some(Action::Explain(options)) => own::explain(options, registry, out),
        Some(Action::Example(options)) => example::example(options, registry, out),
        Some(Action::Generate(options)) => generate::generate(options, registry, out),
        Some(Action::Operations { specs }) => generate::operations(specs, out),
        Some(Action::Schema { of }) => generate::schema(*of, out),
        Some(Action::Export(options)) => exchange::export(options, registry, out),
        Some(Action::Import(options)) => exchange::import(options, out),
        Some(Action::List(options)) => info::list(options.format, registry, out),
        Some(Action::Completions { shell }) => {
            // Into memory first: a partial script is of no use.
            let script = completions::script(*shell)?;
            Ok(out.write_all(&script)?)
        }
    }
}
