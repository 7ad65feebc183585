//! The Python package `crane`, in `apps/python`: installed as a user does it, and tested.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::python::CHECKS;
use crate::{step, workspace};

const FOLDER: &str = "apps/python";
/// The stub of the native part.
const STUB: &str = "apps/python/crane/_native.pyi";

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

/// Writes the stub of the native part from its sources.
pub fn write_stub() -> Result<(), String> {
    fs::write(workspace::root().join(STUB), stub()?).map_err(|error| format!("{STUB}: {error}"))
}

/// Checks that the stub is that of the sources.
pub fn check_stub() -> Result<(), String> {
    let (stub, written) = (stub()?, workspace::read_file(STUB)?);
    match stub.lines().zip(written.lines()).find(|(line, written)| line != written) {
        _ if stub == written => Ok(()),
        Some((line, written)) => Err(format!("{STUB} has `{written}`, sources `{line}`: cargo xtask bless stub")),
        None => Err(format!("{STUB} and sources differ in length: cargo xtask bless stub")),
    }
}

/// The stub: names, types and documentation of the native part, which a build of its own contains, not optimised.
fn stub() -> Result<String, String> {
    let quick = "profile.release.package.crane-python.opt-level=0";
    let build = ["build", "--release", "--package", "crane-python", "--example", "stub", "--features", "stub"];
    let cargo = || {
        let mut cargo = Command::new(step::cargo());
        cargo.current_dir(workspace::root());
        cargo
    };
    step::run_to_end(cargo().args(build).args(["--config", quick]))?;
    let library = format!("release/examples/{}stub{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let mut print = cargo();
    print.args(["run", "--quiet", "--locked", "--manifest-path", "tools/stub/Cargo.toml", "--target-dir"]);
    print.arg(workspace::target().join("stub")).arg("--").arg(workspace::target().join(library)).arg("_native");
    let printed = print.output().map_err(|error| format!("cargo: {error}"))?;
    if !printed.status.success() {
        return Err(String::from_utf8_lossy(&printed.stderr).into_owned());
    }
    let text = String::from_utf8(printed.stdout).map_err(|error| error.to_string())?;
    Ok(format!("# Written by `cargo xtask bless` from {FOLDER}/src.\n{text}"))
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
