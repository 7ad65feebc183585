//! Entry point for build scripts: compiles a spec while a user's crate is built.
//!
//! This is the only module that reads the environment, accesses files and ends the process.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::{env, fmt, fs, io, process};

use crate::GeneratedCode;
use crate::chain::Analyses;
use crate::compile::{self, Compiled};
use crate::diagnostic::{Diagnostics, MAX_BYTES, SourceFile};

/// Compiles `spec` into `$OUT_DIR/<name of the crane>.rs`, to be included into a module:
///
/// ```ignore
/// // build.rs
/// fn main() {
///     crane_codegen::build::compile_spec("my_crane.yaml");
/// }
///
/// // src/main.rs
/// #[allow(dead_code, clippy::all)]
/// mod my_crane {
///     include!(concat!(env!("OUT_DIR"), "/my_crane.rs"));
/// }
/// ```
///
/// Cargo runs the build script again when the spec changes. A spec with mistakes ends the build and shows every mistake;
/// implausible numbers become warnings of the build.
pub fn compile_spec(spec: impl AsRef<Path>) -> GeneratedCode {
    compile_spec_for(spec, None)
}

/// Like [`compile_spec`], with other analyses than those of the spec.
pub fn compile_spec_for(spec: impl AsRef<Path>, analyses: Option<Analyses>) -> GeneratedCode {
    let spec = spec.as_ref();
    println!("cargo::rerun-if-changed={}", spec.display());
    let Compiled { code, warnings } = open(spec)
        .and_then(|source| compile::compile(&source, analyses).map_err(Failure::Mistakes))
        .unwrap_or_else(|error| error.fail());
    for warning in warnings.lines().chain(code.report.warning(&code.name)) {
        println!("cargo::warning={warning}");
    }
    let target = out_dir().join(format!("{}.rs", code.name));
    write(&target, &code.text).unwrap_or_else(|error| fail(&format!("{}: {error}", target.display()), ""));
    code
}

/// Reads a spec; a file that is too large is not read completely.
///
/// # Errors
/// Errors of the file system, and a file that is too large or not text.
pub fn open(spec: &Path) -> Result<SourceFile, Failure> {
    let name = spec.display().to_string();
    let failed = |error: io::Error| Failure::File(format!("{name}: {error}"));
    let mut bytes = Vec::new();
    let limit = u64::try_from(MAX_BYTES).unwrap_or(u64::MAX).saturating_add(1);
    fs::File::open(spec).map_err(failed)?.take(limit).read_to_end(&mut bytes).map_err(failed)?;
    SourceFile::from_bytes(name.clone(), &bytes).map_err(Failure::Mistakes)
}

/// Why a spec could not be opened or compiled.
#[derive(Debug)]
pub enum Failure {
    /// The file system refused.
    File(String),
    /// The spec has mistakes.
    Mistakes(Diagnostics),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::File(message) => f.write_str(message),
            Failure::Mistakes(mistakes) => mistakes.fmt(f),
        }
    }
}

impl std::error::Error for Failure {}

impl Failure {
    fn fail(&self) -> ! {
        match self {
            Failure::File(message) => fail(message, ""),
            Failure::Mistakes(mistakes) => fail(&mistakes.headline(), &mistakes.to_string()),
        }
    }
}

/// The build script's output directory.
pub fn out_dir() -> PathBuf {
    env::var_os("OUT_DIR").map_or_else(|| fail("OUT_DIR is set by cargo in build scripts only", ""), PathBuf::from)
}

/// Writes a file completely or not at all.
///
/// # Errors
/// Errors of the file system.
pub fn write(target: &Path, text: &str) -> io::Result<()> {
    let mut name = target.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.unfinished", process::id()));
    let unfinished = target.with_file_name(name);
    fs::write(&unfinished, text)?;
    fs::rename(&unfinished, target)
}

/// Cargo shows one line of an error, so the headline goes there and the full report to standard error.
fn fail(headline: &str, drawn: &str) -> ! {
    eprintln!("{drawn}");
    println!("cargo::error={headline}");
    process::exit(1)
}
