//! Lists every spec of this folder in `specs.rs`.

use std::path::PathBuf;
use std::{fs, io};

use crane_codegen::build;

fn main() -> io::Result<()> {
    println!("cargo::metadata=folder={}", std::env::current_dir()?.display());
    println!("cargo::rerun-if-changed=.");
    let mut specs: Vec<PathBuf> = fs::read_dir(".")?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    specs.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    // The order of a folder differs from machine to machine.
    specs.sort();
    // A spec that extends another is merged with it into one text: its readers do not have this folder.
    let texts: io::Result<Vec<String>> = specs
        .iter()
        .map(|spec| {
            let name = spec.file_stem().unwrap_or_default().to_string_lossy();
            Ok(format!("({name:?}, {:?}),", build::open(spec).map_err(io::Error::other)?.text))
        })
        .collect();
    let specs = texts?.concat();
    let list = format!("/// Names and specs (YAML) of all cranes.\npub const SPECS: &[(&str, &str)] = &[{specs}];\n");
    fs::write(build::out_dir().join("specs.rs"), list)
}
