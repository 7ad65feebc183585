//! Programs of compiled cranes: built by cargo, kept in a folder of the user's, run again without cargo.

use std::{
    env,
    ffi::OsStr,
    fs::{self, File, TryLockError},
    io::{self, IsTerminal, Write},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::{Instant, UNIX_EPOCH},
};

use super::{LOCK, Library, root};
use crate::{
    files,
    problem::{FAILED, Outcome, Problem},
};

/// Files of a program, and what they are made from.
const FILES: [(&str, &str); 3] = [
    ("Cargo.toml", include_str!("Cargo.toml.template")),
    ("build.rs", include_str!("build.rs.template")),
    ("src/main.rs", include_str!("main.rs.template")),
];
/// Environment variable with the folder where programs are kept.
const CACHE: &str = "CRANE_CACHE";
/// File that says which `crane` compiled the program beside it; written last, so that no half-built program counts.
const STAMP: &str = "compiled-by";

/// Runs the program of some cranes, given by names and specs: the kept one, or one that is compiled now.
pub fn run(
    library: &Library,
    package: &str,
    cranes: &[(String, String)],
    arguments: impl Fn(&mut Command),
) -> Outcome<()> {
    let cache = cache()?;
    let folder = cache.join(package);
    let program = folder.join("program").with_extension(env::consts::EXE_EXTENSION);
    let names = cranes.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
    let kept = || program.exists() && fs::read_to_string(folder.join(STAMP)).is_ok_and(|stamp| stamp == this_command());
    if kept() {
        say(&format!("{names}: compiled earlier, kept in {}", folder.display()));
        if let Some(outcome) = start(&program, &arguments) {
            return outcome;
        }
        say(&format!("{names}: the kept program does not start; compiling it again"));
    }
    let begin = Instant::now();
    let lock = wait_for_other_compiles(&cache)?;
    // Even if another command has compiled it meanwhile: that program may be the one that does not start.
    let built = compile(library, package, cranes, &cache, lock)?;
    let _ = fs::remove_file(folder.join(STAMP));
    copy(&built, &program)?;
    files::write_text(&folder.join(STAMP), &this_command())?;
    say(&format!("{names}: compiled in {:.1} s", begin.elapsed().as_secs_f64()));
    start(&program, &arguments).unwrap_or_else(|| {
        let title = format!("the compiled program {} does not start", program.display());
        Err(Problem::failed(title, "check that programs may run in this folder, or set CRANE_CACHE to another folder"))
    })
}

/// Runs a program to its end and takes over its exit code; `None` if it does not start.
fn start(program: &Path, arguments: &impl Fn(&mut Command)) -> Option<Outcome<()>> {
    let mut command = Command::new(program);
    arguments(&mut command);
    let code = command.status().ok()?.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(FAILED);
    Some(if code == 0 { Ok(()) } else { Err(Problem::Elsewhere(code)) })
}

/// Builds the program with cargo; returns the file that cargo made.
///
/// The lock passes to cargo: should this command be killed, it lasts until cargo has ended too.
fn compile(
    library: &Library,
    package: &str,
    cranes: &[(String, String)],
    cache: &Path,
    lock: File,
) -> Outcome<PathBuf> {
    if !root().join("crane-model").exists() {
        let title = format!("the source of `crane` is no longer at {}", root().display());
        return Err(Problem::failed(title, "build `crane` again from its new location, or omit --compile"));
    }
    let folder = cache.join(package);
    let joined = |of: &dyn Fn(&str) -> String| cranes.iter().map(|(name, _)| of(name)).collect::<Vec<_>>().join(", ");
    let names = &joined(&str::to_owned);
    let features = library.features.iter().map(|feature| format!("\"{feature}\"")).collect::<Vec<_>>().join(", ");
    let [model, codegen] = ["crane-model", "codegen"].map(|folder| root().join(folder));
    let values = [
        ("{{package}}", package),
        ("{{names}}", names),
        ("{{files}}", &joined(&|name| format!("\"{name}.yaml\""))),
        ("{{specs}}", &joined(&|name| format!("(\"{name}\", include_str!(\"../{name}.yaml\"))"))),
        ("{{library}}", library.name),
        ("{{library_module}}", &library.name.replace('-', "_")),
        ("{{folder}}", library.folder),
        ("{{features}}", &features),
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
    keep(&folder.join("Cargo.lock"), LOCK)?;

    let target = target().unwrap_or_else(|| cache.join("target"));
    say(&format!("{names}: compiling; the program is kept for later runs"));
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut build = Command::new(&cargo);
    build.args(["build", "--release", "--manifest-path"]).arg(folder.join("Cargo.toml"));
    build.arg("--target-dir").arg(&target).stdin(Stdio::from(lock)).stdout(Stdio::null());
    // In a terminal, cargo shows its own progress bar.
    if !io::stderr().is_terminal() {
        build.arg("--quiet");
    }
    let status = build.status().map_err(|error| {
        Problem::failed(
            format!("cannot run {}: {error}", cargo.display()),
            "omit --compile, which needs a compiler, or install Rust so that `cargo` is on the path",
        )
    })?;
    if !status.success() {
        return Err(Problem::failed(format!("{names} was not compiled: cargo ended with {status}"), ""));
    }
    Ok(target.join("release").join(package).with_extension(env::consts::EXE_EXTENSION))
}

/// Takes the lock of the cache, with a message if another command holds it.
fn wait_for_other_compiles(cache: &Path) -> Outcome<File> {
    files::folder(cache)?;
    let path = cache.join("compiling");
    let failed = |error: io::Error| Problem::file(&path, &error);
    let file = File::options().create(true).truncate(false).read(true).write(true).open(&path).map_err(failed)?;
    match file.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            say("waiting for another compilation to finish");
            file.lock().map_err(failed)?;
        }
        Err(TryLockError::Error(error)) => return Err(failed(error)),
    }
    Ok(file)
}

/// Copies a program, completely or not at all.
fn copy(from: &Path, to: &Path) -> Outcome<()> {
    let part = to.with_extension("part");
    let copied = fs::copy(from, &part).and_then(|_| fs::rename(&part, to));
    copied.map_err(|error| {
        let _ = fs::remove_file(&part);
        Problem::file(to, &error)
    })
}

/// What distinguishes this build of the command from others.
fn this_command() -> String {
    let modified = env::current_exe().and_then(fs::metadata).and_then(|metadata| metadata.modified());
    let modified = modified.ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok()).unwrap_or_default();
    format!("crane {}, built {}.{:09}\n", env!("CARGO_PKG_VERSION"), modified.as_secs(), modified.subsec_nanos())
}

/// Writes a file unless it already has this text: cargo compiles again what is newer.
fn keep(file: &Path, text: &str) -> Outcome<()> {
    if fs::read_to_string(file).is_ok_and(|kept| kept == text) {
        return Ok(());
    }
    files::folder(file.parent().unwrap_or(file))?;
    files::write_text(file, text)
}

/// Folder where programs are kept: never one where other users may write.
fn cache() -> Outcome<PathBuf> {
    let variable = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    variable(CACHE)
        .or_else(|| variable("XDG_CACHE_HOME").map(|cache| cache.join("crane")))
        .or_else(|| variable("HOME").map(|home| home.join(".cache/crane")))
        .ok_or_else(|| {
            let title = "no folder for compiled cranes: HOME is not set";
            Problem::failed(title, format!("set {CACHE} to a folder of your own, or omit --compile"))
        })
}

/// Cargo's target folder that contains this program, so that its builds can be reused.
fn target() -> Option<PathBuf> {
    let program = env::current_exe().ok()?;
    let profile = program.parent()?;
    let target = profile.parent()?;
    (profile.file_name() == Some(OsStr::new("release")) && target.join("CACHEDIR.TAG").exists())
        .then(|| target.to_owned())
}

/// Tells the user something that is not part of the results.
fn say(text: &str) {
    // Not eprintln: it panics where standard error is closed.
    let _ = writeln!(io::stderr(), "{text}");
}
