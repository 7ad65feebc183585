//! A copy of the workspace in which changes are switches.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::draw::Change;
use crate::{CRATES, read};

/// The environment variable that has the number of the change, from 1 on.
pub const SWITCH: &str = "CRANE_MUTANT";

/// Copies the workspace, as git knows it, to a place of its own; returns the copy's root.
pub fn copy(root: &Path) -> Result<PathBuf, String> {
    let tree = root.join("target/mutants/tree");
    let output =
        Command::new("git").current_dir(root).args(["ls-files"]).output().map_err(|error| format!("git: {error}"))?;
    let listed = String::from_utf8_lossy(&output.stdout).into_owned();
    for file in listed.lines() {
        let (from, to) = (root.join(file), tree.join(file));
        let Ok(bytes) = fs::read(&from) else { continue };
        // What has not changed keeps its date, and is not built again.
        if fs::read(&to).is_ok_and(|known| known == bytes) {
            continue;
        }
        let failed = |error: std::io::Error| format!("{}: {error}", to.display());
        fs::create_dir_all(to.parent().unwrap_or(&tree)).map_err(failed)?;
        fs::write(&to, bytes).map_err(failed)?;
    }
    Ok(tree)
}

/// Writes the files of the copy with their changes as switches.
pub fn write(tree: &Path, changes: &[Change], texts: &mut BTreeMap<PathBuf, String>) -> Result<(), String> {
    for change in changes {
        if !texts.contains_key(&change.file) {
            texts.insert(change.file.clone(), read(&tree.join(&change.file))?);
        }
    }
    for (file, text) in texts.iter() {
        let mut here: Vec<(usize, &Change)> = (1..).zip(changes).filter(|(_, change)| change.file == *file).collect();
        here.sort_by_key(|(_, change)| std::cmp::Reverse(change.range.start));
        let mut text = text.clone();
        for (number, Change { range, from, to, .. }) in here {
            text.replace_range(
                range.clone(),
                &format!("(if crate::mutants::is({number}) {{ {to} }} else {{ {from} }})"),
            );
        }
        fs::write(tree.join(file), text).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    for folder in CRATES {
        let root = tree.join(folder).join("lib.rs");
        let text = read(&root)?;
        if !text.contains("mod mutants {") {
            fs::write(&root, text + &switches()).map_err(|error| format!("{}: {error}", root.display()))?;
        }
    }
    Ok(())
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
