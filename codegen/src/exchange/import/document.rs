//! Elements and attributes of an XML file with their locations.

use std::fmt::Display;

use roxmltree::{Attribute, Document, Node, ParsingOptions};

use super::mistakes::rule;
use super::robot::Named;
use crate::diagnostic::{Mistake, SourceFile, Span};

/// Maximum number of elements and attributes; no robot has more.
const MOST_NODES: u32 = 200_000;

/// The elements of a file.
pub(super) fn parse(source: &SourceFile) -> Result<Document<'_>, Vec<Mistake>> {
    // Attributes of one element are compared with each other, so an excessive number is refused.
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(&source.text, options).map_err(|error| {
        let at = byte(&source.text, error.pos().row, error.pos().col);
        vec![rule::not_xml(Span { start: at, end: at }, error)]
    })
}

/// Reads attributes, and collects mistakes.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) mistakes: Vec<Mistake>,
}

impl Reader {
    /// A required attribute.
    pub(super) fn required(&mut self, node: Node, key: &str, owner: &str) -> Option<Named> {
        let Some(attribute) = node.attribute_node(key) else {
            self.mistakes.push(rule::missing(tag(node), owner, format!("`{key}=\"…\"`")));
            return None;
        };
        Some(Named { name: attribute.value().to_owned(), span: value_span(attribute) })
    }

    /// `N` finite numbers of a required attribute, or a mistake.
    pub(super) fn numbers<const N: usize>(&mut self, node: Node, key: &str, subject: &str) -> Option<[f64; N]> {
        self.required(node, key, subject)?;
        self.exact_numbers(node.attribute_node(key)?, subject)
    }

    /// The same for an attribute that is present.
    pub(super) fn exact_numbers<const N: usize>(&mut self, attribute: Attribute, subject: &str) -> Option<[f64; N]> {
        let found = finite_numbers(attribute.value()).and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        if found.is_none() {
            let expected =
                if N == 1 { "a finite number".to_owned() } else { format!("{N} finite numbers separated by blanks") };
            self.wrong_numbers(attribute, subject, expected);
        }
        found
    }

    /// Any number of finite numbers of an attribute, or a mistake.
    pub(super) fn some_numbers(&mut self, attribute: Attribute, subject: &str) -> Option<Vec<f64>> {
        let found = finite_numbers(attribute.value());
        if found.is_none() {
            self.wrong_numbers(attribute, subject, "finite numbers separated by blanks");
        }
        found
    }

    /// Reports an attribute that is not as `expected`.
    pub(super) fn wrong_numbers(&mut self, attribute: Attribute, subject: &str, expected: impl Display) {
        self.mistakes.push(rule::wrong_numbers(value_span(attribute), subject, attribute.value(), expected));
    }
}

fn finite_numbers(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace().map(|word| word.parse().ok().filter(|n: &f64| n.is_finite())).collect()
}

/// The first child with a name.
pub(super) fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// `<name`, the start of an element.
pub(super) fn tag(node: Node) -> Span {
    let start = node.range().start;
    Span { start, end: start + 1 + name_of(node).len() }
}

/// The name of an element as written, including its prefix.
pub(super) fn name_of<'a>(node: Node<'a, '_>) -> &'a str {
    let text = &node.document().input_text()[node.range()];
    let name = text.trim_start_matches('<');
    name.split(|c: char| c.is_whitespace() || c == '>' || c == '/').next().unwrap_or_default()
}

/// The text of an attribute between its quotes.
pub(super) fn value_span(attribute: Attribute) -> Span {
    let range = attribute.range_value();
    Span { start: range.start, end: range.end }
}

/// The byte at a line and a column, both from 1.
fn byte(text: &str, row: u32, column: u32) -> usize {
    let start: usize = text.split_inclusive('\n').take(row.saturating_sub(1) as usize).map(str::len).sum();
    let line = text[start..].split('\n').next().unwrap_or_default();
    start + line.char_indices().nth(column.saturating_sub(1) as usize).map_or(line.len(), |(at, _)| at)
}
