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
        "apps/python/requirements-build.txt",
        "apps/python/requirements-test.txt",
        "apps/fmu/requirements-test.txt",
        "apps/cli/tests/output/requirements-test.txt",
    ],
};

/// For lints.
pub const LINTS: Environment = Environment { folder: ".venv-lints", requirements: &["tools/xtask/requirements.txt"] };

/// For programs of other processors than that of this machine.
pub const CROSS: Environment = Environment {
    folder: ".venv-cross",
    requirements: &["apps/python/requirements-build.txt", "apps/python/requirements-cross.txt"],
};

impl Environment {
    /// Its Python interpreter.
    pub fn python(&self) -> PathBuf {
        workspace::root().join(self.folder).join("bin/python")
    }

    /// Its interpreter, to be given a script. What that compiles is kept outside the folders of sources.
    pub fn interpreter_command(&self) -> Command {
        let mut command = Command::new(self.python());
        command.env("PYTHONPYCACHEPREFIX", workspace::target().join("pycache"));
        command
    }

    /// A program that finds those of the environment.
    pub fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        let own = workspace::root().join(self.folder).join("bin");
        let path = std::env::var_os("PATH").unwrap_or_default();
        if let Ok(path) = std::env::join_paths(std::iter::once(own).chain(std::env::split_paths(&path))) {
            command.env("PATH", path);
        }
        command
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
        // Most modules are never imported: each is compiled when it is.
        step::run_to_end(
            Command::new(self.python())
                .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile"])
                .args(self.requirements.iter().flat_map(|file| ["--requirement", file]))
                .current_dir(workspace::root()),
        )?;
        fs::write(&stamp, requirements).map_err(|error| format!("{}: {error}", stamp.display()))
    }
}
