//! Programs and shared libraries of compiled cranes: built by cargo, kept in a folder of the user's, used again without cargo.

use std::{
    env,
    env::consts,
    ffi::OsStr,
    fs::{self, File, TryLockError},
    io::{self, IsTerminal},
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::{Instant, UNIX_EPOCH},
};

use super::{LOCK, Library, root};
use crate::{
    files,
    problem::{FAILED, Outcome, Problem},
    screen::Console,
};

/// Files of every crate, and what they are made from.
const FILES: [(&str, &str); 2] =
    [("Cargo.toml", include_str!("Cargo.toml.template")), ("build.rs", include_str!("build.rs.template"))];
/// In the manifest of a shared library.
const SHARED_LIBRARY: &str = "\n[lib]\ncrate-type = [\"cdylib\"]\n";
/// In its build script: leaves out what only a debugger reads, as in the library of live cranes.
const STRIP: &str = r#"
    if cfg!(target_os = "linux") {
        println!("cargo::rustc-link-arg-cdylib=-Wl,--strip-debug");
    }"#;
/// Environment variable with the folder where programs are kept.
const CACHE: &str = "CRANE_CACHE";
/// File that says which `crane` compiled the program beside it; written last, so that no half-built program counts.
const STAMP: &str = "compiled-by";

/// What cargo makes of a crate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Product {
    /// A program over a registry of the cranes.
    Program,
    /// The shared library of a functional mock-up unit, with one crane.
    Unit,
}

impl Product {
    /// What it is called in messages, and in the folder where it is kept.
    fn name(self) -> &'static str {
        match self {
            Product::Program => "program",
            Product::Unit => "library",
        }
    }

    /// The source file of the crate, and what it is made from.
    fn source(self) -> (&'static str, &'static str) {
        match self {
            Product::Program => ("src/main.rs", include_str!("main.rs.template")),
            Product::Unit => ("src/lib.rs", include_str!("unit.rs.template")),
        }
    }

    /// Name of the file that cargo makes of a package.
    fn file(self, package: &str) -> String {
        match self {
            Product::Program => format!("{package}{}", consts::EXE_SUFFIX),
            Product::Unit => format!("{}{}{}", consts::DLL_PREFIX, package.replace('-', "_"), consts::DLL_SUFFIX),
        }
    }

    /// Name of the file that is kept.
    fn kept(self) -> String {
        let suffix = if self == Product::Program { consts::EXE_SUFFIX } else { consts::DLL_SUFFIX };
        format!("{}{suffix}", self.name())
    }
}

/// A crate of compiled cranes.
pub struct Package<'a> {
    /// Of the command that needs it.
    pub console: &'a Console,
    /// What cargo makes of it.
    pub product: Product,
    /// The library that it runs or exports.
    pub library: &'a Library,
    /// Its name, another one for other specs.
    pub name: &'a str,
    /// Names and specs of its cranes.
    pub cranes: &'a [(String, String)],
}

/// Runs the program of some cranes: the kept one, or one that is compiled now.
pub fn run_package(package: &Package<'_>, arguments: impl Fn(&mut Command)) -> Outcome<()> {
    if let Some(program) = package.kept()? {
        if let Some(outcome) = start(&program, &arguments) {
            return outcome;
        }
        package.console.tell(&format!("{}: the kept program does not start; compiling it again", package.names()));
    }
    let program = package.compiled()?;
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
    Some(if code == 0 { Ok(()) } else { Err(Problem::AlreadyReported { exit_code: code }) })
}

impl Package<'_> {
    /// What was compiled earlier.
    pub fn kept(&self) -> Outcome<Option<PathBuf>> {
        let folder = cache()?.join(self.name);
        let file = folder.join(self.product.kept());
        let kept = file.exists() && fs::read_to_string(folder.join(STAMP)).is_ok_and(|stamp| stamp == this_command());
        if kept {
            self.console.tell(&format!("{}: compiled earlier, kept in {}", self.names(), folder.display()));
        }
        Ok(kept.then_some(file))
    }

    /// Compiles it, and keeps what cargo has made.
    pub fn compiled(&self) -> Outcome<PathBuf> {
        let begin = Instant::now();
        let cache = cache()?;
        let folder = cache.join(self.name);
        let lock = wait_for_other_compiles(self.console, &cache)?;
        // Even if another command has compiled it meanwhile: that program may be the one that does not start.
        let built = self.build(&cache, lock)?;
        let file = folder.join(self.product.kept());
        let _ = fs::remove_file(folder.join(STAMP));
        copy(&built, &file)?;
        self.console.write_text(&folder.join(STAMP), &this_command())?;
        self.console.tell(&format!("{}: compiled in {:.1} s", self.names(), begin.elapsed().as_secs_f64()));
        Ok(file)
    }

    /// Names of its cranes, for messages.
    fn names(&self) -> String {
        self.cranes.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ")
    }

    /// Builds it with cargo; returns the file that cargo made.
    ///
    /// The lock passes to cargo: should this command be killed, it lasts until cargo has ended too.
    fn build(&self, cache: &Path, lock: File) -> Outcome<PathBuf> {
        let Self { console, product, library, name: package, cranes } = *self;
        if !root().join("crane-model").exists() {
            let title = format!("the source of `crane` is no longer at {}", root().display());
            return Err(Problem::failed(title, "build `crane` again from its new location, or omit --compile"));
        }
        let folder = cache.join(package);
        let joined =
            |of: &dyn Fn(&str) -> String| cranes.iter().map(|(name, _)| of(name)).collect::<Vec<_>>().join(", ");
        let names = self.names();
        let features = library.features.iter().map(|feature| format!("\"{feature}\"")).collect::<Vec<_>>().join(", ");
        let [model, codegen] = ["crane-model", "codegen"].map(|folder| root().join(folder));
        let [manifest, link] = if product == Product::Unit { [SHARED_LIBRARY, STRIP] } else { ["", ""] };
        let values = [
            ("{{package}}", package),
            ("{{names}}", &names),
            ("{{files}}", &joined(&|name| format!("\"{name}.yaml\""))),
            ("{{specs}}", &joined(&|name| format!("(\"{name}\", include_str!(\"../{name}.yaml\"))"))),
            ("{{library}}", library.name),
            ("{{library_module}}", &library.name.replace('-', "_")),
            ("{{folder}}", library.folder),
            ("{{features}}", &features),
            ("{{model}}", &model.to_string_lossy()),
            ("{{codegen}}", &codegen.to_string_lossy()),
            ("{{manifest}}", manifest),
            ("{{link}}", link),
        ];
        for (file, template) in FILES.into_iter().chain([product.source()]) {
            let content =
                values.iter().fold(template.to_owned(), |text, (placeholder, value)| text.replace(placeholder, value));
            keep(console, &folder.join(file), &content)?;
        }
        for (name, text) in cranes {
            keep(console, &folder.join(name).with_extension("yaml"), text)?;
        }
        keep(console, &folder.join("Cargo.lock"), LOCK)?;

        let target = target().unwrap_or_else(|| cache.join("target"));
        console.tell(&format!("{names}: compiling; the {} is kept for later", product.name()));
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
        Ok(target.join("release").join(product.file(package)))
    }
}

/// Takes the lock of the cache, with a message if another command holds it.
fn wait_for_other_compiles(console: &Console, cache: &Path) -> Outcome<File> {
    files::folder(cache)?;
    let path = cache.join("compiling");
    let failed = |error: io::Error| Problem::file(&path, &error);
    let file = File::options().create(true).truncate(false).read(true).write(true).open(&path).map_err(failed)?;
    match file.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            console.tell("waiting for another compilation to finish");
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
fn keep(console: &Console, file: &Path, text: &str) -> Outcome<()> {
    if fs::read_to_string(file).is_ok_and(|kept| kept == text) {
        return Ok(());
    }
    files::folder(file.parent().unwrap_or(file))?;
    console.write_text(file, text)
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
