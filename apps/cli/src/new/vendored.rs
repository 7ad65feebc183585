//! The crates that a new crate depends on, copied into it.

use std::{
    borrow::Cow,
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use super::sources::{CRATES, WORKSPACE, list_files};
use crate::{
    compiled,
    problem::{Outcome, Problem},
    selection::Carried,
};

/// Folder of the copies in the new crate.
pub const FOLDER: &str = "crates";
/// Tables of the workspace's manifest that those of the crates inherit from.
const INHERITED: [&str; 4] =
    ["[workspace.package]", "[workspace.dependencies]", "[workspace.lints.rust]", "[workspace.lints.clippy]"];

/// Whether this command was built from a source tree that is still there.
pub fn has_tree() -> bool {
    compiled::root().join(CRATES[0]).exists()
}

/// Sources by their paths within the source tree.
pub struct Sources(BTreeMap<PathBuf, Cow<'static, str>>);

impl Sources {
    /// Those that this command carries, otherwise those of the source tree that it was built from.
    pub fn read(carried: &Carried) -> Outcome<Self> {
        if !carried.sources.is_empty() {
            let carried = carried.sources.iter().map(|(path, text)| (PathBuf::from(path), Cow::Borrowed(*text)));
            return Ok(Self(carried.collect()));
        }
        let files = list_files(compiled::root()).map_err(|(folder, error)| Problem::file(&folder, &error))?;
        let read = |path: PathBuf| {
            let text =
                fs::read_to_string(compiled::root().join(&path)).map_err(|error| Problem::file(&path, &error))?;
            Ok((path, Cow::Owned(text)))
        };
        Ok(Self(files.into_iter().map(read).collect::<Outcome<_>>()?))
    }

    /// Files of the crates, by their paths in the new crate: sources, and manifests without what only their tests need.
    pub fn crates(&self) -> Vec<(PathBuf, String)> {
        let copied = self.0.iter().filter(|(path, _)| path.as_path() != Path::new(WORKSPACE));
        let copy = |(path, text): (&PathBuf, &Cow<'static, str>)| {
            let text = match path.file_name() {
                Some(name) if name == "Cargo.toml" => tables(text, |header| header != "[dev-dependencies]"),
                _ => text.clone().into_owned(),
            };
            (Path::new(FOLDER).join(path), text)
        };
        copied.map(copy).collect()
    }

    /// The tables of the workspace's manifest that the copies inherit from.
    pub fn inherited(&self) -> String {
        let manifest = self.0.get(Path::new(WORKSPACE)).map_or("", |text| text);
        let text = tables(manifest, |header| INHERITED.contains(&header));
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
        format!("[workspace]\nmembers = [{}]\n\n{}\n", members.join(", "), text.trim_end())
    }
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
