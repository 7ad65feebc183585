//! A copy of the workspace in which changes are switches.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::CRATES;
use crate::draw::Change;

/// The environment variable that has the number of the change, from 1 on.
pub const SWITCH: &str = "CRANE_MUTANT";

/// A copy of the workspace, at a place of its own.
pub struct Site {
    root: PathBuf,
    /// The root of the copy.
    pub tree: PathBuf,
}

impl Site {
    /// Where the copy of a workspace is.
    pub fn new(root: &Path) -> Self {
        Self { root: root.to_owned(), tree: root.join("target/mutants/tree") }
    }

    /// Copies the files that git knows, with the changes as switches. What is there already keeps its date, and is not built again.
    pub fn write(&self, changes: &[Change]) -> Result<(), String> {
        let output = Command::new("git").current_dir(&self.root).args(["ls-files"]).output();
        let listed = output.map_err(|error| format!("git: {error}"))?.stdout;
        let mut of_files: BTreeMap<&Path, Vec<(usize, &Change)>> = BTreeMap::new();
        for (number, change) in (1..).zip(changes) {
            of_files.entry(&change.file).or_default().push((number, change));
        }
        for file in String::from_utf8_lossy(&listed).lines() {
            let Ok(mut bytes) = fs::read(self.root.join(file)) else { continue };
            if let Some(changes) = of_files.get(Path::new(file)) {
                bytes = switched(String::from_utf8_lossy(&bytes).into_owned(), changes).into_bytes();
            }
            // Crates without changes are those that a copied `target` has built.
            let changed = CRATES.iter().filter(|folder| changes.iter().any(|change| change.file.starts_with(folder)));
            if changed.into_iter().any(|folder| file.strip_prefix(folder) == Some("/lib.rs")) {
                bytes.extend(switches().bytes());
            }
            let to = self.tree.join(file);
            if fs::read(&to).is_ok_and(|known| known == bytes) {
                continue;
            }
            let failed = |error: std::io::Error| format!("{}: {error}", to.display());
            fs::create_dir_all(to.parent().unwrap_or(&self.tree)).map_err(failed)?;
            fs::write(&to, bytes).map_err(failed)?;
        }
        Ok(())
    }
}

/// A text with changes as switches.
fn switched(mut text: String, changes: &[(usize, &Change)]) -> String {
    let mut last_first = changes.to_vec();
    last_first.sort_by_key(|(_, change)| std::cmp::Reverse(change.range.start));
    for (number, Change { range, from, to, .. }) in last_first {
        let switch = format!("(if crate::mutants::is({number}) {{ {to} }} else {{ {from} }})");
        text.replace_range(range.clone(), &switch);
    }
    text
}

/// The module of a crate that knows which change is on.
fn switches() -> String {
    format!(
        "
#[allow(dead_code, missing_docs)]
mod mutants {{
    extern crate std;
    static CHOSEN: std::sync::LazyLock<u32> =
        std::sync::LazyLock::new(|| std::env::var(\"{SWITCH}\").ok().and_then(|text| text.parse().ok()).unwrap_or(0));
    #[inline]
    pub fn is(number: u32) -> bool {{
        *CHOSEN == number
    }}
}}
"
    )
}
