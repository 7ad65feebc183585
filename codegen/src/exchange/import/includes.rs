//! Files in MJCF that include others.

use std::collections::BTreeSet;

use super::document::parse;
use crate::diagnostic::{MAX_BYTES, SourceFile};

/// A file in which each `<include file="…"/>` is replaced by what is in the root of that file, as `MuJoCo` does, also in what was included.
/// `read`: the text of a file by its name as written. An include that cannot be read, or for the second time, stays as it is, and
/// [`import`](super::import) reports it. The name of the result lists the files, because its lines are counted through.
#[must_use]
pub fn with_includes(source: SourceFile, read: &mut dyn FnMut(&str) -> Option<String>) -> SourceFile {
    let mut source = source;
    let mut known = BTreeSet::new();
    // It ends, because each name is read once; names come from texts of limited size.
    while let Some((place, file, content)) = next_include(&source, &mut known, read) {
        if source.text.len() + content.len() > MAX_BYTES {
            break;
        }
        source.text.replace_range(place, &content);
        source.name += " with ";
        source.name += file.rsplit(['/', '\\']).next().unwrap_or_default();
    }
    source
}

/// The place of the next include that can be read, the name of its file and what is in its root.
fn next_include(
    source: &SourceFile,
    known: &mut BTreeSet<String>,
    read: &mut dyn FnMut(&str) -> Option<String>,
) -> Option<(std::ops::Range<usize>, String, String)> {
    let document = parse(source).ok()?;
    let mut includes = document.descendants().filter(|node| node.has_tag_name("include"));
    includes.find_map(|node| {
        let file = node.attribute("file")?;
        let text = known.insert(file.to_owned()).then(|| read(file)).flatten()?;
        let included = SourceFile::new(file, text);
        let document = parse(&included).ok()?;
        let inside = document.root_element().first_child().zip(document.root_element().last_child());
        let content = inside.map_or("", |(first, last)| &included.text[first.range().start..last.range().end]);
        Some((node.range(), file.to_owned(), content.to_owned()))
    })
}
