//! Compiles every spec of the folder above.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

use crane_codegen::build;
use crane_codegen::chain::Analyses;

fn main() -> io::Result<()> {
    let folder = env::var_os("DEP_CRANE_SPECS_FOLDER").ok_or(io::ErrorKind::NotFound)?;
    println!("cargo::rerun-if-changed={}", Path::new(&folder).display());
    let mut specs: Vec<PathBuf> = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    specs.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    // The order of a folder differs from machine to machine.
    specs.sort();
    let names: Vec<String> = specs.iter().map(|spec| build::compile_spec_for(spec, Some(Analyses::ALL)).name).collect();
    fs::write(build::out_dir().join("cranes.rs"), format!("crane_model::cranes! {{ {} }}", names.join(", ")))
}
