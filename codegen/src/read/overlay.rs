//! Specs that extend others: their trees are merged, the later over the earlier.

use std::collections::BTreeSet;

use crate::diagnostic::{Span, nearest, rule, suggest};
use crate::node::{Content, Node};
use crate::spec::{Lookalike, Noticed};

/// Key of the spec to start from.
const EXTENDS: &str = "extends";
/// Key that removes an entry of a list.
const REMOVE: &str = "remove";
/// Key that places an entry of a list behind another one.
const AFTER: &str = "after";
/// Keys whose value is one of several kinds, a mapping with the kind's name as its key: a value of another kind replaces it.
const KINDS: [&str; 8] = ["joint", "law", "motion", "opening", "placement", "scale", "section", "shape"];
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

    pub(super) fn entry(&self, key: &str) -> Option<&Node> {
        let Content::Mapping(entries) = &self.content else { return None };
        entries.iter().find(|(known, _)| known.key_text() == key).map(|(_, value)| value)
    }

    /// The value that identifies an entry of a list.
    pub(super) fn identity(&self) -> Option<String> {
        self.identity_node().map(Node::key_text)
    }

    /// The key of that value.
    pub(super) fn identity_key(&self) -> &'static str {
        IDENTITIES.iter().find(|key| self.entry(key).is_some()).copied().unwrap_or_default()
    }

    fn identity_node(&self) -> Option<&Node> {
        IDENTITIES.iter().find_map(|key| self.entry(key))
    }

    fn is_removal(&self) -> bool {
        self.entry(REMOVE).is_some_and(|value| matches!(value.content, Content::Boolean(true)))
    }

    /// Without the key `after`, and that key's value.
    fn without_place(mut self) -> (Self, Option<Node>) {
        let Content::Mapping(entries) = &mut self.content else { return (self, None) };
        let index = entries.iter().position(|(key, _)| key.key_text() == AFTER);
        let after = index.map(|index| entries.remove(index).1);
        (self, after)
    }

    /// Where the text of a node ends that contains no alias.
    fn end(&self) -> usize {
        let last = match &self.content {
            Content::Sequence(items) => items.iter().map(Node::end).max(),
            Content::Mapping(entries) => entries.iter().map(|(key, value)| key.end().max(value.end())).max(),
            _ => None,
        };
        last.map_or(self.span.end, |last| last.max(self.span.end))
    }
}

/// `over` merged over `base`.
pub(super) fn merge(base: Node, over: Node, noticed: &mut Noticed) -> Node {
    let content = match (base.content, over.content) {
        (Content::Mapping(base), Content::Mapping(over)) => Content::Mapping(merge_entries(base, over, noticed)),
        (Content::Sequence(base), Content::Sequence(over)) if are_known(&base) && are_known(&over) => {
            Content::Sequence(merge_items(base, over, noticed))
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

fn merge_entries(mut base: Vec<(Node, Node)>, over: Vec<(Node, Node)>, noticed: &mut Noticed) -> Vec<(Node, Node)> {
    let mut seen = BTreeSet::new();
    for (key, value) in over {
        if !seen.insert(key.key_text()) {
            // A duplicate key in one mapping is a mistake, which reading reports.
            base.push((key, value));
            continue;
        }
        let index = base.iter().position(|(known, _)| known.key_text() == key.key_text());
        match (index, &value.content) {
            (Some(index), Content::Null) => {
                base.remove(index);
            }
            (None, Content::Null) => {
                let known: Vec<String> = base.iter().map(|(key, _)| key.key_text()).collect();
                let help = suggest(&key.key_text(), known.iter().map(String::as_str));
                noticed.mistakes.push(rule::nothing_to_remove(key.span, key.key_text(), help));
            }
            (Some(index), _) => {
                let (_, known) = base.remove(index);
                let replaces = KINDS.contains(&key.key_text().as_str()) && are_of_different_kinds(&known, &value);
                let value = if replaces { value } else { merge(known, value, noticed) };
                base.insert(index, (key, value));
            }
            (None, _) => base.push((key, value)),
        }
    }
    base
}

fn merge_items(mut base: Vec<Node>, over: Vec<Node>, noticed: &mut Noticed) -> Vec<Node> {
    let extended: Vec<String> = base.iter().filter_map(Node::identity).collect();
    let extended = || extended.iter().map(String::as_str);
    let mut seen = BTreeSet::new();
    for item in over {
        let name = item.identity().unwrap_or_default();
        if !seen.insert(name.clone()) {
            // A duplicate name in one list is a mistake, which validation reports.
            base.push(item);
            continue;
        }
        let place_of =
            |items: &[Node], name: &str| items.iter().position(|item| item.identity().as_deref() == Some(name));
        let index = place_of(&base, &name);
        if item.is_removal() {
            if let Some(index) = index {
                base.remove(index);
            } else {
                let help = suggest(&name, extended());
                noticed.mistakes.push(rule::nothing_to_remove(item.span, name, help));
            }
            continue;
        }
        if index.is_none()
            && let Some(known) = nearest(&name, extended())
        {
            let at = item.identity_node().map_or(item.span, |node| node.span);
            let span = Span { start: item.span.start, end: item.end() };
            noticed.lookalikes.push(Lookalike { name: name.clone(), at, span, known: known.to_owned() });
        }
        let (item, after) = item.without_place();
        let (index, item) = match index {
            Some(index) => (index, merge(base.remove(index), item, noticed)),
            None => (base.len(), item),
        };
        let behind = after.map(|after| {
            place_of(&base, &after.key_text()).map_or_else(
                || {
                    let names: Vec<String> = base.iter().filter_map(Node::identity).collect();
                    let help = suggest(&after.key_text(), names.iter().map(String::as_str));
                    noticed.mistakes.push(rule::nothing_before(after.span, after.key_text(), help));
                    index
                },
                |other| other + 1,
            )
        });
        base.insert(behind.unwrap_or(index), item);
    }
    base
}
