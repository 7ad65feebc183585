//! The crates that a new crate depends on, copied into it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::{
    compiled,
    problem::{Outcome, Problem},
};

/// Folder of the copies in the new crate.
pub const FOLDER: &str = "crates";
/// Crates to copy, by their folders in the source tree.
pub const CRATES: [&str; 3] = ["crane-model", "codegen", "quantities"];
/// Tables of the workspace's manifest that those of the crates inherit from.
const INHERITED: [&str; 4] =
    ["[workspace.package]", "[workspace.dependencies]", "[workspace.lints.rust]", "[workspace.lints.clippy]"];

/// Files of the crates, by their paths in the new crate: sources, and manifests without what only their tests need.
pub fn sources() -> Outcome<Vec<(PathBuf, String)>> {
    let mut texts = Vec::new();
    for name in CRATES {
        let root = compiled::root().join(name);
        let manifest = tables(&read_source(&root.join("Cargo.toml"))?, |header| header != "[dev-dependencies]");
        texts.push((Path::new(FOLDER).join(name).join("Cargo.toml"), manifest));
        let mut folders = vec![root.join("src")];
        while let Some(folder) = folders.pop() {
            let entries = fs::read_dir(&folder).map_err(|error| Problem::file(&folder, &error))?;
            for entry in entries {
                let path = entry.map_err(|error| Problem::file(&folder, &error))?.path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    let text = read_source(&path)?;
                    let relative = path.strip_prefix(compiled::root()).unwrap_or(&path);
                    texts.push((Path::new(FOLDER).join(relative), text));
                }
            }
        }
    }
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        texts.push((Path::new(FOLDER).join(licence), read_source(&compiled::root().join(licence))?));
    }
    texts.sort();
    Ok(texts)
}

/// The tables of the workspace's manifest that the copies inherit from.
pub fn inherited() -> Outcome<String> {
    let manifest = read_source(&compiled::root().join("Cargo.toml"))?;
    let text = tables(&manifest, |header| INHERITED.contains(&header));
    // Other crates of the source tree are not copied.
    let needed =
        |line: &&str| !line.contains("path = ") || CRATES.iter().any(|name| line.contains(&format!("\"{name}\"")));
    let lines = text.lines().filter(needed).map(|line| {
        CRATES.iter().fold(line.to_owned(), |line, name| {
            line.replace(&format!("path = \"{name}\""), &format!("path = \"{FOLDER}/{name}\""))
        })
    });
    let members: Vec<String> = CRATES.iter().map(|name| format!("\"{FOLDER}/{name}\"")).collect();
    let text = lines.collect::<Vec<_>>().join("\n");
    Ok(format!("[workspace]\nmembers = [{}]\n\n{}\n", members.join(", "), text.trim_end()))
}

/// Some tables of a manifest.
fn tables(manifest: &str, wanted: impl Fn(&str) -> bool) -> String {
    let mut keep = false;
    let lines = manifest.split_inclusive('\n').filter(|line| {
        if line.starts_with('[') {
            keep = wanted(line.trim());
        }
        keep
    });
    lines.collect()
}

fn read_source(path: &Path) -> Outcome<String> {
    fs::read_to_string(path).map_err(|error| Problem::file(path, &error))
}
