//! Compiles every spec of this folder, and writes `cranes.rs`, which declares them.

use std::path::PathBuf;
use std::{fs, io};

use crane_codegen::build;
use crane_codegen::chain::Analyses;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=.");
    let mut specs: Vec<PathBuf> = fs::read_dir(".")?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    specs.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    // The order of a folder differs from machine to machine.
    specs.sort();
    // Tests and the command use every analysis of every crane.
    let compile = |spec: &PathBuf| build::compile_spec_for(spec, Some(Analyses::ALL)).name;
    let names: Vec<String> = specs.iter().map(compile).collect();
    let texts: io::Result<Vec<String>> = names
        .iter()
        .zip(&specs)
        .map(|(name, spec)| Ok(format!("({name:?}, {:?}),", fs::read_to_string(spec)?)))
        .collect();
    let module = format!(
        "crane_model::cranes! {{ {} }}\n\n/// Names and specs (YAML) of all cranes.\npub const SPECS: &[(&str, &str)] = &[{}];\n",
        names.join(", "),
        texts?.concat()
    );
    fs::write(build::out_dir().join("cranes.rs"), module)
}
