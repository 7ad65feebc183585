//! A new crane as `crane new` creates it: made, tested, run.

use std::process::Command;
use std::{fs, io};

use crate::units::profile_of_kept_programs;
use crate::{step, workspace};

/// Where the new crate is made, under cargo's target folder.
const FOLDER: &str = "new-crane";

/// What the programs of other tests that compile a crane are built with: what these have built is used again.
const UNOPTIMISED: &str = "tests/unoptimised/.cargo/config.toml";

/// Makes a crate, runs its tests and its program.
pub fn check_new_crane() -> Result<(), String> {
    let folder = workspace::target().join(FOLDER);
    match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(format!("{}: {error}", folder.display())),
        _ => {}
    }
    let crane = workspace::target().join("release/crane");
    step::run_to_end(Command::new(crane).arg("new").arg(&folder).args(["--from", "knuckle-boom"]))?;
    // The profile of the workspace, so that what is already built is reused; a user's crate has a simpler one.
    let profile = workspace::target().join("new-crane.profile.toml");
    fs::write(&profile, profile_of_kept_programs()?).map_err(|error| format!("{}: {error}", profile.display()))?;
    for task in ["test", "run"] {
        let mut cargo = Command::new(step::cargo());
        cargo.args([task, "--release", "--config"]).arg(&profile);
        cargo.arg("--config").arg(workspace::root().join(UNOPTIMISED));
        step::run_to_end(cargo.env("CARGO_TARGET_DIR", workspace::target()).current_dir(&folder))?;
    }
    Ok(())
}
