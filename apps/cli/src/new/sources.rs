//! Which files of the source tree a new crate gets copies of. The build script of `apps/dist` has this module too: its command carries them.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// Crates to copy, by their folders in the source tree.
pub const CRATES: [&str; 4] = ["crane-model", "codegen", "codegen/keys", "quantities"];
/// The manifest of the workspace, from which those of the crates inherit.
pub const WORKSPACE: &str = "Cargo.toml";
/// Other files of the workspace that belong to the crates.
const LICENCES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];

/// Paths of all these files within the source tree, sorted.
///
/// # Errors
/// A folder that cannot be read, and why.
pub fn list_files(root: &Path) -> Result<Vec<PathBuf>, (PathBuf, io::Error)> {
    let manifests = CRATES.iter().map(|name| Path::new(name).join("Cargo.toml"));
    let mut files: Vec<PathBuf> = manifests.chain(LICENCES.map(PathBuf::from)).chain([WORKSPACE.into()]).collect();
    let mut folders: Vec<PathBuf> = CRATES.iter().map(|name| Path::new(name).join("src")).collect();
    while let Some(folder) = folders.pop() {
        let at_fault = |error| (folder.clone(), error);
        for entry in fs::read_dir(root.join(&folder)).map_err(at_fault)? {
            let entry = entry.map_err(at_fault)?;
            let path = folder.join(entry.file_name());
            if entry.path().is_dir() { folders.push(path) } else { files.push(path) }
        }
    }
    files.sort();
    Ok(files)
}
