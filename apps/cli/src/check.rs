//! `crane check`: every mistake of a spec and everything implausible, for people or for programs.

use std::{io::Write, mem};

use crane_codegen::{Checked, Diagnostics, chain::Chain, compile};
use crane_page::tables::{FORMAT, diagnostics};
use serde_json::{Value, json};

use crate::{
    arguments::{Check, Format},
    problem::{FAILED, Outcome, Problem},
    selection::Registry,
};

/// Checks specs: confirms that they are valid, or reports what is wrong with each.
pub fn check_specs(options: &Check, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    match options.format {
        Format::Table | Format::Html => as_text(options, registry, out),
        Format::Json => as_json(options, registry, out),
    }
}

fn as_text(Check { specs, strict, .. }: &Check, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let mut worst = Ok(());
    for spec in specs {
        match registry.load(spec, *strict) {
            Ok((Chain { name, bodies, coordinates, spec_hash, .. }, _)) => {
                let (bodies, coordinates) = (bodies.len(), coordinates.len());
                writeln!(out, "{name}: valid; {bodies} bodies, {coordinates} coordinates, spec hash {spec_hash}")?;
            }
            // The last problem is reported at the end, those before it now.
            Err(problem) => {
                if let Err(before) = mem::replace(&mut worst, Err(problem)) {
                    registry.console.report(&before);
                }
            }
        }
    }
    worst
}

/// One object for one spec, an array for several.
fn as_json(Check { specs, strict, .. }: &Check, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let mut found = Vec::new();
    for spec in specs {
        let checked = registry.source(spec).and_then(|source| compile::check(&source).map_err(Problem::mistakes));
        let (chain, diagnostics) = match checked {
            Ok(Checked { chain, warnings, .. }) => (Some(chain), warnings),
            Err(Problem::Mistakes(mistakes)) => (None, *mistakes),
            Err(other) => return Err(other),
        };
        let valid = chain.is_some() && (diagnostics.is_empty() || !*strict);
        found.push((valid, json(valid, chain.as_ref(), &diagnostics)));
    }
    let all_valid = found.iter().all(|(valid, _)| *valid);
    let mut objects: Vec<Value> = found.into_iter().map(|(_, object)| object).collect();
    let whole = if let [_] = objects[..] { objects.remove(0) } else { objects.into() };
    writeln!(out, "{whole:#}")?;
    // The JSON already contains what is wrong.
    if all_valid { Ok(()) } else { Err(Problem::AlreadyReported { exit_code: FAILED }) }
}

fn json(valid: bool, chain: Option<&Chain>, found: &Diagnostics) -> Value {
    json!({
        "format": FORMAT,
        "valid": valid,
        "crane": chain.map(|chain| &chain.name),
        "bodies": chain.map(|chain| chain.bodies.len()),
        "coordinates": chain.map(|chain| chain.coordinates.len()),
        "spec_hash": chain.map(|chain| &chain.spec_hash),
        "diagnostics": diagnostics(found),
    })
}
