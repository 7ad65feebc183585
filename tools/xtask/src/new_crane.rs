//! A new crane as `crane new` creates it: made, tested, run.

use std::process::Command;
use std::{fs, io};

use crate::{step, workspace};

/// Where the new crate is made, under cargo's target folder.
const FOLDER: &str = "new-crane";

/// The profile of the workspace, so that what is already built is reused; a user's crate has a simpler one.
const PROFILE: [&str; 9] = [
    "build-override.opt-level=3",
    "build-override.codegen-units=16",
    "package.\"*\".opt-level=1",
    "package.nalgebra.opt-level=3",
    "package.simba.opt-level=3",
    "package.wide.opt-level=3",
    "package.serde-saphyr.opt-level=3",
    "package.crane-codegen.opt-level=3",
    "package.crane-model.opt-level=2",
];

/// Makes a crate, runs its tests and its program.
pub fn check_new_crane() -> Result<(), String> {
    let folder = workspace::target().join(FOLDER);
    match fs::remove_dir_all(&folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(format!("{}: {error}", folder.display())),
        _ => {}
    }
    let crane = workspace::target().join("release/crane");
    step::run_to_end(Command::new(crane).arg("new").arg(&folder).args(["--from", "knuckle-boom"]))?;
    for task in ["test", "run"] {
        let mut cargo = Command::new(step::cargo());
        cargo.args([task, "--release"]).env("CARGO_TARGET_DIR", workspace::target()).current_dir(&folder);
        cargo.args(PROFILE.iter().flat_map(|setting| ["--config".to_owned(), format!("profile.release.{setting}")]));
        step::run_to_end(&mut cargo)?;
    }
    Ok(())
}
