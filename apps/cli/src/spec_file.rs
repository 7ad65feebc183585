//! Specs in YAML files: opened, checked, and their warnings shown.

use std::{io, path::Path};

use crane_codegen::{Checked, SourceFile, build, chain::Chain, compile};
use crane_page::shapes::surfaces;

use crate::{
    arguments::STANDARD_INPUT,
    problem::{FAILED, Outcome, Problem},
    screen::Console,
};

/// What to do about a file that cannot be read as a spec.
pub const SPEC: &str = "give a YAML file that describes a crane, or the name of a shipped crane";

/// A valid chain and its text, or every mistake. Warnings are printed, and are mistakes if `strict`.
///
/// # Errors
/// The file cannot be read, or the spec has mistakes.
pub fn load(console: &Console, spec: &Path, strict: bool) -> Outcome<(Chain, String)> {
    parse(console, open(console, spec, SPEC)?, strict)
}

/// A valid chain and its text, or every mistake; warnings are printed, and are mistakes if `strict`.
///
/// # Errors
/// Those mistakes.
pub fn parse(console: &Console, source: SourceFile, strict: bool) -> Outcome<(Chain, String)> {
    Ok((check(console, &source, strict)?.chain, source.text))
}

/// A valid crane, or every mistake; warnings are printed, and are mistakes if `strict`.
///
/// # Errors
/// Those mistakes.
pub fn check(console: &Console, source: &SourceFile, strict: bool) -> Outcome<Checked> {
    warned(console, compile::check(source).map_err(Problem::mistakes)?, strict)
}

/// A valid crane whose warnings are printed, and are mistakes if `strict`.
///
/// # Errors
/// Those.
pub fn warned(console: &Console, checked: Checked, strict: bool) -> Outcome<Checked> {
    if !checked.warnings.is_empty() {
        console.warn(&checked.warnings);
        if strict {
            return Err(Problem::AlreadyReported { exit_code: FAILED });
        }
    }
    Ok(checked)
}

/// Reads the surfaces that a spec names, beside its file; says which could not be read.
pub fn read_surfaces(console: &Console, chain: &mut Chain, spec: &Path) {
    let unread = surfaces::read_surfaces(chain, spec, |file, most| {
        console.remember(file);
        crane_codegen::files::read_file(file, most)
    });
    if let Some(told) = unread {
        console.remark(&told);
    }
}

/// Shows warnings about a crane that appear only with these values of its parameters; returns them as a problem if there are any.
pub fn warn_of(console: &Console, checked: &Checked, set: &[(String, f64)]) -> Option<Problem> {
    let set: Vec<(&str, f64)> = set.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    let added = checked.warnings_with(&set).without(&checked.warnings);
    (!added.is_empty()).then(|| {
        console.warn(&added);
        Problem::AlreadyReported { exit_code: FAILED }
    })
}

/// A file of text, or the standard input; `help`: what kind of file to name.
///
/// # Errors
/// The file cannot be read.
pub fn open(console: &Console, file: &Path, help: &str) -> Outcome<SourceFile> {
    let read = if file == Path::new(STANDARD_INPUT) {
        build::read_with("standard input", io::stdin(), &crane_specs::spec).map(|source| (source, Vec::new()))
    } else {
        build::open_with_files(file, &crane_specs::spec)
    };
    let (source, read) = read.map_err(|failure| match failure {
        build::Failure::File(message) => Problem::failed(message, help),
        build::Failure::Mistakes(mistakes) => Problem::mistakes(mistakes),
    })?;
    for file in &read {
        console.remember(file);
    }
    Ok(source)
}
