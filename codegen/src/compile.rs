//! The pipeline, one stage a line.

use crate::chain::{Analyses, Chain};
use crate::emit::{GeneratedCode, Report, emit};
use crate::lower::lower;
use crate::mechanics::{derive, derive_verbatim, left_out};

/// Compiles a chain to Rust. `analyses` is what to compute, usually the chain's own.
#[must_use]
pub fn generate(chain: &Chain, analyses: Analyses, spec_file: &str) -> GeneratedCode {
    let program = derive(chain, analyses);
    let blocks = lower(&program);
    let report = Report::new(&blocks, &derive_verbatim(chain, analyses), left_out(chain, analyses));
    emit(chain, &blocks, report, spec_file)
}
