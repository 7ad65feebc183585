//! Which part of the program does what the arguments ask for.

use std::io::Write;

use clap::CommandFactory;
use crane_codegen::spec::Crane;
use crane_model::Description;

use crate::{
    arguments::{Action, Arguments, Choice, spec_file},
    book, check, combinations, compare, compiled, completions, drives, ensemble, envelope, eval, example, exchange,
    explain, factors, fatigue, generate, help, info, linearise, margins, modes, new, page, picture, poses,
    problem::Outcome,
    run,
    selection::Registry,
    sensitivity, simulate, stability, statics, strength,
    variants::Edit,
};

/// Does what the arguments ask for, with the cranes of a registry.
///
/// # Errors
/// Those of the command.
pub fn execute(mut arguments: Arguments, mut registry: Registry, out: &mut dyn Write) -> Outcome<()> {
    if let Some(choice) = arguments.action.as_mut().and_then(Action::choice) {
        if choice.compile {
            return compiled::execute(choice, &registry);
        }
        let Choice { name, rigid, combination, strict, .. } = &choice.clone();
        let (held, ranges) = arguments.action.as_ref().map_or((&[][..], &[][..]), Action::held);
        let hold = |description: &Description, spec: &Crane| poses::hold(held, ranges, description, spec);
        let edits = [
            rigid.then_some(Edit::Rigid("leave `--rigid` out")),
            combination.as_deref().map(Edit::Combination),
            (!held.is_empty() || !ranges.is_empty()).then_some(Edit::Hold(&hold)),
        ];
        let edits: Vec<Edit<'_>> = edits.into_iter().flatten().collect();
        let name = match spec_file(name) {
            Some(file) => registry.add_file(file, &edits, *strict)?,
            None => registry.edit(name, &edits)?,
        };
        if let Some(choice) = arguments.action.as_mut().and_then(Action::choice) {
            choice.name = name;
        }
        if let Some(Action::Sensitivity(options)) = &mut arguments.action {
            sensitivity::make_live(options, &mut registry)?;
        }
    }
    if let Some(Action::Compare(options)) = &mut arguments.action {
        compare::load(options, &mut registry)?;
    }
    dispatch(&arguments, &registry, out)
}

/// Does what arguments ask for with cranes that have been read.
///
/// # Errors
/// Those of the command.
pub fn dispatch(arguments: &Arguments, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    if let Some(asked) = arguments.action.as_ref().and_then(poses::asked) {
        return poses::rows(&asked, registry, out);
    }
    match &arguments.action {
        None if registry.has(compare::CRANES) => {
            registry.console.remark(&format!(
                "crane without a command compares {} with {} and writes to {}; `crane --help` lists the commands",
                compare::CRANES[0],
                compare::CRANES[1],
                arguments.compare.folder.out.display()
            ));
            compare::compare(&arguments.compare, registry, out)
        }
        None => Ok(help::grouped(Arguments::command()).print_help()?),
        Some(Action::Compare(options)) => compare::compare_pair(options, registry, out),
        Some(Action::Run(options)) => run::run_crane(options, registry, out),
        Some(Action::Statics(options)) if options.combined.combinations => {
            combinations::statics(&options.analysis, registry, out)
        }
        Some(Action::Strength(options)) if options.combined.combinations => {
            combinations::strength(&options.analysis, registry, out)
        }
        Some(Action::Statics(options)) => statics::statics(&options.analysis, registry, out),
        Some(Action::Simulate(options)) => match &options.ensemble.table {
            Some(table) => ensemble::simulate(options, table, registry, out),
            None => simulate::simulate(&options.run, registry, out),
        },
        Some(Action::Modes(options)) => modes::modes(options, registry, out),
        Some(Action::Linearise(options)) => linearise::linearise(options, registry, out),
        Some(Action::Margins(options)) => margins::margins(options, registry, out),
        Some(Action::Stability(options)) => stability::stability(options, registry, out),
        Some(Action::Strength(options)) => strength::strength(options, registry, out),
        Some(Action::Fatigue(options)) => fatigue::fatigue(options, registry, out),
        Some(Action::Drives(options)) => drives::drives(options, registry, out),
        Some(Action::Factors(options)) => factors::factors(options, registry, out),
        Some(Action::Sensitivity(options)) => sensitivity::sensitivity(options, registry, out),
        Some(Action::Envelope(options)) => envelope::envelope(options, registry, out),
        Some(Action::Report(options)) => page::report(options, registry, out),
        Some(Action::Book(options)) => book::book(options, registry, dispatch, out),
        Some(Action::Info(options)) => info::info(options, registry, out),
        Some(Action::Picture(options)) => picture::picture(options, registry, out),
        Some(Action::Eval(options)) => eval::eval(options, registry, out),
        Some(Action::New(options)) => new::new(options, registry, out),
        Some(Action::Check(options)) => check::check_specs(options, registry, out),
        Some(Action::Explain(options)) => explain::explain(options, registry, out),
        Some(Action::Example(options)) => example::example(options, registry, out),
        Some(Action::Generate(options)) => generate::generate(options, registry, out),
        Some(Action::Operations { specs }) => generate::operations(specs, registry, out),
        Some(Action::Schema { of }) => generate::schema(*of, out),
        Some(Action::Export(options)) => exchange::export(options, registry, out),
        Some(Action::Import(options)) => exchange::import(options, registry, out),
        Some(Action::List(options)) => info::list(options.format, registry, out),
        Some(Action::Completions { shell }) => {
            // Into memory first: a partial script is of no use.
            let script = completions::script(*shell)?;
            Ok(out.write_all(&script)?)
        }
    }
}
