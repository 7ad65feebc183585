//! A crane of a YAML file: checked here, and compiled on request.

mod package;

use std::{
    env,
    ffi::{OsStr, OsString},
    io::{self, Write},
    path::{Path, PathBuf},
    time::Duration,
};

use crane_codegen::{Checked, SourceFile, build, chain::Chain, compile, explain, picture::picture};

use indicatif::ProgressBar;

use crate::{
    Registry,
    arguments::{Choice, Explain, STANDARD_INPUT},
    files,
    problem::{FAILED, Outcome, Problem},
    screen,
};
use package::{Package, Product};

/// The crate of the command, from which this program was built and on which the program of a crane depends.
const CLI: &str = env!("CARGO_MANIFEST_DIR");
/// The versions of everything that this program was built with.
pub const LOCK: &str = include_str!("../../../Cargo.lock");
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

/// What to do about a file that cannot be read as a spec.
const SPEC: &str = "give a YAML file that describes a crane, or the name of a shipped crane";

/// Root of the workspace that this program was built from.
pub fn root() -> &'static Path {
    Path::new(CLI).ancestors().nth(2).unwrap_or(Path::new(CLI))
}

/// The spec of a shipped crane, or of a YAML file.
pub(super) fn source(given: &str, registry: &Registry) -> Outcome<SourceFile> {
    let file = Path::new(given);
    match registry.spec(given) {
        Some(text) => Ok(SourceFile::new(format!("{given}.yaml"), text)),
        None if given == STANDARD_INPUT => open(file, SPEC),
        None if file.extension().is_some() || file.exists() => open(file, SPEC),
        // Neither: the message names the most similar crane.
        None => registry
            .crane(given)
            .and_then(|_| Err(Problem::failed(format!("the spec of {given} is not available"), ""))),
    }
}

/// The chain of a shipped crane or of a YAML file, and its text; warnings are shown, and are mistakes if `strict`.
pub(super) fn load_named(given: &str, strict: bool, registry: &Registry) -> Outcome<(Chain, String)> {
    parse(source(given, registry)?, strict)
}

/// Prints the chain of a spec, and draws it on request.
pub fn explain(options: &Explain, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let (chain, _) = load_named(&options.spec, false, registry)?;
    if let Some(file) = &options.svg {
        files::write_text(file, &picture(&chain))?;
    }
    let report = options.operations.then(|| working(&chain, || compile::report(&chain, chain.analyses)));
    Ok(out.write_all(explain::explain(&chain, report.as_ref()).as_bytes())?)
}

/// Does what may take long for a large crane, and says so.
pub(super) fn working<T>(chain: &Chain, work: impl FnOnce() -> T) -> T {
    /// From here on it takes more than some seconds.
    const LARGE: usize = 300;
    let count = chain.coordinates.len();
    if count < LARGE {
        return work();
    }
    screen::remark(&format!("{} has {count} coordinates: this may take minutes; Ctrl-C ends it", chain.name));
    let bar = ProgressBar::new_spinner().with_message("deriving");
    bar.enable_steady_tick(Duration::from_millis(200));
    let done = work();
    bar.finish_and_clear();
    done
}

/// Does what the arguments of this process ask for, with the chosen crane as machine code.
pub fn compiled(choice: &Choice, registry: &Registry) -> Outcome<()> {
    let (Chain { name, spec_hash, .. }, text) = match (choice.file(), registry.spec(&choice.name)) {
        (None, Some(spec)) => parse(SourceFile::new(format!("{}.yaml", choice.name), spec.to_owned()), choice.strict)?,
        (None, None) => return registry.crane(&choice.name).map(|_| ()),
        (Some(file), _) => load(file, choice.strict)?,
    };
    let package = format!("crane-{name}-{spec_hash}");
    run_with(&COMMAND, &package, OsStr::new(&choice.name), &[(name, text)])
}

/// Runs a library in the program of several cranes, given by names and specs; the first one replaces `named`.
///
/// # Errors
/// Cargo is missing or fails, or files cannot be written; the program reports its own errors.
pub fn run_with(library: &Library, package: &str, named: &OsStr, cranes: &[(String, String)]) -> Outcome<()> {
    let mut place = cranes.first().map(|(name, _)| OsString::from(name));
    let arguments: Vec<OsString> = env::args_os()
        .skip(1)
        .filter(|argument| argument != "--compile")
        .map(|argument| match place.take_if(|_| argument == *named) {
            Some(name) => name,
            None => argument,
        })
        .collect();
    let package = Package { product: Product::Program, library, name: package, cranes };
    package::run(&package, |command| {
        command.args(&arguments).env(AS_TYPED, typed()).env(files::READ_BEFORE, files::read_before());
    })
}

/// The shared library of functional mock-up units of a crane as machine code: the kept one, or one that is compiled now.
pub fn unit(chain: &Chain, spec: &str) -> Outcome<PathBuf> {
    let Chain { name, spec_hash, .. } = chain;
    let cranes = [(name.clone(), spec.to_owned())];
    let package = format!("crane-fmu-{name}-{spec_hash}");
    let package = Package { product: Product::Unit, library: &UNITS, name: &package, cranes: &cranes };
    package.kept()?.map_or_else(|| package.compiled(), Ok)
}

/// The command as it was typed.
pub fn typed() -> String {
    env::var(AS_TYPED).unwrap_or_else(|_| {
        let arguments: Vec<String> = env::args().skip(1).collect();
        format!("crane {}", arguments.join(" "))
    })
}

/// A valid chain and its text, or every mistake. Warnings are printed, and are mistakes if `strict`.
///
/// # Errors
/// The file cannot be read, or the spec has mistakes.
pub fn load(spec: &Path, strict: bool) -> Outcome<(Chain, String)> {
    parse(open(spec, SPEC)?, strict)
}

/// A valid chain and its text, or every mistake; warnings are printed, and are mistakes if `strict`.
fn parse(source: SourceFile, strict: bool) -> Outcome<(Chain, String)> {
    let Checked { chain, warnings } = compile::check(&source).map_err(Problem::mistakes)?;
    if !warnings.is_empty() {
        screen::warn(&warnings);
        if strict {
            return Err(Problem::Elsewhere(FAILED));
        }
    }
    Ok((chain, source.text))
}

/// Shows warnings about a crane that appear only with these values of its parameters; returns them as a problem if there are any.
pub(super) fn warn_of(source: &SourceFile, set: &[(String, f64)]) -> Option<Problem> {
    let set: Vec<(&str, f64)> = set.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    let known = compile::check(source).ok()?.warnings;
    let added = compile::check_with(source, &set).ok()?.warnings.without(&known);
    (!added.is_empty()).then(|| {
        screen::warn(&added);
        Problem::Elsewhere(FAILED)
    })
}

/// A file of text, or the standard input; `help`: what kind of file to name.
pub(super) fn open(file: &Path, help: &str) -> Outcome<SourceFile> {
    let read = if file == Path::new(STANDARD_INPUT) {
        build::read_with("standard input", io::stdin(), &crane_specs::spec).map(|source| (source, Vec::new()))
    } else {
        build::open_with_files(file, &crane_specs::spec)
    };
    let (source, read) = read.map_err(|failure| match failure {
        build::Failure::File(message) => Problem::failed(message, help),
        build::Failure::Mistakes(mistakes) => Problem::mistakes(mistakes),
    })?;
    read.iter().for_each(|file| files::remember(file));
    Ok(source)
}
