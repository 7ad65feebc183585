//! The Python package `crane`, in `apps/python`: installed as a user does it, and tested.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::python::CHECKS;
use crate::{step, workspace};

const FOLDER: &str = "apps/python";

/// Builds the wheel of the package into a folder, in place of others there, and returns its path.
pub fn build_wheel(folder: &Path) -> Result<PathBuf, String> {
    clear_wheels(folder)?;
    let pip = ["-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-build-isolation", "--no-deps"];
    step::run_to_end(python(&pip).arg("--wheel-dir").arg(folder).arg(format!("./{FOLDER}")))?;
    wheels(folder)?.pop().ok_or_else(|| format!("pip wrote no wheel to {}", folder.display()))
}

/// Removes the wheels in a folder, which need not exist.
pub fn clear_wheels(folder: &Path) -> Result<(), String> {
    let failed = |error: io::Error| format!("{}: {error}", folder.display());
    fs::create_dir_all(folder).map_err(failed)?;
    wheels(folder)?.iter().try_for_each(fs::remove_file).map_err(failed)
}

fn wheels(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let list = || -> io::Result<Vec<PathBuf>> {
        let paths: Vec<PathBuf> = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
        Ok(paths.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "whl")).collect())
    };
    list().map_err(|error| format!("{}: {error}", folder.display()))
}

/// The Python of the checks, with the programs of its environment, of which maturin is one, and those of the workspace.
fn python(arguments: &[&str]) -> Command {
    let mut command = CHECKS.interpreter_command();
    command
        .args(arguments)
        .current_dir(workspace::root())
        .env("CARGO", step::cargo())
        .env("CARGO_TARGET_DIR", workspace::target());
    let own = workspace::target().join("release");
    let programs = CHECKS.python().parent().map(ToOwned::to_owned).into_iter().chain([own]);
    let path = std::env::var_os("PATH").unwrap_or_default();
    if let Ok(path) = std::env::join_paths(programs.chain(std::env::split_paths(&path))) {
        command.env("PATH", path);
    }
    command
}

/// Installs the package's wheel into the environment of the checks, and runs its tests there, in a folder that does not hold its sources.
pub fn check_package() -> Result<(), String> {
    let wheel = build_wheel(&workspace::published())?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--force-reinstall"];
    step::run_to_end(python(&install).arg(wheel))?;
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
