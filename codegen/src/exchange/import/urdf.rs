//! A URDF file as written: links and joints with their locations.

use roxmltree::{Attribute, Document, Node, ParsingOptions};

use super::mistakes::rule;
use crate::chain::{Axis, Frame, Value, Vector};
use crate::diagnostic::{Mistake, SourceFile, Span};
use crate::exchange::mass::Lump;
use crate::exchange::rotation::length;

/// A robot.
pub(super) struct Robot {
    pub(super) name: String,
    pub(super) links: Vec<Link>,
    pub(super) joints: Vec<Joint>,
}

/// A link and its mass, in the link's frame; `None`, or zero, if it carries nothing.
pub(super) struct Link {
    pub(super) name: String,
    pub(super) span: Span,
    pub(super) lump: Option<Lump>,
}

/// A joint between two links.
pub(super) struct Joint {
    pub(super) name: String,
    pub(super) span: Span,
    pub(super) motion: Motion,
    pub(super) parent: Named,
    pub(super) child: Named,
    /// Pose of the child on the parent at zero.
    pub(super) placement: Frame,
    /// Unit vector in the frame of the child.
    pub(super) axis: Vector,
    pub(super) limits: Option<[f64; 2]>,
    /// N m s/rad or N s/m.
    pub(super) damping: f64,
    /// Coulomb friction, N m or N.
    pub(super) friction: f64,
    /// The joint that it follows.
    pub(super) follows: Option<Follows>,
}

/// A joint at `multiplier · leader + offset`.
pub(super) struct Follows {
    pub(super) leader: Named,
    pub(super) multiplier: f64,
    /// m or rad.
    pub(super) offset: f64,
}

/// How a joint moves.
pub(super) enum Motion {
    Fixed,
    Revolute,
    Prismatic,
    /// In a way that cranes do not support.
    Other(Named),
}

/// A name or a word, and its location.
pub(super) struct Named {
    pub(super) name: String,
    pub(super) span: Span,
}

/// Reads a file; returns what could be read, and all mistakes.
pub(super) fn read(source: &SourceFile) -> Result<Robot, Vec<Mistake>> {
    // Attributes of one element are compared with each other, so an excessive number is refused.
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&source.text, options).map_err(|error| {
        let at = byte(&source.text, error.pos().row, error.pos().col);
        vec![rule::not_xml(Span { start: at, end: at }, error)]
    })?;
    let root = document.root_element();
    if root.tag_name().name() != "robot" {
        return Err(vec![rule::not_a_robot(tag(root), name_of(root))]);
    }
    let mut reader = Reader { mistakes: Vec::new() };
    let name = root.attribute("name").unwrap_or("robot").to_owned();
    let mut robot = Robot { name, links: Vec::new(), joints: Vec::new() };
    for node in root.children().filter(Node::is_element) {
        match (node.tag_name().namespace(), node.tag_name().name()) {
            (None, "link") => robot.links.extend(reader.link(node)),
            (None, "joint") => robot.joints.extend(reader.joint(node)),
            (Some(_), _) => reader.mistakes.push(rule::not_a_robot(tag(node), name_of(node))),
            // Materials, transmissions, extensions for simulators.
            _ => {}
        }
    }
    if reader.mistakes.is_empty() { Ok(robot) } else { Err(reader.mistakes) }
}

/// No robot has more elements and attributes.
const MOST_NODES: u32 = 200_000;

struct Reader {
    mistakes: Vec<Mistake>,
}

impl Reader {
    fn link(&mut self, node: Node) -> Option<Link> {
        let name = self.required(node, "name", "a link")?;
        let lump = child(node, "inertial").and_then(|inertial| self.lump(inertial, &name.name));
        Some(Link { name: name.name, span: name.span, lump })
    }

    fn lump(&mut self, node: Node, link: &str) -> Option<Lump> {
        let owner = format!("the mass of link `{link}`");
        let placement = self.placement(node, &owner);
        let Some(mass) = child(node, "mass") else {
            self.mistakes.push(rule::missing(tag(node), format!("link `{link}`"), "<mass value=\"…\"/>"));
            return None;
        };
        let [mass_value] = self.numbers(mass, "value", &owner)?;
        if mass_value < 0.0 {
            self.mistakes.push(rule::negative_mass(tag(mass), link, mass_value));
        }
        let mut moment = |key| match child(node, "inertia") {
            Some(inertia) if inertia.has_attribute(key) => {
                self.numbers(inertia, key, &format!("`{key}` of link `{link}`")).map_or(f64::NAN, |[moment]| moment)
            }
            _ => 0.0,
        };
        let tensor = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"].map(&mut moment);
        (mass_value > 0.0).then(|| Lump { mass: mass_value, com: [0.0; 3], tensor }.seen_through(&placement))
    }

    fn joint(&mut self, node: Node) -> Option<Joint> {
        let Named { name, span } = self.required(node, "name", "a joint")?;
        let owner = format!("joint `{name}`");
        let kind = self.required(node, "type", &owner);
        let parent = self.end(node, "parent", &owner);
        let end = self.end(node, "child", &owner);
        let placement = self.placement(node, &owner);
        let mut number = |element, key| {
            let given = child(node, element).filter(|given| given.has_attribute(key))?;
            self.numbers(given, key, &format!("`{key}` of {owner}")).map(|[number]| number)
        };
        let limits = number("limit", "lower").zip(number("limit", "upper")).map(|(lower, upper)| [lower, upper]);
        let (damping, friction) = (number("dynamics", "damping"), number("dynamics", "friction"));
        let [multiplier, offset] =
            [number("mimic", "multiplier").unwrap_or(1.0), number("mimic", "offset").unwrap_or(0.0)];
        let leader = child(node, "mimic").and_then(|mimic| self.required(mimic, "joint", "<mimic>"));
        let follows = leader.map(|leader| Follows { leader, multiplier, offset });
        let kind = kind?;
        let motion = match kind.name.as_str() {
            "fixed" => Motion::Fixed,
            "revolute" | "continuous" => Motion::Revolute,
            "prismatic" => Motion::Prismatic,
            _ => Motion::Other(kind),
        };
        // A fixed joint has no axis, whatever is written.
        let axis = if matches!(motion, Motion::Fixed) { None } else { child(node, "axis") };
        let axis = axis.map_or([1.0, 0.0, 0.0], |given| self.direction(given, &name));
        let (damping, friction) = (damping.unwrap_or(0.0), friction.unwrap_or(0.0));
        Some(Joint {
            name,
            span,
            motion,
            parent: parent?,
            child: end?,
            placement,
            axis,
            limits,
            damping,
            friction,
            follows,
        })
    }

    /// The unit vector of an axis.
    fn direction(&mut self, node: Node, joint: &str) -> Vector {
        let axis = self.numbers(node, "xyz", &format!("the axis of joint `{joint}`")).unwrap_or([1.0, 0.0, 0.0]);
        let size = length(axis);
        if size == 0.0 {
            self.mistakes.push(rule::no_direction(tag(node), joint));
        }
        axis.map(|component| component / size)
    }

    /// The link at one end of a joint.
    fn end(&mut self, node: Node, element: &str, owner: &str) -> Option<Named> {
        let Some(end) = child(node, element) else {
            self.mistakes.push(rule::missing(tag(node), owner, format!("<{element} link=\"…\"/>")));
            return None;
        };
        self.required(end, "link", &format!("<{element}> of {owner}"))
    }

    /// `<origin xyz="…" rpy="…"/>`: translation, then `Rz(yaw) Ry(pitch) Rx(roll)`.
    fn placement(&mut self, node: Node, owner: &str) -> Frame {
        let Some(origin) = child(node, "origin") else { return Frame::WORLD };
        let mut vector = |key: &str| {
            let given = origin.has_attribute(key).then(|| self.numbers(origin, key, &format!("`{key}` of {owner}")));
            given.flatten().unwrap_or([0.0; 3])
        };
        let (at, [roll, pitch, yaw]) = (vector("xyz"), vector("rpy"));
        let turns = [(Axis::Z, yaw), (Axis::Y, pitch), (Axis::X, roll)];
        turns.iter().fold(Frame { origin: at, ..Frame::WORLD }, |frame, (axis, angle)| {
            // Quarter turns as the spec language reads them: exact.
            let (sin, cos) = Value::Constant(*angle).sin_cos();
            frame.rotated(*axis, sin.at(&[]), cos.at(&[]))
        })
    }

    /// A required attribute.
    fn required(&mut self, node: Node, key: &str, owner: &str) -> Option<Named> {
        let Some(attribute) = node.attribute_node(key) else {
            self.mistakes.push(rule::missing(tag(node), owner, format!("`{key}=\"…\"`")));
            return None;
        };
        Some(Named { name: attribute.value().to_owned(), span: value_span(attribute) })
    }

    /// A given number of finite numbers of an attribute, or a mistake.
    fn numbers<const N: usize>(&mut self, node: Node, key: &str, place: &str) -> Option<[f64; N]> {
        let given = self.required(node, key, place)?;
        let numbers: Option<Vec<f64>> =
            given.name.split_whitespace().map(|word| word.parse().ok().filter(|n: &f64| n.is_finite())).collect();
        let found = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        if found.is_none() {
            let expected =
                if N == 1 { "a finite number".to_owned() } else { format!("{N} finite numbers separated by blanks") };
            self.mistakes.push(rule::wrong_numbers(given.span, place, &given.name, expected));
        }
        found
    }
}

fn child<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(name))
}

/// `<name`, the start of an element.
fn tag(node: Node) -> Span {
    let start = node.range().start;
    Span { start, end: start + 1 + name_of(node).len() }
}

/// The name of an element as written, including its prefix.
fn name_of<'a>(node: Node<'a, '_>) -> &'a str {
    let text = &node.document().input_text()[node.range()];
    let name = text.trim_start_matches('<');
    name.split(|c: char| c.is_whitespace() || c == '>' || c == '/').next().unwrap_or_default()
}

fn value_span(attribute: Attribute) -> Span {
    let range = attribute.range_value();
    Span { start: range.start, end: range.end }
}

/// The byte at a line and a column, both from 1.
fn byte(text: &str, row: u32, column: u32) -> usize {
    let start: usize = text.split_inclusive('\n').take(row.saturating_sub(1) as usize).map(str::len).sum();
    let line = text[start..].split('\n').next().unwrap_or_default();
    start + line.char_indices().nth(column.saturating_sub(1) as usize).map_or(line.len(), |(at, _)| at)
}
