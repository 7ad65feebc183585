//! Files of the workspace.

use std::path::{Path, PathBuf};

use crane_codegen::chain::Chain;
use crane_codegen::{SourceFile, build, compile};

/// The workspace's root.
#[must_use]
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is a folder of the workspace").to_owned()
}

/// All shipped specs, sorted by name.
#[must_use]
pub fn specs() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("specs")).expect("specs/ is there");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("specs/ can be read").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    paths.sort();
    paths
}

/// A spec, together with those that it extends.
#[must_use]
pub fn source(path: &Path) -> SourceFile {
    build::open(path).unwrap_or_else(|failure| panic!("{failure}"))
}

/// A shipped spec.
#[must_use]
pub fn shipped(name: &str) -> SourceFile {
    source(&root().join("specs").join(format!("{name}.yaml")))
}

/// The chain of a shipped spec.
#[must_use]
pub fn chain(name: &str) -> Chain {
    chain_in(&shipped(name))
}

/// The chain of the reference crane with another number of sections.
#[must_use]
pub fn reference(sections: usize) -> Chain {
    reference_with(&format!("sections: {sections}"))
}

/// The reference crane with another number of sections, and symmetric joints between them.
#[must_use]
pub fn reference_symmetric(sections: usize) -> Chain {
    reference_with(&format!("sections: {sections}, section_joint: symmetric"))
}

/// The reference crane with changed keys in its boom's beam.
fn reference_with(beam: &str) -> Chain {
    chain_in(&shipped("eight_link_flexible").changed(&format!("links: [{{name: boom, beam: {{{beam}}}}}]")))
}

/// The chain of a spec's text.
#[must_use]
pub fn chain_of(name: &str, text: &str) -> Chain {
    chain_in(&SourceFile::new(name, text))
}

/// The chain of a spec.
#[must_use]
pub fn chain_in(source: &SourceFile) -> Chain {
    compile::load(source).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}
