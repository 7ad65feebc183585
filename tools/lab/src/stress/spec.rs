//! Specs of cases: written for a case, or a shipped one with changes.

use crane_codegen::SourceFile;

/// A spec.
#[derive(Clone, Debug)]
pub struct Spec(SourceFile);

impl Spec {
    /// A spec as written.
    pub fn new(text: impl Into<String>) -> Self {
        Self(SourceFile::new("spec", text))
    }

    /// The same crane with changes, as a spec that extends it.
    pub fn changed(&self, changes: &str) -> Self {
        Self(self.0.changed(changes))
    }

    /// What the compiler reads.
    pub fn source(&self) -> &SourceFile {
        &self.0
    }
}
