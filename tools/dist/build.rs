//! Lists what the command carries: the shared library of functional mock-up units, if the variable `CRANE_UNIT_LIBRARY` names one, and the
//! sources that `crane new` copies.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Crates that a new crate depends on, and files of the workspace that belong to them.
const FOLDERS: [&str; 4] = ["crane-model", "codegen", "codegen/keys", "quantities"];
const FILES: [&str; 3] = ["Cargo.toml", "LICENSE-APACHE", "LICENSE-MIT"];
const LIBRARY: &str = "CRANE_UNIT_LIBRARY";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-env-changed={LIBRARY}");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize()?;
    let mut files: Vec<PathBuf> = FILES.iter().map(|file| root.join(file)).collect();
    for folder in FOLDERS {
        files.push(root.join(folder).join("Cargo.toml"));
        collect(&root.join(folder).join("src"), &mut files)?;
    }
    files.sort();
    let mut sources = String::new();
    for file in &files {
        println!("cargo::rerun-if-changed={}", file.display());
        let name = file.strip_prefix(&root).map_err(io::Error::other)?;
        let (name, file) = (text(name)?, text(file)?);
        sources.extend([format!("({name:?}, include_str!({file:?})),\n")]);
    }
    let library = match env::var_os(LIBRARY) {
        Some(path) => {
            let path = Path::new(&path).canonicalize()?;
            println!("cargo::rerun-if-changed={}", path.display());
            format!("Some(include_bytes!({:?}))", text(&path)?)
        }
        None => "None".to_owned(),
    };
    let carried = format!("const CARRIED: Carried = Carried {{ unit_library: {library}, sources: &[\n{sources}] }};\n");
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    fs::write(Path::new(&out).join("carried.rs"), carried)
}

/// A path as text, which source code can contain.
fn text(path: &Path) -> io::Result<&str> {
    path.to_str().ok_or_else(|| io::Error::other(format!("{}: a path that is not UTF-8", path.display())))
}

/// All files of a folder.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    println!("cargo::rerun-if-changed={}", folder.display());
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() { collect(&path, files)? } else { files.push(path) }
    }
    Ok(())
}
