//! Entry point for build scripts: compiles a spec while a user's crate is built.
//!
//! This is the only module that reads the environment and ends the process; it accesses files through [`files`].

use std::io::Read;
use std::path::{Path, PathBuf};
use std::{env, fmt, io, process};

use crate::GeneratedCode;
use crate::chain::Analyses;
use crate::compile::{self, Compiled};
use crate::diagnostic::{Diagnostics, MAX_BYTES, SourceFile, rule};
use crate::files;
use crate::read::{base, data_files};

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

/// Like [`compile_spec`], with analyses other than those of the spec.
pub fn compile_spec_for(spec: impl AsRef<Path>, analyses: Option<Analyses>) -> GeneratedCode {
    let spec = spec.as_ref();
    println!("cargo::rerun-if-changed={}", spec.display());
    let compiled = load_with_bases(spec, &|_| None).and_then(|(source, bases)| {
        for base in bases {
            println!("cargo::rerun-if-changed={}", base.display());
        }
        compile::compile(&source, analyses).map_err(Failure::Mistakes)
    });
    let Compiled { code, warnings } = compiled.unwrap_or_else(|error| error.fail());
    for warning in warnings.lines().chain(code.report.warning(&code.name)) {
        println!("cargo::warning={warning}");
    }
    let target = out_dir().join(format!("{}.rs", code.name));
    write_text(&target, &code.text).unwrap_or_else(|error| fail(&format!("{}: {error}", target.display()), ""));
    code
}

/// Reads a spec and the specs that it extends; a file that is too large is not read completely.
///
/// # Errors
/// Errors of the file system, a file that is too large or not text, and an extended spec that cannot be read.
pub fn open(spec: &Path) -> Result<SourceFile, Failure> {
    open_with(spec, &|_| None)
}

/// Like [`open`]; `shipped` returns the texts of cranes that are extended by name.
///
/// # Errors
/// Those of [`open`].
pub fn open_with(spec: &Path, shipped: &dyn Fn(&str) -> Option<&'static str>) -> Result<SourceFile, Failure> {
    Ok(load_with_bases(spec, shipped)?.0)
}

/// Like [`open_with`]; returns also the files that it was read from: the spec, the specs that it extends, and their data.
///
/// # Errors
/// Those of [`open`].
pub fn open_with_files(
    spec: &Path,
    shipped: &dyn Fn(&str) -> Option<&'static str>,
) -> Result<(SourceFile, Vec<PathBuf>), Failure> {
    let (source, mut files) = load_with_bases(spec, shipped)?;
    files.push(spec.to_owned());
    Ok((source, files))
}

/// Reads a spec from a stream, such as the standard input, called `name` in messages; specs that it extends are looked up
/// from the working folder or among those that are `shipped`.
///
/// # Errors
/// Those of [`open`].
pub fn read_with(
    name: &str,
    stream: impl Read,
    shipped: &dyn Fn(&str) -> Option<&'static str>,
) -> Result<SourceFile, Failure> {
    Ok(with_bases(name.to_owned(), read_single(name, stream)?, PathBuf::new(), shipped)?.0)
}

/// Maximum number of specs that one extends, directly and through others.
const MOST_BASES: usize = 64;

/// A spec combined with the specs that it extends, and the files of the latter.
fn load_with_bases(
    spec: &Path,
    shipped: &dyn Fn(&str) -> Option<&'static str>,
) -> Result<(SourceFile, Vec<PathBuf>), Failure> {
    // The text must not depend on where the file is.
    let named = spec.file_name().unwrap_or_default().to_string_lossy().into_owned();
    with_bases(named, open_single(spec)?, folder(spec), shipped)
}

fn folder(file: &Path) -> PathBuf {
    file.parent().map(Path::to_owned).unwrap_or_default()
}

/// Like [`load_with_bases`], for a spec that has already been read; the specs that it extends are looked up `from` a folder.
fn with_bases(
    named: String,
    spec: SourceFile,
    mut from: PathBuf,
    shipped: &dyn Fn(&str) -> Option<&'static str>,
) -> Result<(SourceFile, Vec<PathBuf>), Failure> {
    let nothing = format!("{}: nothing to read", spec.name);
    let mut files = Vec::new();
    let spec = with_data(spec, &named, &from, &mut files)?;
    let mut extends_chain = vec![(named, spec)];
    while let Some((name, span)) = extends_chain.last().and_then(|(_, source)| base(source)) {
        let refused = |problem: &str| {
            let source = &extends_chain[extends_chain.len() - 1].1;
            Failure::Mistakes(Diagnostics::new(source, vec![rule::no_base(span, &name, problem)]))
        };
        let file = from.join(&name);
        if files.iter().any(|known| files::is_same(known, &file)) {
            return Err(refused("specs extend each other in a circle"));
        }
        if extends_chain.len() > MOST_BASES {
            return Err(refused(&format!("more than {MOST_BASES} specs extend one another: join some of them")));
        }
        let source = if file.exists() && !file.is_dir() {
            let source = open_single(&file).map_err(|failure| refused(&failure.to_string()))?;
            // A file that is none may be one that its owner does not want to show: no message repeats its lines.
            if !is_spec(&source.text) {
                return Err(refused(
                    "it is not the spec of a crane: no line of it begins with `format:`, `extends:` or `links:`",
                ));
            }
            source
        } else {
            SourceFile::new(&name, shipped(&name).ok_or_else(|| refused("there is no such file"))?)
        };
        from = folder(&file);
        files.push(file);
        let source = with_data(source, &name, &from, &mut files)?;
        extends_chain.push((name, source));
    }
    let whole = extends_chain.into_iter().rev().reduce(|(base_named, base), (named, source)| {
        let extended = source.extended(&base, &base_named, &named);
        (named, extended)
    });
    whole.map(|(_, source)| (source, files)).ok_or(Failure::File(nothing))
}

/// Whether a text has a key that the spec of a crane begins with, also in braces and quotation marks.
fn is_spec(text: &str) -> bool {
    const KEYS: [&str; 3] = ["format", "extends", "links"];
    let begins = |line: &str| {
        let line = line.trim_start_matches(['\u{feff}', '{', ' ', '\t']);
        let key = line.split(':').next().unwrap_or_default().trim_matches(['"', '\'', ' ']);
        line.contains(':') && KEYS.contains(&key)
    };
    text.lines().any(begins)
}

/// A spec, which is called `named`, with the data files to which it refers, looked up `from` a folder. Their paths are added to `files`.
fn with_data(source: SourceFile, named: &str, from: &Path, files: &mut Vec<PathBuf>) -> Result<SourceFile, Failure> {
    let mut data: Vec<(String, String)> = Vec::new();
    for (name, span) in data_files(&source) {
        if data.iter().any(|(known, _)| *known == name) {
            continue;
        }
        let file = from.join(&name);
        let opened =
            if file.exists() { open_single(&file) } else { Err(Failure::File("there is no such file".into())) };
        let refused =
            |problem: String| Failure::Mistakes(Diagnostics::new(&source, vec![rule::no_data(span, &name, problem)]));
        let text = opened.map_err(|failure| {
            refused(match failure {
                Failure::File(problem) => problem,
                Failure::Mistakes(mistakes) => mistakes.headline(),
            })
        })?;
        if name.trim() != name || text.is_marked() {
            return Err(refused("its name or one of its lines cannot be part of the text of a spec".into()));
        }
        data.push((name, text.text));
        files.push(file);
    }
    Ok(source.with_data(&data, named))
}

/// Reads one file.
fn open_single(spec: &Path) -> Result<SourceFile, Failure> {
    let name = spec.display().to_string();
    let file = files::open(spec).map_err(|error| Failure::File(format!("{name}: {error}")))?;
    read_single(&name, file)
}

/// Reads one file to its end, unless it is too large.
fn read_single(name: &str, stream: impl Read) -> Result<SourceFile, Failure> {
    let mut bytes = Vec::new();
    let limit = u64::try_from(MAX_BYTES).unwrap_or(u64::MAX).saturating_add(1);
    let read = stream.take(limit).read_to_end(&mut bytes);
    read.map_err(|error| Failure::File(format!("{name}: {error}")))?;
    SourceFile::from_bytes(name, &bytes).map_err(Failure::Mistakes)
}

/// Why a spec could not be opened or compiled.
#[derive(Debug)]
pub enum Failure {
    /// An error of the file system.
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
pub fn write_text(target: &Path, text: &str) -> io::Result<()> {
    files::write_file(target, |file| file.write_all(text.as_bytes()))
}

/// Cargo shows one line of an error, so the headline goes there and the full report to standard error.
fn fail(headline: &str, drawn: &str) -> ! {
    eprintln!("{drawn}");
    println!("cargo::error={headline}");
    process::exit(1)
}
