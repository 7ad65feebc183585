//! Changes of a spec as values: what a file that extends it would contain.

use std::cell::RefCell;

use super::overlay::{Noticed, merge};
use super::place::written;
use crate::diagnostic::{Diagnostics, Span};
use crate::node::{Content, FromNode, Node, Reader};
use crate::spec::{Crane, CraneSpec};

/// What is laid over a value of a spec, by the rules for specs that [extend](crate::SourceFile::extended) others.
///
/// ```
/// use crane_codegen::Change;
/// let held = Change::keys([("coordinate", "boom_psi".into()), ("motion", Change::keys([("hold", 0.5.into())]))]);
/// let change = Change::keys([("drives", Change::list([held]))]);
/// assert_eq!(change.text(), "drives:\n  - {coordinate: boom_psi, motion: {hold: 0.5}}\n");
/// ```
#[derive(Clone, Debug)]
pub struct Change(Node);

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

    /// Entries of a list, which are laid over those of the same name or coordinate.
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
            let key = key.key_text();
            match &value.content {
                Content::Sequence(items) if !items.is_empty() => {
                    let items = items.iter().map(|item| format!("  - {}\n", written(item)));
                    format!("{key}:\n{}", items.collect::<String>())
                }
                Content::Mapping(inner) if !inner.is_empty() => {
                    let inner = inner.iter().map(|(key, value)| format!("  {}: {}\n", key.key_text(), written(value)));
                    format!("{key}:\n{}", inner.collect::<String>())
                }
                _ => format!("{key}: {}\n", written(value)),
            }
        };
        entries.iter().map(line).collect()
    }
}

/// A spec with changes: its tree is not parsed again. Locations are those of its file, for new values those of what they replace.
///
/// # Errors
/// As of [`read`](super::read).
pub(crate) fn changed(spec: &CraneSpec, change: &Change) -> Result<CraneSpec, Diagnostics> {
    let mut noticed = Noticed::default();
    let over = placed(change.0.clone(), Some(&spec.tree), spec.tree.span);
    let tree = merge(spec.tree.clone(), over, &mut noticed);
    typed(tree, noticed, &spec.source)
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
            let known = |item: &Node| match base.map(|base| &base.content) {
                Some(Content::Sequence(all)) => all.iter().find(|one| one.identity() == item.identity()),
                _ => None,
            };
            let item = |item: Node| {
                let known = known(&item);
                placed(item, known, span)
            };
            Content::Sequence(items.into_iter().map(item).collect())
        }
        scalar => scalar,
    };
    Node { span, content }
}

/// The types of a tree.
pub(super) fn typed(tree: Node, noticed: Noticed, source: &crate::SourceFile) -> Result<CraneSpec, Diagnostics> {
    let mistakes = RefCell::new(noticed.mistakes);
    let crane = Crane::from_node(Reader::root(&tree, &mistakes));
    let mistakes = mistakes.into_inner();
    match crane {
        Ok(crane) => Ok(CraneSpec { crane, mistakes, lookalikes: noticed.lookalikes, source: source.clone(), tree }),
        Err(_) => Err(Diagnostics::new(source, mistakes)),
    }
}
