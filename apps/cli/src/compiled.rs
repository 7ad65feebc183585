//! Cranes as machine code: a program of its own for a crane, compiled on request and kept.

mod package;

use std::{
    env,
    ffi::{OsStr, OsString},
    path::{Path, PathBuf},
};

use crane_codegen::{SourceFile, chain::Chain};

use crate::{
    arguments::Choice,
    files,
    problem::Outcome,
    screen::Console,
    selection::Registry,
    spec_file::{load, parse},
};
use package::{Package, Product};

/// The crate of the command, from which this program was built and on which the program of a crane depends.
const CLI: &str = env!("CARGO_MANIFEST_DIR");
/// The versions of everything that this program was built with.
pub const LOCK: &str = include_str!(concat!(env!("OUT_DIR"), "/Cargo.lock"));
/// The library of a program of compiled cranes: a crate with a function `main` over a registry; or that of units.
pub struct Library {
    /// The crate's name.
    pub name: &'static str,
    /// Where its source is.
    pub folder: &'static str,
    /// Its features that are on.
    pub features: &'static [&'static str],
}

/// The command itself.
const COMMAND: Library = Library { name: env!("CARGO_PKG_NAME"), folder: CLI, features: &[] };
/// Functional mock-up units.
const UNITS: Library =
    Library { name: "crane-fmu", folder: concat!(env!("CARGO_MANIFEST_DIR"), "/../fmu"), features: &[] };
/// Environment variable with the command line as typed, for a crane's own program.
const AS_TYPED: &str = "CRANE_AS_TYPED";

/// Root of the workspace that this program was built from.
pub fn root() -> &'static Path {
    Path::new(CLI).ancestors().nth(2).unwrap_or(Path::new(CLI))
}

/// Does what the arguments of this process ask for, with the chosen crane as machine code.
pub fn execute(choice: &Choice, registry: &Registry) -> Outcome<()> {
    let (Chain { name, spec_hash, .. }, text) = match (choice.file(), registry.spec(&choice.name)) {
        (None, Some(spec)) => {
            parse(&registry.console, SourceFile::new(format!("{}.yaml", choice.name), spec.to_owned()), choice.strict)?
        }
        (None, None) => return registry.crane(&choice.name).map(|_| ()),
        (Some(file), _) => load(&registry.console, file, choice.strict)?,
    };
    let package = format!("crane-{name}-{spec_hash}");
    run_with(&registry.console, &COMMAND, &package, OsStr::new(&choice.name), &[(name, text)])
}

/// Runs a library in the program of several cranes, given by names and specs; the first one replaces `named`.
///
/// # Errors
/// Cargo is missing or fails, or files cannot be written; the program reports its own errors.
pub fn run_with(
    console: &Console,
    library: &Library,
    package: &str,
    named: &OsStr,
    cranes: &[(String, String)],
) -> Outcome<()> {
    let mut compiled_name = cranes.first().map(|(name, _)| OsString::from(name));
    let arguments: Vec<OsString> = console
        .words
        .iter()
        .skip(1)
        .filter(|argument| *argument != "--compile")
        .map(|argument| compiled_name.take_if(|_| argument == named).unwrap_or_else(|| argument.clone()))
        .collect();
    let package = Package { console, product: Product::Program, library, name: package, cranes };
    package::run_package(&package, |command| {
        command.args(&arguments).env(AS_TYPED, typed(console)).env(files::READ_BEFORE, console.read_before());
    })
}

/// The shared library of functional mock-up units of a crane as machine code: the kept one, or one that is compiled now.
pub fn unit(console: &Console, chain: &Chain, spec: &str) -> Outcome<PathBuf> {
    let Chain { name, spec_hash, .. } = chain;
    let cranes = [(name.clone(), spec.to_owned())];
    let package = format!("crane-fmu-{name}-{spec_hash}");
    let package = Package { console, product: Product::Unit, library: &UNITS, name: &package, cranes: &cranes };
    package.kept()?.map_or_else(|| package.compiled(), Ok)
}

/// The command as it was typed, as a shell reads it again.
pub fn typed(console: &Console) -> String {
    env::var(AS_TYPED).unwrap_or_else(|_| {
        let arguments: Vec<String> = console.words.iter().skip(1).map(|word| quoted(&word.to_string_lossy())).collect();
        format!("crane {}", arguments.join(" "))
    })
}

/// A word as a shell reads it.
pub fn quoted(word: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "_-./=:,+@%".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
