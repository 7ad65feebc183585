//! Completions for which the shell asks the command itself: cranes, and the names of what a crane has.

use std::{
    env,
    ffi::{OsStr, OsString},
    io::{self, Write},
    path::{Path, PathBuf},
};

use clap::{Arg, Command, CommandFactory};
use clap_complete::{
    Shell,
    engine::{ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter},
    env::{CompleteEnv, Shells},
};
use crane_codegen::{SourceFile, build, chain::Chain, compile};
use crane_model::{ColumnKind, results::column_name};

use crate::{
    arguments::{Arguments, DEFAULT_CRANE, spec_file},
    help,
    selection::Specs,
};

/// Names in the help of arguments that take a crane.
const CRANES: [&str; 2] = ["CRANE", "OTHER"];
/// Environment variable that a shell sets to ask for completions.
const VARIABLE: &str = "COMPLETE";

/// If a shell asks for completions, answers it and ends the process.
pub fn answer(specs: Specs) {
    CompleteEnv::with_factory(|| completed(help::grouped(Arguments::command()), specs)).var(VARIABLE).complete();
}

/// The script that lets a shell ask this program.
///
/// # Errors
/// The path of this program cannot be determined.
pub fn script(shell: Shell) -> io::Result<Vec<u8>> {
    let program = env::current_exe()?;
    let mut script = Vec::new();
    if let Some(shell) = Shells::builtins().completer(&shell.to_string()) {
        shell.write_registration(VARIABLE, "crane", "crane", &program.to_string_lossy(), &mut script)?;
    }
    writeln!(script)?;
    Ok(script)
}

/// The command with completions of values.
fn completed(command: Command, specs: Specs) -> Command {
    let with_values = move |argument| with_values(argument, specs);
    command.mut_args(with_values).mut_subcommands(move |subcommand| subcommand.mut_args(with_values))
}

/// An argument with the completions of its values, if the command knows some.
fn with_values(argument: Arg, specs: Specs) -> Arg {
    let takes_crane =
        argument.get_value_names().is_some_and(|values| values.iter().any(|value| CRANES.contains(&value.as_str())));
    if takes_crane {
        return argument.add(ArgValueCompleter::new(move |current: &OsStr| cranes(specs, current)));
    }
    match argument.get_long().and_then(names_of) {
        Some(names) => argument.add(ArgValueCompleter::new(move |current: &OsStr| {
            let crane = chain(specs, &words());
            crane.map(|crane| matching(names(&crane), current)).unwrap_or_default()
        })),
        None => argument,
    }
}

/// A name, and what it is.
type Named = (String, String);

/// What an option names in a crane.
fn names_of(option: &str) -> Option<fn(&Chain) -> Vec<Named>> {
    Some(match option {
        "set" => |crane| equals(parameters(crane)),
        "input" => |crane| equals(crane.inputs.iter().map(|input| (input.name.clone(), input.unit.clone())).collect()),
        "load" | "with" => parameters,
        "point" => points,
        "deflection" => |crane| equals(points(crane)),
        "effort" => |crane| equals(drives(crane)),
        "on" => |crane| {
            let inputs = crane.inputs.iter().map(|input| (input.name.clone(), input.unit.clone()));
            with_rates(drives(crane)).into_iter().chain(inputs).collect()
        },
        "measure" => |crane| {
            with_rates(crane.coordinates.iter().map(|coordinate| (coordinate.name.clone(), String::new())).collect())
        },
        "range" => |crane| equals([drives(crane), parameters(crane)].concat()),
        "start" | "hold" => |crane| {
            let names = crane.coordinates.iter().map(|coordinate| (coordinate.name.clone(), String::new()));
            equals(with_rates(names.collect()))
        },
        _ => return None,
    })
}

fn parameters(crane: &Chain) -> Vec<Named> {
    let about = |unit: &str, default: f64| format!("{default} {unit}").trim_end().to_owned();
    crane
        .parameters
        .iter()
        .map(|parameter| (parameter.name.clone(), about(&parameter.unit, parameter.default)))
        .collect()
}

fn points(crane: &Chain) -> Vec<Named> {
    crane.points.iter().map(|point| (point.name.clone(), String::new())).collect()
}

/// The coordinates that drives move.
fn drives(crane: &Chain) -> Vec<Named> {
    let name = |index: usize| crane.coordinates[index].name.clone();
    crane.drives.iter().map(|drive| (name(drive.coordinate.0), String::new())).collect()
}

/// Coordinates, each followed by its rate.
fn with_rates(names: Vec<Named>) -> Vec<Named> {
    names
        .into_iter()
        .flat_map(|(name, about)| [(name.clone(), about.clone()), (column_name(ColumnKind::Rate, &name, false), about)])
        .collect()
}

/// Names before a value: `name=`.
fn equals(names: Vec<Named>) -> Vec<Named> {
    names.into_iter().map(|(name, about)| (name + "=", about)).collect()
}

/// Shipped cranes and YAML files.
fn cranes(specs: Specs, current: &OsStr) -> Vec<CompletionCandidate> {
    let shipped = specs.iter().map(|(name, _)| ((*name).to_owned(), String::new())).collect();
    let files = PathCompleter::any().filter(|path: &Path| path.is_dir() || path.to_str().and_then(spec_file).is_some());
    let mut found = matching(shipped, current);
    found.extend(files.complete(current));
    found
}

/// The names that begin with what has been typed.
fn matching(names: Vec<Named>, current: &OsStr) -> Vec<CompletionCandidate> {
    let typed = current.to_string_lossy();
    let fitting = names.into_iter().filter(|(name, _)| name.starts_with(typed.as_ref()));
    fitting
        .map(|(name, about)| CompletionCandidate::new(name).help((!about.is_empty()).then(|| about.into())))
        .collect()
}

/// The words of the line that is being completed.
fn words() -> Vec<OsString> {
    env::args_os().skip_while(|word| word != "--").skip(2).collect()
}

/// The crane that a line is about: the first of its words that names one, otherwise the default.
fn chain(specs: Specs, words: &[OsString]) -> Option<Chain> {
    let mut words = words.iter().filter_map(|word| word.to_str());
    let shipped = |name: &str| {
        let (name, spec) = specs.iter().find(|(known, _)| *known == name)?;
        Some(SourceFile::new(format!("{name}.yaml"), *spec))
    };
    let file = |name: &str| {
        let path: PathBuf = spec_file(name).filter(|path| path.is_file())?.to_owned();
        build::open_with(&path, &|name| Some(specs.iter().find(|(known, _)| *known == name)?.1)).ok()
    };
    let named = words.find_map(|word| shipped(word).or_else(|| file(word)));
    compile::load(&named.or_else(|| shipped(DEFAULT_CRANE))?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPECS: Specs = crane_specs::SPECS;

    fn candidates(line: &[&str]) -> Vec<String> {
        let mut command = completed(Arguments::command(), SPECS);
        let words: Vec<OsString> = line.iter().map(OsString::from).collect();
        let last = words.len() - 1;
        let found = clap_complete::engine::complete(&mut command, words, last, None).expect("candidates");
        found.iter().map(|candidate| candidate.get_value().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn cranes_are_completed_by_every_command_that_takes_one() {
        for command in ["statics", "run", "explain", "check", "export", "generate", "compare"] {
            assert_eq!(candidates(&["crane", command, "knuckle_b"]), ["knuckle_boom"], "{command}");
        }
        assert_eq!(candidates(&["crane", "compare", "knuckle_boom", "cantil"]), ["cantilever"]);
        assert_eq!(candidates(&["crane", "new", "x", "--from", "doub"]), ["double_pendulum"]);
    }

    #[test]
    fn names_are_those_of_the_crane_of_the_line() {
        let of = |crane: &str, option: &str| {
            let names = names_of(option).expect("an option with names");
            names(&chain(SPECS, &[OsString::from(crane)]).expect("a crane"))
        };
        let names = |named: Vec<Named>| -> Vec<String> { named.into_iter().map(|(name, _)| name).collect() };
        assert!(names(of("eight_link_flexible", "set")).contains(&"load_mass=".to_owned()));
        assert!(names(of("cantilever", "start")).contains(&"beam_1_psi_rate=".to_owned()));
        assert!(names(of("knuckle_boom", "range")).contains(&"main_boom_theta=".to_owned()));
        assert!(names(of("knuckle_boom", "point")).contains(&"boom_tip".to_owned()));
        // A line without a crane is about the default.
        assert_eq!(of("", "set"), of(DEFAULT_CRANE, "set"));
        assert!(names_of("format").is_none());
    }
}
