//! Words that a reader stumbles over, in documents, comments and messages, and long sentences of the manual.

use crate::{sentences, workspace};

/// What is looked for, and what to write instead.
const STUMBLES: [(&str, &str); 15] = [
    (" of one's own", "your own"),
    (" of ours", "our own"),
    (" an own ", "its own"),
    (" tells ", "describes"),
    (" is told ", "receives"),
    ("beforehand", "in advance"),
    (" anew", "again"),
    (" shortly ", "just"),
    (" but for ", "except for"),
    ("whoever", "anyone who"),
    (" the one before", "the previous one"),
    (" one a ", "one per"),
    (" a call for one ", "per call for one"),
    (" is no ", "is not a"),
    (" are no ", "are not"),
];
/// Where `is no` is plain English.
const PLAIN: [&str; 5] = ["here is no ", "here are no ", " is no longer ", " are no longer ", " is no more "];
/// Folders and files, by extension, of texts that people write.
const TEXTS: [(&str, &str); 25] = [
    ("apps/cli", "rs"),
    ("apps/cli", "template"),
    ("apps/fmu", "py"),
    ("apps/fmu", "rs"),
    ("apps/python", "md"),
    ("apps/python/crane", "py"),
    ("apps/python/crane", "pyi"),
    ("apps/python/src", "rs"),
    ("apps/report/src", "js"),
    ("codegen", "rs"),
    ("crane-model", "rs"),
    ("docs", "md"),
    ("engine/jit", "rs"),
    ("engine/live", "rs"),
    ("examples", "rs"),
    ("examples", "toml"),
    ("specs", "yaml"),
    ("specs/src", "rs"),
    ("tests", "rs"),
    ("tools/bench", "rs"),
    ("tools/casadi", "py"),
    ("tools/lab", "md"),
    ("tools/lab", "rs"),
    ("tools/peers", "py"),
    ("tools/xtask", "rs"),
];
const DOCUMENTS: [&str; 3] = ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"];
/// This file, which contains the words itself.
const HERE: &str = "tools/xtask/src/prose.rs";

/// Every place where one occurs, and every long sentence.
pub fn check_prose() -> Result<(), String> {
    let mut files: Vec<String> = DOCUMENTS.map(str::to_owned).to_vec();
    for (folder, extension) in TEXTS {
        files.extend(workspace::find_files(folder, extension)?);
    }
    let mut found = sentences::find_long()?;
    for file in files.iter().filter(|file| *file != HERE && !file.contains("/target/")) {
        for (number, line) in workspace::read_file(file)?.lines().enumerate() {
            let rest = PLAIN.iter().fold(line.to_owned(), |line, plain| line.replace(plain, " "));
            let stumbles = STUMBLES.iter().filter(|(words, _)| rest.contains(words));
            found.extend(
                stumbles
                    .map(|(words, instead)| format!("{file}:{}: `{}`: write `{instead}`", number + 1, words.trim())),
            );
        }
    }
    if found.is_empty() { Ok(()) } else { Err(found.join("\n")) }
}
