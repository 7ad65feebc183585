//! Compiles the two cranes of the default run, and gives the program the specs of all shipped ones.

use std::path::PathBuf;
use std::{env, fs, io};

use crane_codegen::build;
use crane_codegen::chain::Analyses;

/// Cranes that `crane` without arguments compares.
const COMPILED: [&str; 2] = ["eight_link_flexible", "eight_link_rigid"];
const SPECS: &str = "../../specs";

fn main() -> io::Result<()> {
    // A program over cranes of its own compiles those.
    if env::var_os("CARGO_FEATURE_SHIPPED").is_none() {
        return Ok(());
    }
    println!("cargo::rerun-if-changed={SPECS}");
    let mut specs: Vec<PathBuf> = fs::read_dir(SPECS)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    specs.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    // The order of a folder differs from machine to machine.
    specs.sort();
    let mut texts = Vec::new();
    for spec in &specs {
        let name = spec.file_stem().unwrap_or_default().to_string_lossy();
        texts.push(format!("({name:?}, {:?}),", fs::read_to_string(spec)?));
        if COMPILED.contains(&name.as_ref()) {
            build::compile_spec_for(spec, Some(Analyses::COMMAND));
        }
    }
    let module = format!(
        "crane_model::cranes! {{ {} }}\n\n/// Names and specs (YAML) of all shipped cranes.\nconst SPECS: &[(&str, &str)] = &[{}];\n",
        COMPILED.join(", "),
        texts.concat(),
    );
    fs::write(build::out_dir().join("cranes.rs"), module)
}
