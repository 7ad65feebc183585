//! The Python environment of the checks with other libraries: made once, with pinned packages.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::{step, workspace};

const REQUIREMENTS: [&str; 2] = ["tools/casadi/requirements.txt", "tools/peers/requirements.txt"];

/// Python of the environment.
pub fn python() -> PathBuf {
    workspace::root().join(".venv/bin/python")
}

/// Makes the environment, unless it has what is required already.
pub fn prepare() -> Result<(), String> {
    let requirements = REQUIREMENTS.map(workspace::read).into_iter().collect::<Result<String, _>>()?;
    let stamp = workspace::root().join(".venv/requirements.installed");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == requirements) {
        println!("{} are installed", REQUIREMENTS.join(" and "));
        return Ok(());
    }
    let environment = workspace::root().join(".venv");
    step::finish(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&environment)).map_err(|error| {
        format!("{error}; Python 3.11 or newer with its venv module is needed (Debian: apt-get install python3-venv)")
    })?;
    step::finish(
        Command::new(python())
            .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])
            .args(REQUIREMENTS.iter().flat_map(|file| ["--requirement", file]))
            .current_dir(workspace::root()),
    )?;
    fs::write(&stamp, requirements).map_err(|error| format!("{}: {error}", stamp.display()))
}
