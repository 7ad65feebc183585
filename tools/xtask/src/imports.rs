//! The permitted imports; ARCHITECTURE.md gives the reasons.

use crate::{cycles, workspace};

/// A folder of the compiler, and the modules of the compiler that it may name besides itself.
const MAY_IMPORT: [(&str, &[&str]); 13] = [
    ("symbolic", &[]),
    ("chain", &[]),
    ("diagnostic", &[]),
    ("spec", &["diagnostic"]),
    ("read", &["diagnostic", "spec"]),
    ("validate", &["chain", "diagnostic", "expand", "spec"]),
    ("expand", &["chain"]),
    ("exchange", &["chain", "diagnostic"]),
    ("program", &["symbolic"]),
    ("mechanics", &["chain", "program", "symbolic"]),
    ("lower", &["program", "symbolic"]),
    ("emit", &["chain", "lower", "program", "report", "symbolic"]),
    ("emit_c", &["chain", "emit", "lower", "program", "symbolic"]),
];

/// Words that a folder may not contain, and why.
const MAY_NOT_NAME: [(&str, &str, &[&str], &str); 9] = [
    ("crane-model/src", "rs", &["crane_codegen"], "the runtime does not depend on the compiler"),
    (
        "tests/golden",
        "rs",
        &["std::", "alloc::", "panic!", "unwrap("],
        "generated code needs core and the runtime only",
    ),
    ("tools/casadi", "py", &["codegen/src", "import yaml"], "the check shares the YAML file and nothing else"),
    ("tools/peers", "py", &["codegen/src", "import yaml"], "the peers share the YAML file and nothing else"),
    ("codegen/src", "rs", &["unsafe "], "no unsafe code"),
    (
        "tools/live/src",
        "rs",
        &["crane_codegen::emit", "crane_codegen::build", "std::fs", "std::env", "std::process", "leak("],
        "a live crane is made of text in memory and gone when it is dropped: no Rust is written, no file touched, nothing leaks",
    ),
    (
        "tools/page/src",
        "rs",
        &["crane_cli", "crane_codegen::emit", "crane_codegen::mechanics", "std::fs", "std::env", "std::process"],
        "a page is text; files and notebooks are for others",
    ),
    (
        "tools/python/src",
        "rs",
        &["unsafe ", "crane_cli", "crane_codegen::emit", "crane_codegen::mechanics", "std::fs", "std::process"],
        "the package computes with live cranes, and leaves what they are made of, files and processes to others",
    ),
    (
        "tools/fmu/src",
        "rs",
        &["crane_cli", "crane_codegen::emit", "crane_codegen::mechanics", "std::process", "std::thread", "std::env"],
        "a unit computes with live cranes inside of another program, and leaves that program alone",
    ),
];

/// The only modules of the compiler that may access files, the environment or the process.
const MAY_TOUCH_THE_WORLD: [&str; 2] = ["codegen/src/build.rs", "codegen/src/files.rs"];

/// Every breach of the rules.
pub fn check() -> Result<(), String> {
    let mut breaches = Vec::new();
    for (folder, allowed) in MAY_IMPORT {
        let files = workspace::files(&format!("codegen/src/{folder}"), "rs")?;
        // Tests of a module may use more.
        for file in files.into_iter().filter(|file| !file.ends_with("/tests.rs")) {
            for (number, line) in code_lines(&workspace::read(&file)?) {
                for module in named_modules(&line) {
                    if module != folder && !allowed.contains(&module.as_str()) {
                        breaches.push(format!("{file}:{number}: `{folder}` may not import `{module}`"));
                    }
                }
            }
        }
    }
    for (folder, extension, words, reason) in MAY_NOT_NAME {
        for file in &workspace::files(folder, extension)? {
            for (number, line) in code_lines(&workspace::read(file)?) {
                breaches.extend(
                    words.iter().filter(|w| line.contains(**w)).map(|w| format!("{file}:{number}: `{w}`: {reason}")),
                );
            }
        }
    }
    for file in workspace::files("codegen/src", "rs")? {
        if !MAY_TOUCH_THE_WORLD.contains(&file.as_str()) {
            for (number, line) in code_lines(&workspace::read(&file)?) {
                let words = ["fs::", "env::", "process::", "std::{"];
                if words.iter().any(|word| line.contains(word)) && !line.contains("env!(") {
                    breaches.push(format!(
                        "{file}:{number}: `build` and `files` alone touch files, environment and process"
                    ));
                }
            }
        }
    }
    breaches.extend(cycles::cycles()?);
    if breaches.is_empty() { Ok(()) } else { Err(format!("\n{}", breaches.join("\n"))) }
}

/// Lines that are code, without the tests at the end of a file, with their numbers.
fn code_lines(text: &str) -> Vec<(usize, String)> {
    text.lines()
        .enumerate()
        .take_while(|(_, line)| line.trim() != "#[cfg(test)]" || text.contains("mod tests;"))
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        .map(|(index, line)| (index + 1, line.to_owned()))
        .collect()
}

/// Modules after `crate::` in a line; a type re-exported at the root counts as none.
fn named_modules(line: &str) -> Vec<String> {
    line.split("crate::")
        .skip(1)
        .filter(|_| !line.contains("macro_rules"))
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(list) => list.split(',').map(first_word).collect(),
            None => vec![first_word(rest)],
        })
        .filter(|word| word.chars().next().is_some_and(char::is_lowercase))
        .collect()
}

fn first_word(text: &str) -> String {
    text.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_are_found() {
        assert_eq!(named_modules("use crate::chain::Chain;"), ["chain"]);
        assert_eq!(named_modules("use crate::{SourceFile, compile, emit::Report};"), ["compile", "emit"]);
        assert_eq!(named_modules("    crate::lower::lower(p)"), ["lower"]);
    }
}
