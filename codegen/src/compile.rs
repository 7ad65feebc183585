//! The pipeline, one stage per line.

use std::path::Path;

use crate::chain::{Analyses, Chain};
use crate::diagnostic::{Diagnostics, SourceFile};
use crate::emit::{GeneratedCode, emit};
use crate::lower::{Blocks, lower};
use crate::mechanics::{derive, derive_verbatim, left_out};
use crate::read::read;
use crate::report::Report;
use crate::validate::{self, Checked};

/// A crane's Rust module, and warnings about the crane.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The module.
    pub code: GeneratedCode,
    /// Warnings, with their locations.
    pub warnings: Diagnostics,
}

/// Compiles a spec to Rust: the functions that its `analyses` request, or those of `analyses` instead.
///
/// # Errors
/// All mistakes of the spec at once.
pub fn compile(source: &SourceFile, analyses: Option<Analyses>) -> Result<Compiled, Diagnostics> {
    let Checked { chain, warnings } = check(source)?;
    // Only the spec can request eight cranes per call.
    let analyses = Analyses { ensemble: chain.analyses.ensemble, ..analyses.unwrap_or(chain.analyses) };
    // A path would differ between machines.
    let file = Path::new(&source.name).file_name().unwrap_or_default().to_string_lossy();
    Ok(Compiled { code: generate(&chain, analyses, &file), warnings })
}

/// Converts a spec to a valid chain.
///
/// # Errors
/// All mistakes of the spec at once.
pub fn load(source: &SourceFile) -> Result<Chain, Diagnostics> {
    check(source).map(|checked| checked.chain)
}

/// Converts a spec to a valid chain, with warnings about implausible numbers.
///
/// # Errors
/// All mistakes of the spec at once.
pub fn check(source: &SourceFile) -> Result<Checked, Diagnostics> {
    check_with(source, &[])
}

/// Like [`check`], with warnings for other parameter values than those of the spec: names and values.
///
/// # Errors
/// All mistakes of the spec at once.
pub fn check_with(source: &SourceFile, set: &[(&str, f64)]) -> Result<Checked, Diagnostics> {
    validate::check_with(&read(source)?, source, set)
}

/// Compiles a chain to Rust. `spec_file` is the name of the YAML file, for the header.
#[must_use]
pub fn generate(chain: &Chain, analyses: Analyses, spec_file: &str) -> GeneratedCode {
    let program = derive(chain, analyses);
    let blocks = lower(&program, chain.loops.least_rounds());
    emit(chain, analyses, &blocks, report_on(&blocks, chain, analyses), spec_file)
}

/// The cost of the functions of a chain and what is left out, without writing them.
#[must_use]
pub fn report(chain: &Chain, analyses: Analyses) -> Report {
    report_on(&lower(&derive(chain, analyses), chain.loops.least_rounds()), chain, analyses)
}

fn report_on(blocks: &Blocks, chain: &Chain, analyses: Analyses) -> Report {
    Report::new(blocks, &derive_verbatim(chain, analyses), chain.loops, left_out(chain, analyses))
}
