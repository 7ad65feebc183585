//! Files of the workspace.

use std::path::{Path, PathBuf};

use crane_codegen::chain::Chain;
use crane_codegen::{SourceFile, compile};

/// The workspace's root.
#[must_use]
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package is a folder of the workspace").to_owned()
}

/// All shipped specs, in order of name.
#[must_use]
pub fn specs() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("specs")).expect("specs/ is there");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("specs/ can be read").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    paths.sort();
    paths
}

/// The chain of a shipped spec.
#[must_use]
pub fn chain(name: &str) -> Chain {
    let path = root().join("specs").join(format!("{name}.yaml"));
    let text = std::fs::read_to_string(&path).expect("the spec is there");
    chain_of(name, &text)
}

/// The chain of the reference crane with another number of sections.
#[must_use]
pub fn reference(sections: usize) -> Chain {
    chain_of("reference", &reference_text(sections))
}

/// The reference crane with another number of sections, and symmetric joints between them.
#[must_use]
pub fn reference_symmetric(sections: usize) -> Chain {
    let mut text = reference_text(sections);
    assert!(text.contains("section_joint: paper"), "the reference crane has the paper's joints");
    text = text.replace("section_joint: paper", "section_joint: symmetric");
    chain_of("reference_symmetric", &text)
}

fn reference_text(sections: usize) -> String {
    let path = root().join("specs/eight_link_flexible.yaml");
    let text = std::fs::read_to_string(&path).expect("the spec is there");
    let changed = text.replace("sections: 4", &format!("sections: {sections}"));
    assert!(sections == 4 || changed != text, "the reference crane has 4 sections");
    changed
}

/// The chain of a spec's text.
#[must_use]
pub fn chain_of(name: &str, text: &str) -> Chain {
    compile::load(&SourceFile::new(name, text)).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}
