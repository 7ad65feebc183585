//! `crane generate`, `operations` and `schema`: what the compiler writes.

use std::{io::Write, path::PathBuf};

use crane_codegen::{
    chain::Analyses,
    compile::{self, Compiled},
    dump, explain, json_schema,
};

use crate::{
    arguments::{Generate, Output},
    files,
    problem::{Outcome, Problem},
    selection::Registry,
    spec_file::load,
};

/// Writes the Rust module of a crane.
pub fn generate(options: &Generate, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let source = registry.source(&options.spec)?;
    let analyses = options.all.then_some(Analyses::ALL);
    if let Some(folder) = &options.dump {
        files::folder(folder)?;
        for (name, text) in dump::stages(&source, analyses).map_err(Problem::mistakes)? {
            registry.console.write_text(&folder.join(name), &text)?;
        }
    }
    let chain = compile::load(&source).map_err(Problem::mistakes)?;
    let compiled = registry.console.working(&chain, || compile::compile(&source, analyses));
    let Compiled { code, warnings } = compiled.map_err(Problem::mistakes)?;
    if !warnings.is_empty() {
        registry.console.warn(&warnings);
    }
    if let Some(warning) = code.report.warning(&code.name) {
        registry.console.remark(&format!("warning: {warning}"));
    }
    let Some(file) = &options.file else { return Ok(out.write_all(code.text.as_bytes())?) };
    registry.console.write_text(file, &code.text)?;
    let (functions, lines) = (code.report.costs.len(), code.text.lines().count());
    Ok(writeln!(out, "{}: {functions} functions, {lines} lines", file.display())?)
}

/// Prints a Markdown table of operations: one row per function, one column per spec.
pub fn operations(specs: &[PathBuf], registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let report = |spec: &PathBuf| {
        let (chain, _) = load(&registry.console, spec, false)?;
        let report = compile::report(&chain, Analyses::ALL);
        Ok((chain.name, report))
    };
    let reports = specs.iter().map(report).collect::<Outcome<Vec<_>>>()?;
    Ok(out.write_all(explain::operations_table(&reports).as_bytes())?)
}

/// Prints the JSON Schema of the spec language, for editors, or of what a command prints, for programs.
pub fn schema(of: Option<Output>, out: &mut dyn Write) -> Outcome<()> {
    match of {
        Some(output) => Ok(out.write_all(output.schema().as_bytes())?),
        None => Ok(out.write_all(json_schema().as_bytes())?),
    }
}

impl Output {
    fn schema(self) -> &'static str {
        match self {
            Output::Check => include_str!("../schemas/check.json"),
            Output::Statics => include_str!("../schemas/statics.json"),
            Output::Modes => include_str!("../schemas/modes.json"),
            Output::Linearise => include_str!("../schemas/linearise.json"),
            Output::Margins => include_str!("../schemas/margins.json"),
            Output::Stability => include_str!("../schemas/stability.json"),
            Output::Simulate => include_str!("../schemas/simulate.json"),
            Output::Ensemble => include_str!("../schemas/ensemble.json"),
            Output::Strength => include_str!("../schemas/strength.json"),
            Output::Fatigue => include_str!("../schemas/fatigue.json"),
            Output::Drives => include_str!("../schemas/drives.json"),
            Output::Factors => include_str!("../schemas/factors.json"),
            Output::Sensitivity => include_str!("../schemas/sensitivity.json"),
            Output::Envelope => include_str!("../schemas/envelope.json"),
            Output::Compare => include_str!("../schemas/compare.json"),
            Output::Run => include_str!("../schemas/run.json"),
            Output::Info => include_str!("../schemas/info.json"),
            Output::List => include_str!("../schemas/list.json"),
            Output::Poses => include_str!("../schemas/poses.json"),
        }
    }
}
