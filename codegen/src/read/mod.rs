//! `SourceFile ─read→ CraneSpec`: text to the types of [`spec`](crate::spec).
//!
//! The text becomes a [`tree`] that keeps locations and duplicate keys; a [`deserializer`] reads the derived types from that
//! tree, notes every mistake and continues.

mod access;
mod deserializer;
mod tree;

use std::cell::RefCell;

use serde::Deserialize;

use crate::diagnostic::{Diagnostics, MAX_BYTES, SourceFile, Span, rule};
use crate::spec::{Crane, CraneSpec};
use deserializer::Reader;

/// Reads a spec as far as possible. Mistakes of keys and forms do not stop it: they are stored with the spec, and
/// [`validate`](crate::validate()) reports them together with its own.
///
/// # Errors
/// If reading cannot continue: the file is too large, empty, not YAML, or lacks keys that every crane has.
pub fn read(source: &SourceFile) -> Result<CraneSpec, Diagnostics> {
    let refuse = |mistakes| Diagnostics::new(source, mistakes);
    if source.text.len() > MAX_BYTES {
        let nothing = SourceFile::new(&source.name, "");
        return Err(Diagnostics::new(&nothing, vec![rule::too_large(Span::START, source.text.len(), MAX_BYTES)]));
    }
    let root = tree::parse(&source.text).map_err(|mistake| refuse(vec![mistake]))?;
    let mistakes = RefCell::default();
    match Crane::deserialize(Reader::root(&root, &mistakes)) {
        Ok(crane) => Ok(CraneSpec { crane, mistakes: mistakes.into_inner() }),
        Err(_) => Err(refuse(mistakes.into_inner())),
    }
}
