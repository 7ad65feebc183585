//! `crane check`: every mistake of a spec and everything implausible, for people or for programs.

use std::io::Write;

use crane_codegen::{Checked, Diagnostics, Located, chain::Chain, compile};
use crane_page::tables::FORMAT;
use serde_json::{Value, json};

use crate::{
    Registry,
    arguments::{Check, Format},
    own,
    problem::{FAILED, Outcome, Problem},
};

/// Checks a spec: confirms that it is valid, or reports what is wrong.
pub fn check(options: &Check, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let Check { spec, strict, format } = options;
    match format {
        Format::Table => {
            let Chain { name, bodies, coordinates, spec_hash, .. } = own::load_named(spec, *strict, registry)?.0;
            let (bodies, coordinates) = (bodies.len(), coordinates.len());
            Ok(writeln!(out, "{name}: valid; {bodies} bodies, {coordinates} coordinates, spec hash {spec_hash}")?)
        }
        Format::Json => {
            let checked =
                own::source(spec, registry).and_then(|source| compile::check(&source).map_err(Problem::mistakes));
            let (chain, found) = match checked {
                Ok(Checked { chain, warnings }) => (Some(chain), warnings),
                Err(Problem::Mistakes(mistakes)) => (None, *mistakes),
                Err(other) => return Err(other),
            };
            let valid = chain.is_some() && (found.is_empty() || !*strict);
            writeln!(out, "{:#}", json(valid, chain.as_ref(), &found))?;
            // The JSON already contains what is wrong.
            if valid { Ok(()) } else { Err(Problem::Elsewhere(FAILED)) }
        }
    }
}

fn json(valid: bool, chain: Option<&Chain>, found: &Diagnostics) -> Value {
    json!({
        "format": FORMAT,
        "valid": valid,
        "crane": chain.map(|chain| &chain.name),
        "bodies": chain.map(|chain| chain.bodies.len()),
        "coordinates": chain.map(|chain| chain.coordinates.len()),
        "spec_hash": chain.map(|chain| &chain.spec_hash),
        "diagnostics": found.located().map(|located| diagnostic(&located)).collect::<Vec<_>>(),
    })
}

fn diagnostic(located: &Located<'_>) -> Value {
    let Located { mistake, file, start, end } = located;
    json!({
        "code": mistake.code,
        "severity": if mistake.is_warning() { "warning" } else { "error" },
        "file": file,
        "line": start.0,
        "column": start.1,
        "end_line": end.0,
        "end_column": end.1,
        "message": mistake.title,
        "label": mistake.label,
        "help": mistake.help,
    })
}
