//! Lists every spec of this folder in `cranes.rs`, and compiles it where the crate has the feature `compiled`.

use std::path::{Path, PathBuf};
use std::{fs, io};

use crane_codegen::build;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=.");
    println!("cargo::metadata=folder={}", std::env::current_dir()?.display());
    let mut specs: Vec<PathBuf> = fs::read_dir(".")?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    specs.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    // The order of a folder differs from machine to machine.
    specs.sort();
    let names: Vec<String> = specs.iter().map(|spec| name(spec)).collect();
    // A spec that extends another is merged with it into one text: its readers do not have this folder.
    let texts: io::Result<Vec<String>> = names
        .iter()
        .zip(&specs)
        .map(|(name, spec)| Ok(format!("({name:?}, {:?}),", build::open(spec).map_err(io::Error::other)?.text)))
        .collect();
    let cranes = if cfg!(feature = "compiled") {
        format!("crane_model::cranes! {{ {} }}", names.join(", "))
    } else {
        String::new()
    };
    let module = format!(
        "{cranes}\n\n/// Names and specs (YAML) of all cranes.\npub const SPECS: &[(&str, &str)] = &[{}];\n",
        texts?.concat()
    );
    fs::write(build::out_dir().join("cranes.rs"), module)
}

/// Compiles the crane of a spec and returns its name. Tests and the command use every analysis of every crane.
#[cfg(feature = "compiled")]
fn name(spec: &Path) -> String {
    build::compile_spec_for(spec, Some(crane_codegen::chain::Analyses::ALL)).name
}

/// The name of the crane of a spec: that of the file.
#[cfg(not(feature = "compiled"))]
fn name(spec: &Path) -> String {
    spec.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
