//! What is published for Linux with an old C library or on aarch64: built on any machine, with zig as the linker and its C library; and what is for
//! aarch64, tried in an emulator.
//!
//! The system in which the emulator runs programs is unpacked from packages of Debian, which are not installed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::package::clear_wheels;
use crate::python::CROSS;
use crate::release::{TRY_PACKAGE, clear, pack};
use crate::step;
use crate::workspace::{self, published};

const X86_64: &str = "x86_64-unknown-linux-gnu";
const AARCH64: &str = "aarch64-unknown-linux-gnu";
/// The oldest C library with which programs of Rust work.
const GLIBC: &str = "2.17";
/// Of Debian's package qemu-user-static.
const EMULATOR: &str = "qemu-aarch64-static";
/// Machine code is made where it can be, and has the bits of bytecode.
const TRY_MACHINE_CODE: &str = "import crane, platform
def executable():
    return sum('r-xp' in line and len(line.split()) == 5 for line in open('/proc/self/maps'))
loaded = crane.load('eight_link_flexible')
rest = loaded.statics()
assert rest.status == 'stable' and platform.machine() == 'aarch64'
before, first = executable(), loaded.mass_matrix(rest.q)
for _ in range(2000):
    last = loaded.mass_matrix(rest.q)
assert executable() > before and (first == last).all()
print(loaded, 'with machine code')";
/// The library in a functional mock-up unit is for the processor.
const TRY_UNIT: &str = "import ctypes, zipfile
zipfile.ZipFile('boom.fmu').extractall('unit')
library = ctypes.CDLL('./unit/binaries/aarch64-linux/knuckle_boom.so')
library.fmi3GetVersion.restype = ctypes.c_char_p
assert library.fmi3GetVersion() == b'3.0'";

/// Installs Rust for the processors, maturin and zig, unless they are installed.
pub fn prepare() -> Result<(), String> {
    CROSS.prepare()?;
    step::run_to_end(Command::new("rustup").args(["target", "add", X86_64, AARCH64]))
}

/// Builds the wheels that package indexes take, in place of others.
pub fn build_wheels() -> Result<(), String> {
    clear_wheels(&published())?;
    [X86_64, AARCH64].into_iter().try_for_each(build_wheel)
}

/// Builds the wheel and the command for aarch64.
pub fn build_for_aarch64() -> Result<(), String> {
    build_wheel(AARCH64)?;
    build_command()
}

/// Builds the command for aarch64, which has the library of functional mock-up units inside.
pub fn build_command() -> Result<(), String> {
    let library = cargo(&["--package", "crane-fmu-library", "--lib"], None)?.join("libcrane_fmu_library.so");
    let built = cargo(&["--package", "crane-dist", "--bin", "crane-alone"], Some(&library))?;
    pack(&built.join("crane-alone"), AARCH64).map(drop)
}

/// Builds the wheel for a processor.
fn build_wheel(triple: &str) -> Result<(), String> {
    let mut maturin = CROSS.command("maturin");
    maturin
        .args(["build", "--release", "--zig", "--target", triple, "--compatibility", "manylinux2014", "--quiet"])
        .args(["--manifest-path", "apps/python/Cargo.toml", "--out"])
        .arg(published())
        .env("CARGO_TARGET_DIR", workspace::target())
        .current_dir(workspace::root());
    step::run_to_end(&mut maturin)
}

/// Builds something for aarch64, without symbols, and returns the folder where it is.
fn cargo(what: &[&str], library: Option<&Path>) -> Result<PathBuf, String> {
    // Not where maturin builds: each would build again what the other one built with other settings of the linker.
    let folder = workspace::target().join("cross");
    let mut cargo = CROSS.command("cargo-zigbuild");
    cargo
        .args(["rustc", "--release", "--target", &format!("{AARCH64}.{GLIBC}")])
        .args(what)
        .args(["--", "-C", "strip=symbols"])
        .env("CARGO_TARGET_DIR", &folder)
        .current_dir(workspace::root());
    if let Some(library) = library {
        cargo.env("CRANE_UNIT_LIBRARY", library);
    }
    step::run_to_end(&mut cargo)?;
    Ok(folder.join(AARCH64).join("release"))
}

/// Where the emulator finds a system: a C library and Python.
fn system() -> PathBuf {
    workspace::target().join("aarch64")
}

/// Unpacks packages of Debian into a folder, with lists of packages that are not those of this machine.
pub fn unpack_system() -> Result<(), String> {
    let folder = system();
    if folder.join("usr/bin/python3").exists() {
        println!("{} has a system", folder.display());
        return Ok(());
    }
    clear(&folder)?;
    let script = "set -e
mkdir -p apt/lists/partial apt/archives/partial
: > apt/status
apt() {
    apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State=\"$PWD/apt\" -o Dir::State::status=\"$PWD/apt/status\" \\
        -o Dir::Cache=\"$PWD/apt\" -o APT::Sandbox::User=root -o Debug::NoLocking=1 \"$@\"
}
apt update
apt install --yes --no-install-recommends --download-only python3 libgcc-s1 libstdc++6
for package in apt/archives/*.deb; do dpkg-deb -x \"$package\" .; done
rm -r apt
test -e lib || ln -s usr/lib lib";
    step::run_to_end(Command::new("sh").args(["-c", script]).current_dir(&folder))
}

/// Tries the command and the wheel in the emulator.
pub fn rehearse() -> Result<(), String> {
    let bare = published().join("bare-aarch64");
    clear(&bare)?;
    let name = format!("crane-{}-{AARCH64}.tar.gz", env!("CARGO_PKG_VERSION"));
    let mut unpack = Command::new("tar");
    step::run_to_end(
        unpack.arg("-xzf").arg(published().join(name)).args(["--strip-components", "1", "-C"]).arg(&bare),
    )?;
    let command = bare.join("crane");
    let example = emulated(&command, &bare).args(["example", "knuckle_boom"]).output();
    let example = example.map_err(|error| format!("{EMULATOR}: {error} (Debian: apt-get install qemu-user-static)"))?;
    fs::write(bare.join("boom.yaml"), example.stdout).map_err(|error| error.to_string())?;
    let tries: [&[&str]; 5] = [
        &["check", "boom.yaml"],
        &["statics", "boom.yaml"],
        &["report", "boom.yaml", "--duration", "0.2", "-o", "boom.html", "-q"],
        &["export", "boom.yaml", "--format", "fmu", "--fmi", "3.0", "-o", "boom.fmu"],
        &["new", "--vendor", "-q", "new-crane"],
    ];
    for arguments in tries {
        step::run_to_end(emulated(&command, &bare).args(arguments))?;
    }

    let python = system().join("usr/bin/python3");
    let version = "import sys; print('%d.%d' % sys.version_info[:2])";
    let version = emulated(&python, &bare).args(["-c", version]).output().map_err(|error| error.to_string())?;
    let version = String::from_utf8_lossy(&version.stdout).trim().to_owned();
    // As on such a machine: pip refuses a wheel that is not for it.
    let install = "set -- \"$1\" \"$2\" \"$1\"/*_aarch64.whl && \"$0\" -m pip install --quiet --disable-pip-version-check --only-binary :all: \
        --platform manylinux_2_17_aarch64 --platform manylinux2014_aarch64 --platform manylinux_2_28_aarch64 \
        --python-version \"$2\" --target packages \"$3\"";
    let mut pip = Command::new("sh");
    step::run_to_end(pip.args(["-c", install]).arg(CROSS.python()).arg(published()).arg(version).current_dir(&bare))?;
    for script in [TRY_UNIT, TRY_PACKAGE, TRY_MACHINE_CODE] {
        step::run_to_end(emulated(&python, &bare).args(["-c", script]))?;
    }
    Ok(())
}

/// A program for aarch64 in the emulator, with nothing else.
fn emulated(program: &Path, folder: &Path) -> Command {
    let mut command = Command::new(EMULATOR);
    command.arg("-L").arg(system()).arg(program).current_dir(folder);
    command.env("PYTHONPATH", folder.join("packages")).env("HOME", folder);
    command
}
