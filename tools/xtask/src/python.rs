//! The Python environment of the CasADi check: made once, with pinned packages.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::{step, workspace};

const REQUIREMENTS: &str = "tools/casadi/requirements.txt";

/// Python of the environment.
pub fn python() -> PathBuf {
    workspace::root().join(".venv/bin/python")
}

/// Makes the environment, unless it has what is required already.
pub fn prepare() -> Result<(), String> {
    let requirements = workspace::read(REQUIREMENTS)?;
    let stamp = workspace::root().join(".venv/requirements.installed");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == requirements) {
        println!("{REQUIREMENTS} is installed");
        return Ok(());
    }
    let environment = workspace::root().join(".venv");
    step::finish(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&environment)).map_err(|error| {
        format!("{error}; Python 3.11 or newer with its venv module is needed (Debian: apt-get install python3-venv)")
    })?;
    step::finish(
        Command::new(python())
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement"])
            .arg(workspace::root().join(REQUIREMENTS)),
    )?;
    fs::write(&stamp, requirements).map_err(|error| format!("{}: {error}", stamp.display()))
}
