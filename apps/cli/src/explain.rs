//! `crane explain`: how a spec was understood, in words and as a picture.

use std::io::Write;

use crane_codegen::{compile, explain};
use crane_live::LiveCrane;
use crane_page::diagram::diagram;

use crate::{arguments::Explain, problem::Outcome, selection::Registry};

/// Prints the chain of a spec, and draws it on request.
pub fn explain(options: &Explain, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let (chain, _) = registry.load(&options.spec, false)?;
    if let Some(file) = &options.svg {
        registry.console.write_text(file, &diagram(&LiveCrane::new(chain.clone())))?;
    }
    let report =
        options.operations.then(|| registry.console.working(&chain, || compile::report(&chain, chain.analyses)));
    Ok(out.write_all(explain::explain(&chain, report.as_ref()).as_bytes())?)
}
