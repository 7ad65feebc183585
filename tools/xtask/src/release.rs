//! What is published: the command as one file, the Python package as a wheel, the crates; made, and tried where there is no Rust and no
//! source tree.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use crate::step;
use crate::workspace::{self, published};

/// The crates that others build on and the command, each after those that it needs.
const CRATES: [&str; 10] = [
    "crane-quantities",
    "crane-keys",
    "crane-codegen",
    "crane-jit",
    "crane-model",
    "crane-live",
    "crane-specs",
    "crane-page",
    "crane-fmu",
    "crane-cli",
];
/// What belongs beside the command.
const BESIDE: [&str; 4] = ["LICENSE-APACHE", "LICENSE-MIT", "CHANGELOG.md", "specs/crane.schema.json"];
/// Uses the package without anything that was not installed with it.
pub const TRY_PACKAGE: &str = "import crane, numpy
loaded = crane.load('knuckle_boom')
assert loaded.statics().status == 'stable'
run = loaded.simulate(duration=0.5)
assert numpy.isfinite(run['t']).all() and run['t'][-1] == 0.5
print(loaded)";

/// Makes the command for this machine and packages of the crates.
pub fn build_release() -> Result<(), String> {
    pack_command()?;
    pack_crates()
}

/// Tries the wheel for this machine.
pub fn rehearse_wheel() -> Result<(), String> {
    let bare = published().join("bare");
    clear(&bare)?;
    try_package(&bare)
}

/// Makes what is published for this machine, the wheel as it was built for its tests, and tries it in environments that have nothing else.
pub fn rehearse_release() -> Result<(), String> {
    let archive = pack_command()?;
    pack_crates()?;
    write_checksums()?;
    let bare = published().join("bare");
    clear(&bare)?;
    try_command(&archive, &bare)?;
    try_package(&bare)
}

/// The command with the library of functional mock-up units inside, without symbols, in an archive.
fn pack_command() -> Result<PathBuf, String> {
    let library = format!("{}crane_fmu_library{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX);
    let built = workspace::target().join("release");
    let mut cargo = Command::new(step::cargo());
    step::run_to_end(
        cargo.args(crate::ALL_PROGRAMS).env("CRANE_UNIT_LIBRARY", built.join(library)).current_dir(workspace::root()),
    )?;

    let program = built.join(format!("crane-alone{}", env::consts::EXE_SUFFIX));
    let stripped = built.join("crane-stripped");
    step::run_to_end(Command::new("strip").arg("-o").args([&stripped, &program]))?;
    pack(&stripped, &workspace::host_triple()?)
}

/// A command and what belongs beside it, in an archive that is named after a processor and its system.
pub fn pack(program: &Path, triple: &str) -> Result<PathBuf, String> {
    let name = format!("crane-{}-{triple}", env!("CARGO_PKG_VERSION"));
    let packed = published().join(&name);
    clear(&packed)?;
    copy(program, &packed.join("crane"))?;
    for file in BESIDE {
        let path = workspace::root().join(file);
        copy(&path, &packed.join(path.file_name().unwrap_or_default()))?;
    }
    let archive = published().join(format!("{name}.tar.gz"));
    step::run_to_end(Command::new("tar").arg("-czf").arg(&archive).arg("-C").arg(published()).arg(&name))?;
    Ok(archive)
}

/// Packages of the crates as registries take them; they are not compiled again.
fn pack_crates() -> Result<(), String> {
    let mut cargo = Command::new(step::cargo());
    cargo.args(["package", "--quiet", "--no-verify", "--allow-dirty", "--target-dir"]).arg(published().join("crates"));
    cargo.args(CRATES.iter().flat_map(|name| ["--package", name]));
    step::run_to_end(cargo.current_dir(workspace::root()))
}

/// The list of everything that is published.
pub fn write_checksums() -> Result<(), String> {
    let list = "cd \"$0\" && sha256sum *.tar.gz *.whl crates/package/*.crate > SHA256SUMS && cat SHA256SUMS";
    step::run_to_end(Command::new("sh").args(["-c", list]).arg(published()))
}

/// The command from its archive, alone in a folder: it checks, computes, and makes a functional mock-up unit that runs, and a crate.
fn try_command(archive: &Path, bare: &Path) -> Result<(), String> {
    step::run_to_end(Command::new("tar").arg("-xzf").arg(archive).args(["--strip-components", "1", "-C"]).arg(bare))?;
    let crane = |arguments: &[&str]| step::run_to_end(alone(bare.join("crane"), bare).args(arguments));
    let example = alone(bare.join("crane"), bare).args(["example", "knuckle_boom"]).output();
    let example = example.map_err(|error| format!("crane example: {error}"))?.stdout;
    fs::write(bare.join("boom.yaml"), example).map_err(|error| error.to_string())?;
    crane(&["check", "boom.yaml"])?;
    crane(&["statics", "boom.yaml", "-q"])?;
    crane(&["report", "boom.yaml", "--duration", "0.2", "-o", "boom.html", "-q"])?;
    crane(&["export", "boom.yaml", "--format", "fmu", "-o", "boom.fmu"])?;
    let simulate = "import fmpy, sys; print(fmpy.simulate_fmu(sys.argv[1], stop_time=0.5)[-1])";
    step::run_to_end(Command::new(crate::python::CHECKS.python()).args(["-c", simulate]).arg(bare.join("boom.fmu")))?;
    // The sources that it carries are those that a command beside the tree copies, which another check compiles.
    let tree = workspace::target().join("release").join("crane");
    for (command, folder) in [(bare.join("crane"), "carried"), (tree, "tree")] {
        let path = bare.join(folder).join("new-crane");
        fs::create_dir_all(bare.join(folder)).map_err(|error| error.to_string())?;
        step::run_to_end(alone(command, bare).args(["new", "--vendor", "-q"]).arg(path))?;
    }
    step::run_to_end(Command::new("diff").args(["-r", "carried", "tree"]).current_dir(bare))
}

/// The wheel in an environment of its own.
fn try_package(bare: &Path) -> Result<(), String> {
    let environment = bare.join("python");
    step::run_to_end(Command::new("python3").args(["-m", "venv"]).arg(&environment))?;
    let python = environment.join("bin/python");
    let wheels = "set -- \"$1\"/*_\"$2\".whl && \"$0\" -m pip install --quiet --disable-pip-version-check \"$1\"";
    step::run_to_end(Command::new("sh").args(["-c", wheels]).arg(&python).arg(published()).arg(env::consts::ARCH))?;
    step::run_to_end(alone(&python, bare).args(["-c", TRY_PACKAGE]))
}

/// A program without the variables of this process, so without Rust.
fn alone(program: impl AsRef<OsStr>, folder: &Path) -> Command {
    let mut command = Command::new(program);
    command.env_clear().env("HOME", folder).env("PATH", folder).current_dir(folder);
    command
}

/// An empty folder.
pub fn clear(folder: &Path) -> Result<(), String> {
    let failed = |error: io::Error| format!("{}: {error}", folder.display());
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(failed(error)),
        _ => {}
    }
    fs::create_dir_all(folder).map_err(failed)
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    fs::copy(from, to).map(|_| ()).map_err(|error| format!("{}: {error}", from.display()))
}
