//! A crane of a YAML file: checked here, compiled by cargo to a program of its own, which is kept and does the rest.

use std::{
    env,
    ffi::{OsStr, OsString},
    fs,
    io::Write,
    path::{Path, PathBuf},
    process::Command,
    time::{Instant, SystemTime},
};

use crane_codegen::{Checked, Diagnostics, SourceFile, build, chain::Chain, compile, explain, picture::picture};

use crate::{
    Fleet,
    arguments::Choice,
    files,
    problem::{FAILED, Outcome, Problem},
};

/// Where this program was built from: the crate of the command, which the program of a crane depends on.
const CLI: &str = env!("CARGO_MANIFEST_DIR");
/// The versions of everything that this program was built with.
const LOCK: &str = include_str!("../../../Cargo.lock");
/// Files of the program, and what they are made from.
const FILES: [(&str, &str); 3] = [
    ("Cargo.toml", include_str!("own/Cargo.toml.template")),
    ("build.rs", include_str!("own/build.rs.template")),
    ("src/main.rs", include_str!("own/main.rs.template")),
];
/// Variable of the environment with the folder where programs are kept.
const CACHE: &str = "CRANE_CACHE";
/// Variable of the environment that tells a crane's own program what was typed.
const AS_TYPED: &str = "CRANE_AS_TYPED";

/// Root of the workspace that this program was built from.
pub fn root() -> &'static Path {
    Path::new(CLI).ancestors().nth(2).unwrap_or(Path::new(CLI))
}

/// Says whether a spec is sound.
pub fn check(spec: &Path, strict: bool, out: &mut dyn Write) -> Outcome<()> {
    let Chain { name, bodies, coordinates, spec_hash, .. } = load(spec, strict)?.0;
    let (bodies, coordinates) = (bodies.len(), coordinates.len());
    Ok(writeln!(out, "{name}: sound; {bodies} bodies, {coordinates} coordinates, spec hash {spec_hash}")?)
}

/// Prints the chain of a spec, and draws it where that is asked for.
pub fn explain(spec: &Path, svg: Option<&Path>, out: &mut dyn Write) -> Outcome<()> {
    let (chain, _) = load(spec, false)?;
    if let Some(file) = svg {
        files::write_text(file, &picture(&chain))?;
    }
    let report = compile::report(&chain, chain.analyses);
    Ok(out.write_all(explain::explain(&chain, &report).as_bytes())?)
}

/// Does what the arguments of this process ask for, with the chosen crane as machine code.
pub fn compiled(choice: &Choice, fleet: &Fleet) -> Outcome<()> {
    let (Chain { name, spec_hash, .. }, text) = match (choice.file(), fleet.spec(&choice.name)) {
        (None, Some(spec)) => parse(SourceFile::new(format!("{}.yaml", choice.name), spec.to_owned()), choice.strict)?,
        (None, None) => return fleet.crane(&choice.name).map(|_| ()),
        (Some(file), _) => load(file, choice.strict)?,
    };
    let package = format!("crane-{name}-{spec_hash}");
    run_with(&package, OsStr::new(&choice.name), &[(name, text)])
}

/// The same with the program of several cranes, names and specs; the first one stands in place of `named`.
pub fn run_with(package: &str, named: &OsStr, cranes: &[(String, String)]) -> Outcome<()> {
    let program = program(package, cranes)?;
    let mut place = cranes.first().map(|(name, _)| OsString::from(name));
    let arguments = env::args_os().skip(1).filter(|argument| argument != "--compile").map(|argument| {
        match place.take_if(|_| argument == *named) {
            Some(name) => name,
            None => argument,
        }
    });
    finish(Command::new(&program).args(arguments).env(AS_TYPED, typed()))
}

/// The command as it was typed.
pub fn typed() -> String {
    env::var(AS_TYPED).unwrap_or_else(|_| {
        let arguments: Vec<String> = env::args().skip(1).collect();
        format!("crane {}", arguments.join(" "))
    })
}

/// A sound chain and its text, or every mistake. Warnings are drawn; `strict`: they are mistakes.
pub(super) fn load(spec: &Path, strict: bool) -> Outcome<(Chain, String)> {
    // The name of a shipped crane, or a file without its extension.
    let meant = root().join("specs").join(spec).with_extension("yaml");
    let help = if meant != spec && meant.exists() {
        format!("did you mean {}?", meant.display())
    } else {
        "name a YAML file that describes a crane".to_owned()
    };
    parse(open(spec, &help)?, strict)
}

/// A sound chain and its text, or every mistake; warnings are drawn, and are mistakes if `strict`.
fn parse(source: SourceFile, strict: bool) -> Outcome<(Chain, String)> {
    let Checked { chain, warnings } = compile::check(&source).map_err(|mistakes| drawn(&mistakes))?;
    if !warnings.is_empty() {
        let problem = drawn(&warnings);
        if strict {
            return Err(problem);
        }
    }
    Ok((chain, source.text))
}

/// A file of text; `help`: what kind of file to name.
pub(super) fn open(file: &Path, help: &str) -> Outcome<SourceFile> {
    build::open(file).map_err(|failure| match failure {
        build::Failure::File(message) => Problem::failed(message, help),
        build::Failure::Mistakes(mistakes) => drawn(&mistakes),
    })
}

/// Draws mistakes or warnings on standard error.
pub(super) fn drawn(mistakes: &Diagnostics) -> Problem {
    // Drawn already; a reader of standard error that has gone misses it.
    let _ = writeln!(std::io::stderr(), "{}", mistakes.to_string().trim_end());
    Problem::Elsewhere(FAILED)
}

/// The program of some cranes: as kept, or compiled now.
fn program(package: &str, cranes: &[(String, String)]) -> Outcome<PathBuf> {
    let cache = cache();
    let folder = cache.join(package);
    let joined = |of: &dyn Fn(&str) -> String| cranes.iter().map(|(name, _)| of(name)).collect::<Vec<_>>().join(", ");
    let names = joined(&str::to_owned);
    let [model, codegen] = ["crane-model", "codegen"].map(|folder| root().join(folder));
    let values = [
        ("{{package}}", package),
        ("{{names}}", &names),
        ("{{files}}", &joined(&|name| format!("\"{name}.yaml\""))),
        ("{{specs}}", &joined(&|name| format!("(\"{name}\", include_str!(\"../{name}.yaml\"))"))),
        ("{{yardstick}}", if cfg!(feature = "yardstick") { ", features = [\"yardstick\"]" } else { "" }),
        ("{{cli}}", CLI),
        ("{{model}}", &model.to_string_lossy()),
        ("{{codegen}}", &codegen.to_string_lossy()),
    ];
    for (file, template) in FILES {
        let content = values.iter().fold(template.to_owned(), |text, (place, value)| text.replace(place, value));
        keep(&folder.join(file), &content)?;
    }
    for (name, text) in cranes {
        keep(&folder.join(name).with_extension("yaml"), text)?;
    }
    if !folder.join("Cargo.lock").exists() {
        keep(&folder.join("Cargo.lock"), LOCK)?;
    }

    let target = target().unwrap_or_else(|| cache.join("target"));
    let program = target.join("release").join(package).with_extension(env::consts::EXE_EXTENSION);
    let begin = Instant::now();
    let before = modified(&program);
    if before.is_none() {
        say(&format!("{names}: compiling to a program of its own, kept for later …"));
    }
    let cargo = env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut build = Command::new(cargo);
    build.args(["build", "--release", "--quiet", "--manifest-path"]).arg(folder.join("Cargo.toml"));
    build.arg("--target-dir").arg(&target);
    finish(&mut build)?;
    let how = if modified(&program) == before { "kept from before, current" } else { "compiled" };
    say(&format!("{names}: {how}, {:.1} s", begin.elapsed().as_secs_f64()));
    Ok(program)
}

/// Writes a file unless it says so already: what is newer is compiled again.
fn keep(file: &Path, text: &str) -> Outcome<()> {
    if fs::read_to_string(file).is_ok_and(|kept| kept == text) {
        return Ok(());
    }
    files::folder(file.parent().unwrap_or(file))?;
    files::write_text(file, text)
}

/// Folder where programs are kept.
fn cache() -> PathBuf {
    let variable = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    variable(CACHE)
        .or_else(|| variable("XDG_CACHE_HOME").map(|cache| cache.join("crane")))
        .or_else(|| variable("HOME").map(|home| home.join(".cache/crane")))
        .unwrap_or_else(|| env::temp_dir().join("crane"))
}

/// Cargo's folder that this program stands in: what is built there serves again.
fn target() -> Option<PathBuf> {
    let program = env::current_exe().ok()?;
    let profile = program.parent()?;
    let target = profile.parent()?;
    (profile.file_name() == Some(OsStr::new("release")) && target.join("CACHEDIR.TAG").exists())
        .then(|| target.to_owned())
}

fn modified(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|metadata| metadata.modified()).ok()
}

/// Tells the user something beside the results.
fn say(text: &str) {
    // Not eprintln: it panics where standard error is closed.
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Runs a program to its end, which is ours too.
fn finish(command: &mut Command) -> Outcome<()> {
    let name = command.get_program().display().to_string();
    let status = command.status().map_err(|error| {
        Problem::failed(format!("cannot run {name}: {error}"), "install Rust, so that `cargo` is on the path")
    })?;
    let code = status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(FAILED);
    if code == 0 { Ok(()) } else { Err(Problem::Elsewhere(code)) }
}
