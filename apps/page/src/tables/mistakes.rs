//! Mistakes of a spec, and warnings about it, for programs.

use crane_codegen::{Diagnostics, Located};
use serde_json::{Value, json};

/// Each mistake or warning with its place, its reason and its remedy.
pub fn diagnostics(diagnostics: &Diagnostics) -> Value {
    let of = |Located { mistake, file, start, end }: Located<'_>| {
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
    };
    diagnostics.located().map(of).collect()
}
