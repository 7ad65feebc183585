//! Changes of a spec as values: what a file that extends it would contain.

use std::cell::RefCell;

use super::overlay::merge;
use super::place::{key_written, written};
use crate::diagnostic::{Diagnostics, SourceFile, Span};
use crate::node::{Content, FromNode, Node, Reader};
use crate::spec::{Crane, CraneSpec, Noticed};

/// What is laid over a value of a spec, by the rules for specs that [extend](crate::SourceFile::extended) others.
///
/// ```
/// use crane_codegen::Change;
/// let held = Change::keys([("coordinate", "boom_psi".into()), ("motion", Change::keys([("hold", 0.5.into())]))]);
/// let change = Change::keys([("drives", Change::list([held]))]);
/// assert_eq!(change.text(), "drives:\n  - {coordinate: boom_psi, motion: {hold: 0.5}}\n");
/// ```
#[derive(Clone, Debug)]
pub struct Change(pub(super) Node);

impl From<Content> for Change {
    fn from(content: Content) -> Self {
        Change(Node { span: Span::START, content })
    }
}

impl From<f64> for Change {
    fn from(number: f64) -> Self {
        Content::Number(number).into()
    }
}

impl From<bool> for Change {
    fn from(flag: bool) -> Self {
        Content::Boolean(flag).into()
    }
}

impl From<&str> for Change {
    fn from(word: &str) -> Self {
        Content::Text(word.to_owned()).into()
    }
}

impl Change {
    /// What a key names is removed.
    #[must_use]
    pub fn removed() -> Self {
        Content::Null.into()
    }

    /// Entries of a list, which are laid over those of the same name or coordinate; without names, a list in place of another one.
    #[must_use]
    pub fn list(items: impl IntoIterator<Item = Change>) -> Self {
        Content::Sequence(items.into_iter().map(|item| item.0).collect()).into()
    }

    /// Keys with what is laid over their values.
    #[must_use]
    pub fn keys<K: AsRef<str>>(entries: impl IntoIterator<Item = (K, Change)>) -> Self {
        let entry = |(key, change): (K, Change)| (Change::from(key.as_ref()).0, change.0);
        Content::Mapping(entries.into_iter().map(entry).collect()).into()
    }

    /// As a file has it, which extends the spec.
    #[must_use]
    pub fn text(&self) -> String {
        let Content::Mapping(entries) = &self.0.content else { return written(&self.0) };
        let line = |(key, value): &(Node, Node)| {
            let key = key_written(key);
            match &value.content {
                Content::Sequence(items) if !items.is_empty() => {
                    let items = items.iter().map(|item| format!("  - {}\n", written(item)));
                    format!("{key}:\n{}", items.collect::<String>())
                }
                Content::Mapping(inner) if !inner.is_empty() => {
                    let inner =
                        inner.iter().map(|(key, value)| format!("  {}: {}\n", key_written(key), written(value)));
                    format!("{key}:\n{}", inner.collect::<String>())
                }
                _ => format!("{key}: {}\n", written(value)),
            }
        };
        entries.iter().map(line).collect()
    }
}

impl CraneSpec {
    /// The spec with a change. Nothing is parsed: locations are those of its file, for new values those of what they replace.
    ///
    /// # Errors
    /// As of [`read`](crate::read).
    pub fn changed(&self, change: &Change) -> Result<Self, Diagnostics> {
        let mut noticed = self.noticed.clone();
        let over = placed(change.0.clone(), Some(&self.tree), self.tree.span);
        let tree = merge(self.tree.clone(), over, &mut noticed);
        typed(tree, noticed, &self.source, self.saved.changed(&change.text()))
    }

    /// Whether a word is a value somewhere in it, such as the name of a parameter in place of a number.
    #[must_use]
    pub fn mentions(&self, word: &str) -> bool {
        fn mentions(node: &Node, word: &str) -> bool {
            match &node.content {
                Content::Text(text) => text == word,
                Content::Sequence(items) => items.iter().any(|item| mentions(item, word)),
                Content::Mapping(entries) => entries.iter().any(|(_, value)| mentions(value, word)),
                _ => false,
            }
        }
        mentions(&self.tree, word)
    }
}

/// The node of a change with the locations of what it is laid over; `around`: where there is nothing.
fn placed(node: Node, base: Option<&Node>, around: Span) -> Node {
    let span = base.map_or(around, |base| base.span);
    let content = match node.content {
        Content::Mapping(entries) => {
            let entry = |(key, value): (Node, Node)| {
                let known = base.and_then(|base| base.entry(&key.key_text()));
                (Node { span: known.map_or(span, |known| known.span), ..key }, placed(value, known, span))
            };
            Content::Mapping(entries.into_iter().map(entry).collect())
        }
        Content::Sequence(items) => {
            let all = match base.map(|base| &base.content) {
                Some(Content::Sequence(all)) => &all[..],
                _ => &[],
            };
            let item = |(index, item): (usize, Node)| {
                let known = match item.identity() {
                    Some(name) => all.iter().find(|one| one.identity().as_ref() == Some(&name)),
                    None => all.get(index),
                };
                placed(item, known, span)
            };
            Content::Sequence(items.into_iter().enumerate().map(item).collect())
        }
        scalar => scalar,
    };
    Node { span, content }
}

/// The types of a tree.
pub(super) fn typed(
    tree: Node,
    noticed: Noticed,
    source: &SourceFile,
    saved: SourceFile,
) -> Result<CraneSpec, Diagnostics> {
    let mistakes = RefCell::new(noticed.mistakes.clone());
    let crane = Crane::from_node(Reader::root(&tree, &mistakes));
    let mistakes = mistakes.into_inner();
    match crane {
        Ok(crane) => Ok(CraneSpec { crane, mistakes, noticed, source: source.clone(), saved, tree }),
        Err(_) => Err(Diagnostics::new(source, mistakes)),
    }
}
