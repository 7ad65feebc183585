//! A place in the tree at which a value is read.

use std::cell::RefCell;
use std::fmt::{self, Display};

use super::measure::Measure;
use super::slips;
use super::tree::{Content, Node};
use crate::diagnostic::{Mistake, Span, rule};

/// Why a value could not be read.
#[derive(Debug)]
pub(crate) enum Unread {
    /// A mistake was reported.
    Reported,
    /// It is not what its type expects.
    Expected(String),
}

/// The description of a node in messages.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Subject<'a> {
    /// The whole file.
    Whole,
    /// The value of a key.
    Key(&'a str),
    /// An entry of the list of a key, by its own name if it has one.
    Entry(&'a str, Option<&'a str>),
}

impl<'a> Subject<'a> {
    /// The key that contains it.
    pub fn key(self) -> &'a str {
        match self {
            Subject::Whole => "",
            Subject::Key(key) | Subject::Entry(key, _) => key,
        }
    }
}

impl Display for Subject<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Subject::Whole => f.write_str("the crane"),
            Subject::Key(key) => write!(f, "`{key}`"),
            Subject::Entry(key, Some(name)) => write!(f, "`{name}` of `{key}`"),
            Subject::Entry(key, None) => write!(f, "an entry of `{key}`"),
        }
    }
}

/// A node to read, or the location where one is missing.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a> {
    /// The node, unless it is missing.
    pub node: Option<&'a Node>,
    /// Its location, or the location where it is missing.
    pub span: Span,
    /// Its description in messages.
    pub subject: Subject<'a>,
    /// The description of its owner.
    pub owner: Subject<'a>,
    /// What its numbers measure.
    pub measure: &'static Measure,
    /// The mistakes so far.
    pub mistakes: &'a RefCell<Vec<Mistake>>,
}

impl<'a> Reader<'a> {
    /// A reader of the whole file.
    pub fn root(node: &'a Node, mistakes: &'a RefCell<Vec<Mistake>>) -> Self {
        let (span, subject) = (node.span, Subject::Whole);
        Reader { node: Some(node), span, subject, owner: subject, measure: &Measure::NONE, mistakes }
    }

    /// Notes a mistake; the value is then [`Unread::Reported`].
    pub fn report(&self, mistake: Mistake) -> Unread {
        self.mistakes.borrow_mut().push(mistake);
        Unread::Reported
    }

    /// Notes that the value is not what was expected, unless that was reported already.
    pub fn report_unread(&self, unread: Unread) {
        if let (Unread::Expected(mut expected), Some(node)) = (unread, self.node) {
            if let Some(number) = slips::number_with_commas(&node.content) {
                expected = number;
            }
            let (written, kind) = (node.content.describe(), node.content.kind());
            self.report(rule::wrong_value(self.span, self.subject, written, kind, expected));
        }
    }

    /// The node's content; a missing node is a mistake.
    pub fn content(&self) -> Result<&'a Content, Unread> {
        match self.node {
            Some(node) => Ok(&node.content),
            None => Err(self.report(rule::missing_key(self.span, self.subject.key(), self.owner))),
        }
    }

    /// Readers of the items of a list.
    pub fn items(self) -> Result<Vec<Reader<'a>>, Unread> {
        let Content::Sequence(items) = self.content()? else { return Err(Unread::Expected("a list".into())) };
        Ok(items.iter().enumerate().map(|(index, item)| self.item(index, item)).collect())
    }

    /// The reader of an item of a list.
    pub fn item(self, index: usize, item: &'a Node) -> Reader<'a> {
        Reader {
            node: Some(item),
            measure: self.measure.of_item(index),
            span: shown_item(item),
            subject: Subject::Entry(self.subject.key(), name_of(item)),
            ..self
        }
    }

    /// Checks that the value is a list of so many items.
    pub fn check_length(&self, count: usize) -> Result<(), Unread> {
        match self.content()? {
            Content::Sequence(items) if items.len() == count => Ok(()),
            Content::Sequence(items) => {
                let help = slips::decimals_as_items(items, count).unwrap_or_else(|| format!("write {count} items"));
                Err(self.report(rule::wrong_length(self.span, self.subject, count, items.len(), help)))
            }
            _ => Err(Unread::Expected(format!("a list of {count} numbers"))),
        }
    }
}

/// The location shown for a value: a scalar itself, a list or mapping at its key.
pub(super) fn shown(key: Span, value: &Node) -> Span {
    match value.content {
        Content::Sequence(_) | Content::Mapping(_) | Content::Null => key,
        _ => value.span,
    }
}

/// The location shown for an item of a list: a mapping at its first key.
fn shown_item(item: &Node) -> Span {
    match &item.content {
        Content::Mapping(entries) => entries.first().map_or(item.span, |(key, _)| key.span),
        _ => item.span,
    }
}

/// The `name` of an item of a list.
fn name_of(item: &Node) -> Option<&str> {
    let Content::Mapping(entries) = &item.content else { return None };
    entries.iter().find_map(|(key, value)| match (&key.content, &value.content) {
        (Content::Text(key), Content::Text(name)) if key == "name" => Some(name.as_str()),
        _ => None,
    })
}
