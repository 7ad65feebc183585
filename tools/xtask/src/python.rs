//! Python environments with pinned packages, made once.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::{step, workspace};

/// An environment: its folder at the workspace's root, and the lists of its packages.
pub struct Environment {
    folder: &'static str,
    requirements: &'static [&'static str],
}

/// For the checks with other libraries.
pub const CHECKS: Environment = Environment {
    folder: ".venv",
    requirements: &[
        "tools/casadi/requirements.txt",
        "tools/peers/requirements.txt",
        "tools/peers/requirements-performance.txt",
        "tools/python/requirements-test.txt",
        "tools/fmu/requirements-test.txt",
        "tools/cli/tests/output/requirements-test.txt",
    ],
};

impl Environment {
    /// Its Python interpreter.
    pub fn python(&self) -> PathBuf {
        workspace::root().join(self.folder).join("bin/python")
    }

    /// Makes it, unless it already has what is required.
    pub fn prepare(&self) -> Result<(), String> {
        let folder = workspace::root().join(self.folder);
        let requirements =
            self.requirements.iter().map(|file| workspace::read_file(file)).collect::<Result<String, _>>()?;
        let stamp = folder.join("requirements.installed");
        if fs::read_to_string(&stamp).is_ok_and(|installed| installed == requirements) {
            println!("{}: installed", self.requirements.join(", "));
            return Ok(());
        }
        step::run_to_end(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder)).map_err(|error| {
            format!(
                "{error}; Python 3.11 or newer with its venv module is needed (Debian: apt-get install python3-venv)"
            )
        })?;
        step::run_to_end(
            Command::new(self.python())
                .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])
                .args(self.requirements.iter().flat_map(|file| ["--requirement", file]))
                .current_dir(workspace::root()),
        )?;
        fs::write(&stamp, requirements).map_err(|error| format!("{}: {error}", stamp.display()))
    }
}
