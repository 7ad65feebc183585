//! Compiles the two cranes of the default run, and keeps the versions of all dependencies for crates that the command makes.

use std::path::Path;
use std::{env, fs, io};

use crane_codegen::build;
use crane_codegen::chain::Analyses;

/// The lock file, in the workspace and in a package.
const LOCKS: [&str; 2] = ["../../Cargo.lock", "Cargo.lock"];

fn main() -> io::Result<()> {
    let lock = LOCKS.into_iter().find(|lock| Path::new(lock).is_file()).ok_or(io::ErrorKind::NotFound)?;
    println!("cargo::rerun-if-changed={lock}");
    fs::write(build::out_dir().join("Cargo.lock"), fs::read(lock)?)?;
    let specs = env::var_os("DEP_CRANE_SPECS_FOLDER").ok_or(io::ErrorKind::NotFound)?;
    for name in ["eight_link_flexible", "eight_link_rigid"] {
        build::compile_spec_for(Path::new(&specs).join(name).with_extension("yaml"), Some(Analyses::COMMAND));
    }
    Ok(())
}
