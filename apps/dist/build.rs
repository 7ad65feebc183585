//! Lists what the command carries: the shared library of functional mock-up units, if the variable `CRANE_UNIT_LIBRARY` names one, and the
//! sources that `crane new` copies.

use std::path::Path;
use std::{env, fs, io};

#[path = "../cli/src/new/sources.rs"]
mod sources;

const LIBRARY: &str = "CRANE_UNIT_LIBRARY";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-env-changed={LIBRARY}");
    println!("cargo::rerun-if-changed=build.rs");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize()?;
    // With all that is in it.
    for name in sources::CRATES {
        println!("cargo::rerun-if-changed={}", root.join(name).join("src").display());
    }
    let mut carried = String::new();
    for name in sources::list_files(&root).map_err(|(_, error)| error)? {
        let file = root.join(&name);
        println!("cargo::rerun-if-changed={}", file.display());
        let (name, file) = (text(&name)?, text(&file)?);
        carried.extend([format!("({name:?}, include_str!({file:?})),\n")]);
    }
    let library = match env::var_os(LIBRARY) {
        Some(path) => {
            let path = Path::new(&path).canonicalize()?;
            println!("cargo::rerun-if-changed={}", path.display());
            format!("Some(include_bytes!({:?}))", text(&path)?)
        }
        None => "None".to_owned(),
    };
    let carried = format!("const CARRIED: Carried = Carried {{ unit_library: {library}, sources: &[\n{carried}] }};\n");
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    fs::write(Path::new(&out).join("carried.rs"), carried)
}

/// A path as text, which source code can contain.
fn text(path: &Path) -> io::Result<&str> {
    path.to_str().ok_or_else(|| io::Error::other(format!("{}: a path that is not UTF-8", path.display())))
}
