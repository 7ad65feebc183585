//! Compiles the cranes of `specs/` for the `cranes` feature.

#[cfg(feature = "cranes")]
fn main() -> std::io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    cranes::compile("../specs")
}

#[cfg(not(feature = "cranes"))]
fn main() {
    println!("cargo::rerun-if-changed=build.rs");
}

#[cfg(feature = "cranes")]
mod cranes {
    use std::path::PathBuf;
    use std::{fs, io};

    use crane_codegen::build;
    use crane_codegen::chain::Analyses;

    /// Compiles every spec of a folder, and writes `cranes.rs`, which declares them.
    pub fn compile(folder: &str) -> io::Result<()> {
        println!("cargo::rerun-if-changed={folder}");
        let mut specs: Vec<PathBuf> =
            fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
        specs.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
        // The order of a folder differs from machine to machine.
        specs.sort();
        // The command offers every analysis of every crane.
        let compile = |spec: &PathBuf| build::compile_spec_for(spec, Some(Analyses::ALL)).name;
        let names: Vec<String> = specs.iter().map(compile).collect();
        let texts: io::Result<Vec<String>> = names
            .iter()
            .zip(&specs)
            .map(|(name, spec)| Ok(format!("({name:?}, {:?}),", fs::read_to_string(spec)?)))
            .collect();
        let module = format!(
            "crate::cranes! {{ {} }}\n\n/// Names and specs (YAML) of all cranes.\npub const SPECS: &[(&str, &str)] = &[{}];\n",
            names.join(", "),
            texts?.concat()
        );
        fs::write(build::out_dir().join("cranes.rs"), module)
    }
}
