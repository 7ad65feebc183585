//! Compiles random cranes, and the small cranes that no spec ships, so that tests run generated code.

use std::path::PathBuf;
use std::{fs, io};

use crane_codegen::chain::Analyses;
use crane_codegen::compile::compile;
use crane_codegen::{SourceFile, build};

#[path = "src/random/mod.rs"]
mod random;

/// Random cranes that are compiled: few that have, together with the shipped cranes, all that random cranes have. The interpreter runs many more.
const SEEDS: [u64; 3] = [1, 2, 4];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/random");
    let mut random = Vec::new();
    for seed in SEEDS {
        let name = format!("random_{seed}");
        let text = random::spec(seed);
        let source = SourceFile::new(format!("{name}.yaml"), text.as_str());
        // Warnings are ignored: the materials are soft on purpose, to keep numbers comparable in size.
        let code = compile(&source, Some(Analyses::ALL)).map_err(io::Error::other)?.code;
        fs::write(build::out_dir().join(&source.name), &text)?;
        fs::write(build::out_dir().join(format!("{name}.rs")), code.text)?;
        random.push(name);
    }
    build::compile_spec_for("no-std/exact.yaml", Some(Analyses::ALL));
    let shipped = names("../specs")?;
    let registry = format!("registry! {{ shipped: [{}], random: [{}] }}\n", shipped.join(", "), random.join(", "));
    fs::write(build::out_dir().join("registry.rs"), registry)
}

/// Names of the specs in a folder.
fn names(folder: &str) -> io::Result<Vec<String>> {
    println!("cargo::rerun-if-changed={folder}");
    let paths: Vec<PathBuf> = fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    let yaml = paths.iter().filter(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    let mut names: Vec<String> = yaml.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect();
    names.sort();
    Ok(names)
}
