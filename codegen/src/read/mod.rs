//! `SourceFile ─read→ CraneSpec`: text to the types of [`spec`](crate::spec).
//!
//! The text becomes a tree of [nodes](crate::node); specs that extend each other are merged, and tables from files are put in their place.

mod change;
mod data;
mod overlay;
mod place;

use crate::diagnostic::{Diagnostics, MAX_BYTES, Mistake, SourceFile, Span, rule};
use crate::node::{Node, parse, slips};
use crate::spec::{CraneSpec, Noticed};
pub use change::Change;
use change::typed;

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
    let mut noticed = Noticed::default();
    let root = parts(source, &mut noticed).map_err(|mistake| refuse(vec![mistake]))?;
    typed(root, noticed, source, source.clone())
}

/// The tree of a source file, with its parts merged, each over the previous ones.
fn parts(source: &SourceFile, noticed: &mut Noticed) -> Result<Node, Mistake> {
    let mut whole: Option<Node> = None;
    for part in source.parts() {
        let shifted = |mut mistake: Mistake| {
            mistake.span = Span { start: mistake.span.start + part.start, end: mistake.span.end + part.start };
            mistake
        };
        let mut tree = parse(part.text).map_err(shifted)?;
        let mut undashed = Vec::new();
        slips::split_entries(&mut tree, "", part.text, &mut undashed);
        noticed.mistakes.extend(undashed.into_iter().map(shifted));
        let tree = tree.shifted(part.start);
        whole = Some(match whole {
            Some(base) => overlay::merge(base, tree.without_base(), noticed),
            None => tree,
        });
    }
    let mut whole = whole.ok_or_else(|| rule::empty(Span::START))?;
    data::fill(&mut whole, source, &mut noticed.mistakes);
    // Only the code that reads files can follow `extends`; here it was not followed.
    if let Some((base, span)) = whole.base() {
        noticed.mistakes.push(rule::no_base(
            span,
            base,
            "this spec is text, not a file, so there is no folder to look in",
        ));
    }
    Ok(whole.without_base())
}

/// The spec that a source file extends and the location of its name, if there is one.
#[must_use]
pub(crate) fn base(source: &SourceFile) -> Option<(String, Span)> {
    // A file of several parts was already assembled.
    let [part] = source.parts()[..] else { return None };
    if !may_have(part.text, "extends") {
        return None;
    }
    let tree = parse(part.text).ok()?.shifted(part.start);
    tree.base().map(|(name, span)| (name.to_owned(), span))
}

/// Whether a text may have a key, which is then looked for in its tree: of most specs only [`read`] makes one.
fn may_have(text: &str, key: &str) -> bool {
    text.contains(key) || text.contains('\\')
}

/// The data files that a spec refers to, with the locations of their names.
#[must_use]
pub(crate) fn data_files(source: &SourceFile) -> Vec<(String, Span)> {
    if !may_have(&source.text, "file") {
        return Vec::new();
    }
    let tree = parse(&source.text);
    let files = tree.as_ref().map(data::files).unwrap_or_default();
    files.into_iter().map(|(name, span)| (name.to_owned(), span)).collect()
}
