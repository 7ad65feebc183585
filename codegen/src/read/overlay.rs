//! Specs that extend others: their trees are merged, the later over the earlier.

use std::collections::BTreeSet;

use super::tree::{Content, Node};
use crate::diagnostic::{Mistake, Span, rule};

/// Key of the spec to start from.
const EXTENDS: &str = "extends";
/// Key that removes an entry of a list.
const REMOVE: &str = "remove";
/// Keys whose value is one of several kinds, a mapping with the kind's name as its key: a value of another kind replaces it.
const KINDS: [&str; 7] = ["joint", "law", "motion", "opening", "placement", "scale", "section"];
/// Keys that identify the entries of lists.
const IDENTITIES: [&str; 2] = ["name", "coordinate"];

impl Node {
    /// The node with all its locations shifted by a number of bytes.
    pub fn shifted(mut self, by: usize) -> Self {
        self.span = Span { start: self.span.start + by, end: self.span.end + by };
        self.content = match self.content {
            Content::Sequence(items) => Content::Sequence(items.into_iter().map(|item| item.shifted(by)).collect()),
            Content::Mapping(entries) => {
                let entry = |(key, value): (Node, Node)| (key.shifted(by), value.shifted(by));
                Content::Mapping(entries.into_iter().map(entry).collect())
            }
            scalar => scalar,
        };
        self
    }

    /// The spec that this one extends.
    pub fn base(&self) -> Option<(&str, Span)> {
        let value = self.entry(EXTENDS)?;
        match &value.content {
            Content::Text(name) => Some((name, value.span)),
            _ => None,
        }
    }

    /// The node without its `extends` key.
    pub fn without_base(self) -> Self {
        match self.content {
            Content::Mapping(mut entries) => {
                entries.retain(|(key, _)| key.key_text() != EXTENDS);
                Node { span: self.span, content: Content::Mapping(entries) }
            }
            content => Node { span: self.span, content },
        }
    }

    fn entry(&self, key: &str) -> Option<&Node> {
        let Content::Mapping(entries) = &self.content else { return None };
        entries.iter().find(|(known, _)| known.key_text() == key).map(|(_, value)| value)
    }

    /// The value that identifies an entry of a list.
    fn identity(&self) -> Option<String> {
        IDENTITIES.iter().find_map(|key| self.entry(key)).map(Node::key_text)
    }

    fn is_removal(&self) -> bool {
        self.entry(REMOVE).is_some_and(|value| matches!(value.content, Content::Boolean(true)))
    }
}

/// `over` merged over `base`.
pub(super) fn merge(base: Node, over: Node, mistakes: &mut Vec<Mistake>) -> Node {
    let content = match (base.content, over.content) {
        (Content::Mapping(base), Content::Mapping(over)) => Content::Mapping(merge_entries(base, over, mistakes)),
        (Content::Sequence(base), Content::Sequence(over)) if are_known(&base) && are_known(&over) => {
            Content::Sequence(merge_items(base, over, mistakes))
        }
        (_, content) => content,
    };
    Node { span: over.span, content }
}

/// Whether two values are of different kinds, such as joints that turn and joints that slide.
fn are_of_different_kinds(base: &Node, over: &Node) -> bool {
    let kind = |node: &Node| match &node.content {
        Content::Mapping(entries) => entries.first().map(|(key, _)| key.key_text()),
        _ => None,
    };
    kind(base) != kind(over)
}

fn are_known(items: &[Node]) -> bool {
    items.iter().all(|item| item.identity().is_some())
}

fn merge_entries(
    mut base: Vec<(Node, Node)>,
    over: Vec<(Node, Node)>,
    mistakes: &mut Vec<Mistake>,
) -> Vec<(Node, Node)> {
    let mut seen = BTreeSet::new();
    for (key, value) in over {
        if !seen.insert(key.key_text()) {
            // A duplicate key in one mapping is a mistake, which reading reports.
            base.push((key, value));
            continue;
        }
        let place = base.iter().position(|(known, _)| known.key_text() == key.key_text());
        match (place, &value.content) {
            (Some(place), Content::Null) => {
                base.remove(place);
            }
            (None, Content::Null) => mistakes.push(rule::nothing_to_remove(key.span, key.key_text())),
            (Some(place), _) => {
                let (_, known) = base.remove(place);
                let replaces = KINDS.contains(&key.key_text().as_str()) && are_of_different_kinds(&known, &value);
                let value = if replaces { value } else { merge(known, value, mistakes) };
                base.insert(place, (key, value));
            }
            (None, _) => base.push((key, value)),
        }
    }
    base
}

fn merge_items(mut base: Vec<Node>, over: Vec<Node>, mistakes: &mut Vec<Mistake>) -> Vec<Node> {
    let mut seen = BTreeSet::new();
    for item in over {
        if !seen.insert(item.identity()) {
            // A duplicate name in one list is a mistake, which validation reports.
            base.push(item);
            continue;
        }
        let place = base.iter().position(|known| known.identity() == item.identity());
        match place {
            Some(place) if item.is_removal() => {
                base.remove(place);
            }
            None if item.is_removal() => {
                mistakes.push(rule::nothing_to_remove(item.span, item.identity().unwrap_or_default()));
            }
            Some(place) => {
                let known = base.remove(place);
                base.insert(place, merge(known, item, mistakes));
            }
            None => base.push(item),
        }
    }
    base
}
