//! Your own crane as `crane new` begins it: made, tested, run.

use std::process::Command;
use std::{fs, io};

use crate::{step, workspace};

/// Where the new crate is made, under cargo's target folder.
const FOLDER: &str = "new-crane";

/// Makes a crate, runs its tests and its program.
pub fn check() -> Result<(), String> {
    let folder = workspace::target().join(FOLDER);
    match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(format!("{}: {error}", folder.display())),
        _ => {}
    }
    let crane = workspace::target().join("release/crane");
    step::finish(Command::new(crane).arg("new").arg(&folder).args(["--from", "knuckle-boom"]))?;
    for task in ["test", "run"] {
        let mut cargo = Command::new(step::cargo());
        // What the workspace has built serves again: the same folder, and the same profile.
        cargo.env("CARGO_TARGET_DIR", workspace::target()).env("CARGO_PROFILE_RELEASE_DEBUG", "line-tables-only");
        cargo.args([task, "--release"]).current_dir(&folder);
        step::finish(&mut cargo)?;
    }
    Ok(())
}
