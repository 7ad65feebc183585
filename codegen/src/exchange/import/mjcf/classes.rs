//! Attributes with the defaults of their classes.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Attribute;

use crate::diagnostic::suggest;
use crate::exchange::import::document::{Element, Reader, value_span};
use crate::exchange::import::mistakes::rule;

/// The class of elements that name none.
const MAIN: &str = "main";

/// Classes of defaults. A class within another one is defined once, after that one, so that no class inherits from itself.
#[derive(Default)]
pub(super) struct Classes<'a, 'i> {
    by_name: BTreeMap<&'a str, Class<'a, 'i>>,
    /// Attributes that some element was asked for, by the element that gives their defaults.
    asked: RefCell<BTreeMap<&'a str, BTreeSet<String>>>,
}

/// A class: its elements, and the class whose defaults it inherits.
#[derive(Default)]
struct Class<'a, 'i> {
    nodes: Vec<Element<'a, 'i>>,
    parent: Option<&'a str>,
}

impl<'a, 'i> Classes<'a, 'i> {
    /// Reads all `<default>` sections; reports classes within others that have no name or that of another one, and names of classes that
    /// are not defined.
    pub(super) fn read(root: Element<'a, 'i>, reader: &mut Reader) -> Self {
        let mut classes = Classes::default();
        let defaults = |node: Element<'a, 'i>| node.elements().filter(|node| node.is("default")).map(Element::read);
        let outermost: Vec<&str> = defaults(root).filter_map(|node| node.text("class")).collect();
        // In the order of the file.
        let within = |node: Element<'a, 'i>, name: &'a str| defaults(node).rev().map(move |inner| (inner, name));
        let mut open: Vec<(Element<'a, 'i>, &'a str)> = Vec::new();
        // The outermost class may have any name, and applies to elements without a class.
        for node in defaults(root) {
            classes.by_name.entry(MAIN).or_default().nodes.push(node);
            open.extend(within(node, MAIN));
            while let Some((node, parent)) = open.pop() {
                let Some(name) = node.attribute("class") else {
                    reader.mistakes.push(rule::missing(node.tag(), "a <default> within another one", "`class=\"…\"`"));
                    continue;
                };
                let (name, span) = (name.value(), value_span(name));
                if outermost.contains(&name) || classes.by_name.contains_key(name) {
                    reader.mistakes.push(rule::duplicate(span, "<default>", name));
                    continue;
                }
                classes.by_name.insert(name, Class { nodes: vec![node], parent: Some(parent) });
                open.extend(within(node, name));
            }
        }
        let named = root.descendants().filter(|node| !node.is("default"));
        for attribute in named.flat_map(|node| ["class", "childclass"].map(|key| node.attribute(key))).flatten() {
            let name = attribute.value();
            if name != MAIN && !classes.by_name.contains_key(name) && !outermost.contains(&name) {
                let help = suggest(name, classes.by_name.keys().copied());
                reader.mistakes.push(rule::unknown_class(value_span(attribute), name, help));
            }
        }
        classes
    }

    /// An attribute of an element, its own or that of its class. `inherited`: class of elements within the body that name none.
    pub(super) fn find(&self, node: Element<'a, 'i>, inherited: Option<&str>, key: &str) -> Option<Attribute<'a, 'i>> {
        self.asked.borrow_mut().entry(given_by(node)).or_default().insert(key.to_owned());
        // All of them are read: that of a class is not left out because an element has its own.
        self.of_class(node, inherited)
            .filter_map(|node| node.attribute(key))
            .fold(None, |first, next| first.or(Some(next)))
    }

    /// The text of an attribute, its own or that of its class.
    pub(super) fn text(&self, node: Element<'a, 'i>, inherited: Option<&str>, key: &str) -> Option<&'a str> {
        self.find(node, inherited, key).map(|attribute| attribute.value())
    }

    /// The first of an element and of the defaults for it, innermost first, that has one of these attributes.
    pub(super) fn with_any(
        &self,
        node: Element<'a, 'i>,
        inherited: Option<&str>,
        keys: &[&str],
    ) -> Option<Element<'a, 'i>> {
        for key in keys {
            self.find(node, inherited, key);
        }
        self.of_class(node, inherited).find(|node| keys.iter().any(|key| node.has(key)))
    }

    /// Notes what of the defaults is left out: those of elements that are, and of the others what no element was asked for. An attribute
    /// that some element was asked for is understood, also in a class that nothing uses.
    pub(super) fn note_defaults(&self) {
        let asked = self.asked.borrow();
        for element in self.by_name.values().flat_map(|class| &class.nodes).flat_map(|node| node.elements()) {
            match asked.get(element.name()) {
                _ if element.is("default") => {}
                Some(keys) => {
                    let _ = element.read();
                    for key in element.keys().filter(|key| keys.contains(*key) || *key == "class") {
                        element.attribute(key);
                    }
                    element.leave_out_rest("defaults of what is left out");
                }
                None => element.leave_out("defaults of what is left out"),
            }
        }
    }

    /// An element, then the defaults for it, innermost first.
    fn of_class(&self, node: Element<'a, 'i>, inherited: Option<&str>) -> impl Iterator<Item = Element<'a, 'i>> {
        let named = node.text("class").or(inherited).unwrap_or(MAIN);
        // A name that is not found is the outermost class's own name.
        let first = self.by_name.get_key_value(named).or_else(|| self.by_name.get_key_value(MAIN));
        let classes = std::iter::successors(first, |(_, class)| self.by_name.get_key_value(class.parent?));
        let element = given_by(node);
        let defaults = classes.flat_map(move |(_, class)| {
            let nodes = class.nodes.iter().flat_map(|node| node.elements());
            nodes.filter(move |node| node.is(element))
        });
        std::iter::once(node).chain(defaults)
    }
}

/// The name of the element in `<default>` that gives the defaults of an element: all equalities have one, and all tendons.
fn given_by<'a>(node: Element<'a, '_>) -> &'a str {
    match node.parent() {
        Some(section) if section.is("equality") || section.is("tendon") => section.local_name(),
        _ => node.local_name(),
    }
}
