//! Attributes with the defaults of their classes.

use std::collections::BTreeMap;

use roxmltree::{Attribute, Node};

use crate::diagnostic::suggest;
use crate::exchange::import::document::{Reader, tag, value_span};
use crate::exchange::import::mistakes::rule;

/// The class of elements that name none.
const MAIN: &str = "main";

/// Classes of defaults by name. A class within another one is defined once, after that one, so that no class inherits from itself.
#[derive(Default)]
pub(super) struct Classes<'a, 'i>(BTreeMap<&'a str, Class<'a, 'i>>);

/// A class: its elements, and the class whose defaults it inherits.
#[derive(Default)]
struct Class<'a, 'i> {
    nodes: Vec<Node<'a, 'i>>,
    parent: Option<&'a str>,
}

impl<'a, 'i> Classes<'a, 'i> {
    /// Reads all `<default>` sections; reports classes within others that have no name or that of another one, and names of classes that
    /// are not defined.
    pub(super) fn read(root: Node<'a, 'i>, reader: &mut Reader) -> Self {
        let mut classes = Classes::default();
        let defaults = |node: Node<'a, 'i>| node.children().filter(|node| node.has_tag_name("default"));
        let outermost: Vec<&str> = defaults(root).filter_map(|node| node.attribute("class")).collect();
        // In the order of the file.
        let within = |node: Node<'a, 'i>, name: &'a str| defaults(node).rev().map(move |inner| (inner, name));
        let mut open: Vec<(Node<'a, 'i>, &'a str)> = Vec::new();
        // The outermost class may have any name, and applies to elements without a class.
        for node in defaults(root) {
            classes.0.entry(MAIN).or_default().nodes.push(node);
            open.extend(within(node, MAIN));
            while let Some((node, parent)) = open.pop() {
                let Some(name) = node.attribute_node("class") else {
                    reader.mistakes.push(rule::missing(tag(node), "a <default> within another one", "`class=\"…\"`"));
                    continue;
                };
                let (name, span) = (name.value(), value_span(name));
                if outermost.contains(&name) || classes.0.contains_key(name) {
                    reader.mistakes.push(rule::duplicate(span, "<default>", name));
                    continue;
                }
                classes.0.insert(name, Class { nodes: vec![node], parent: Some(parent) });
                open.extend(within(node, name));
            }
        }
        for attribute in
            root.descendants().filter(|node| !node.has_tag_name("default")).flat_map(|node| node.attributes())
        {
            let names_a_class = ["class", "childclass"].contains(&attribute.name());
            let name = attribute.value();
            if names_a_class && name != MAIN && !classes.0.contains_key(name) && !outermost.contains(&name) {
                let help = suggest(name, classes.0.keys().copied());
                reader.mistakes.push(rule::unknown_class(value_span(attribute), name, help));
            }
        }
        classes
    }

    /// An attribute of an element, its own or that of its class. `inherited`: class of elements within the body that name none.
    pub(super) fn find(&self, node: Node<'a, 'i>, inherited: Option<&str>, key: &str) -> Option<Attribute<'a, 'i>> {
        self.of_class(node, inherited).find_map(|node| node.attribute_node(key))
    }

    /// The text of an attribute, its own or that of its class.
    pub(super) fn text(&self, node: Node<'a, 'i>, inherited: Option<&str>, key: &str) -> Option<&'a str> {
        self.find(node, inherited, key).map(|attribute| attribute.value())
    }

    /// The first of an element and of the defaults for it, innermost first, that has one of these attributes.
    pub(super) fn with_any(&self, node: Node<'a, 'i>, inherited: Option<&str>, keys: &[&str]) -> Option<Node<'a, 'i>> {
        self.of_class(node, inherited).find(|node| keys.iter().any(|key| node.has_attribute(*key)))
    }

    /// An element, then the defaults for it, innermost first.
    fn of_class(&self, node: Node<'a, 'i>, inherited: Option<&str>) -> impl Iterator<Item = Node<'a, 'i>> {
        let named = node.attribute("class").or(inherited).unwrap_or(MAIN);
        // A name that is not found is the outermost class's own name.
        let first = self.0.get_key_value(named).or_else(|| self.0.get_key_value(MAIN));
        let classes = std::iter::successors(first, |(_, class)| self.0.get_key_value(class.parent?));
        let element = node.tag_name().name();
        let defaults = classes.flat_map(move |(_, class)| {
            let nodes = class.nodes.iter().flat_map(Node::children);
            nodes.filter(move |node| node.has_tag_name(element))
        });
        std::iter::once(node).chain(defaults)
    }
}
