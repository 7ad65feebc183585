//! Elements and attributes of an XML file with their locations.
//!
//! An [`Element`] notes what is asked of it. Whatever a reader never asked for is left over at the end, and is told: nothing is dropped in
//! silence, and no list of what a reader ignores can be out of date.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::{Display, Write};

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

/// What became of elements and attributes, by the byte at which they begin.
#[derive(Default)]
pub(super) struct Notes(RefCell<BTreeMap<usize, Fate>>);

/// What became of an element or an attribute.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fate {
    Read,
    /// What it belongs to, which a spec does not have.
    LeftOut(&'static str),
}

/// What was left out for one reason: names with how many there are, and how many others there are.
type LeftOver = (Option<&'static str>, Vec<(String, usize)>, usize);

/// An element of a file.
#[derive(Clone, Copy)]
pub(super) struct Element<'a, 'i> {
    node: Node<'a, 'i>,
    notes: &'a Notes,
}

impl<'a, 'i> Element<'a, 'i> {
    /// The root of a file.
    pub(super) fn root(document: &'a Document<'i>, notes: &'a Notes) -> Self {
        Element { node: document.root_element(), notes }.read()
    }

    fn note(&self, at: usize, fate: Fate) {
        self.notes.0.borrow_mut().entry(at).or_insert(fate);
    }

    fn fate(&self, at: usize) -> Option<Fate> {
        self.notes.0.borrow().get(&at).copied()
    }

    /// The element, which is read from here on.
    pub(super) fn read(self) -> Self {
        self.note(self.node.range().start, Fate::Read);
        self
    }

    /// Leaves out the element and all that is in it. `what`: what it belongs to.
    pub(super) fn leave_out(self, what: &'static str) {
        self.note(self.node.range().start, Fate::LeftOut(what));
    }

    /// Leaves out the attributes of the element that were not asked for so far. `what`: what they belong to.
    pub(super) fn leave_out_rest(self, what: &'static str) {
        self.node.attributes().for_each(|attribute| self.note(attribute.range().start, Fate::LeftOut(what)));
    }

    /// The name as written, including its prefix.
    pub(super) fn name(self) -> &'a str {
        let text = &self.node.document().input_text()[self.node.range()];
        let name = text.trim_start_matches('<');
        name.split(|c: char| c.is_whitespace() || c == '>' || c == '/').next().unwrap_or_default()
    }

    /// The name without prefix.
    pub(super) fn local_name(self) -> &'a str {
        self.node.tag_name().name()
    }

    /// The address of the namespace.
    pub(super) fn namespace(self) -> Option<&'a str> {
        self.node.tag_name().namespace()
    }

    /// Whether this is its name, without a namespace.
    pub(super) fn is(self, name: &str) -> bool {
        self.node.has_tag_name(name)
    }

    /// `<name`, the start of the element.
    pub(super) fn tag(self) -> Span {
        let start = self.node.range().start;
        Span { start, end: start + 1 + self.name().len() }
    }

    /// An attribute, which is read.
    pub(super) fn attribute(self, key: &str) -> Option<Attribute<'a, 'i>> {
        let attribute = self.node.attribute_node(key)?;
        self.note(attribute.range().start, Fate::Read);
        Some(attribute)
    }

    /// The text of an attribute, which is read.
    pub(super) fn text(self, key: &str) -> Option<&'a str> {
        self.attribute(key).map(|attribute| attribute.value())
    }

    /// Whether it has an attribute; this does not read it.
    pub(super) fn has(self, key: &str) -> bool {
        self.node.has_attribute(key)
    }

    /// The names of its attributes.
    pub(super) fn keys(self) -> impl Iterator<Item = &'a str> {
        self.node.attributes().map(|attribute| attribute.name())
    }

    /// The texts of its attributes; this does not read them.
    pub(super) fn values(self) -> impl Iterator<Item = &'a str> {
        self.node.attributes().map(|attribute| attribute.value())
    }

    /// The text between its tags.
    pub(super) fn content(self) -> &'a str {
        self.node.text().unwrap_or_default().trim()
    }

    /// The element around it.
    pub(super) fn parent(self) -> Option<Self> {
        Some(Element { node: self.node.parent_element()?, ..self })
    }

    /// The elements in it.
    pub(super) fn elements(self) -> impl DoubleEndedIterator<Item = Self> + use<'a, 'i> {
        self.node.children().filter(Node::is_element).map(move |node| Element { node, ..self })
    }

    /// The elements in it with a name, which are read.
    pub(super) fn named(self, name: &str) -> impl Iterator<Item = Self> {
        self.elements().filter(move |element| element.is(name)).map(Element::read)
    }

    /// The first element in it with a name, which is read.
    pub(super) fn child(self, name: &str) -> Option<Self> {
        self.elements().find(|element| element.is(name)).map(Element::read)
    }

    /// The element and all elements in it, at any depth.
    pub(super) fn descendants(self) -> impl Iterator<Item = Self> {
        self.node.descendants().filter(Node::is_element).map(move |node| Element { node, ..self })
    }

    /// What of an element and all in it was left out or never asked for, one sentence for each reason.
    pub(super) fn remarks(self) -> Vec<String> {
        /// Names in one sentence; of more, their number is told.
        const MOST_NAMES: usize = 20;
        // By reason, the names with how many there are, in the order of the file, and how many others there are.
        let mut found: Vec<LeftOver> = Vec::new();
        let mut add = |reason: Option<&'static str>, name: String| {
            let index = found.iter().position(|(other, ..)| *other == reason).unwrap_or(found.len());
            if index == found.len() {
                found.push((reason, Vec::new(), 0));
            }
            let (_, names, others) = &mut found[index];
            match names.iter().position(|(other, _)| *other == name) {
                Some(index) => names[index].1 += 1,
                None if names.len() < MOST_NAMES => names.push((name, 1)),
                None => *others += 1,
            }
        };
        let mut open = vec![self];
        while let Some(element) = open.pop() {
            let name = element.name();
            match element.fate(element.node.range().start) {
                None => add(None, format!("<{name}>")),
                Some(Fate::LeftOut(what)) => add(Some(what), format!("<{name}>")),
                Some(Fate::Read) => {
                    // A name alone says nothing about the motion.
                    let attributes = element.node.attributes().filter(|attribute| attribute.name() != "name");
                    for attribute in attributes {
                        let text = || format!("`{}` of <{name}>", attribute.name());
                        match element.fate(attribute.range().start) {
                            None => add(None, text()),
                            Some(Fate::LeftOut(what)) => add(Some(what), text()),
                            Some(Fate::Read) => {}
                        }
                    }
                    open.extend(element.elements().rev());
                }
            }
        }
        let written =
            |(name, count): &(String, usize)| if *count > 1 { format!("{name} ({count})") } else { name.clone() };
        let sentence = |(reason, names, others): LeftOver| {
            let mut names = names.iter().map(written).collect::<Vec<_>>().join(", ");
            if others > 0 {
                let _ = write!(names, ", and {others} others");
            }
            match reason {
                Some(what) => format!("Left out, {what}: {names}."),
                None => format!("Not understood and left out: {names}."),
            }
        };
        // What was not understood comes first.
        found.sort_by_key(|(reason, ..)| reason.is_some());
        found.into_iter().map(sentence).collect()
    }
}

/// Reads attributes, and collects mistakes.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) mistakes: Vec<Mistake>,
}

impl Reader {
    /// A required attribute.
    pub(super) fn required(&mut self, element: Element, key: &str, owner: &str) -> Option<Named> {
        let Some(attribute) = element.attribute(key) else {
            self.mistakes.push(rule::missing(element.tag(), owner, format!("`{key}=\"…\"`")));
            return None;
        };
        Some(Named { name: attribute.value().to_owned(), span: value_span(attribute) })
    }

    /// `N` finite numbers of a required attribute, or a mistake.
    pub(super) fn numbers<const N: usize>(&mut self, element: Element, key: &str, subject: &str) -> Option<[f64; N]> {
        self.required(element, key, subject)?;
        self.exact_numbers(element.attribute(key)?, subject)
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

pub(super) fn finite_numbers(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace().map(|word| word.parse().ok().filter(|n: &f64| n.is_finite())).collect()
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

#[cfg(test)]
mod tests {
    use super::byte;

    /// Columns count characters, spans count bytes; beyond the end of a line is its end.
    #[test]
    fn a_place_in_a_line_is_a_byte() {
        let text = "ab\ncdé f\ng";
        assert_eq!(
            [byte(text, 1, 1), byte(text, 2, 1), byte(text, 2, 4), byte(text, 2, 9), byte(text, 3, 1)],
            [0, 3, 7, 9, 10]
        );
    }
}
