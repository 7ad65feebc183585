//! The Python package `crane`, in `tools/python`: installed as a user does it, and tested.

use std::process::Command;

use crate::python::CHECKS;
use crate::{step, workspace};

const FOLDER: &str = "tools/python";

/// Installs the package from the clone into the environment of the checks, and runs its tests there, in a folder that does not hold
/// its sources.
pub fn check_package() -> Result<(), String> {
    let root = workspace::root();
    let python = |arguments: &[&str]| {
        let mut command = Command::new(CHECKS.python());
        command
            .args(arguments)
            .current_dir(&root)
            .env("CARGO", step::cargo())
            .env("CARGO_TARGET_DIR", workspace::target());
        // maturin is one of the environment's own programs.
        let programs = CHECKS.python().parent().map(ToOwned::to_owned).into_iter();
        let path = std::env::var_os("PATH").unwrap_or_default();
        if let Ok(path) = std::env::join_paths(programs.chain(std::env::split_paths(&path))) {
            command.env("PATH", path);
        }
        command
    };
    let install =
        ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-build-isolation", "--no-deps"];
    step::run_to_end(python(&install).args(["--force-reinstall", &format!("./{FOLDER}")]))?;
    let tests = format!("{FOLDER}/tests");
    step::run_to_end(&mut python(&[
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "--rootdir",
        FOLDER,
        "--durations",
        "5",
        &tests,
    ]))
}
