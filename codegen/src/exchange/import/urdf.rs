//! A robot in URDF.

use roxmltree::Node;

use super::document::{Reader, child, name_of, tag};
use super::mistakes::rule;
use super::robot::{Follows, Joint, Link, Motion, Named, Robot};
use crate::chain::{Axis, Frame, Value, Vector};
use crate::diagnostic::Mistake;
use crate::exchange::mass::Lump;
use crate::exchange::rotation::length;

/// Reads a file by its root; returns what could be read, and all mistakes.
pub(super) fn read_robot(root: Node) -> Result<Robot, Vec<Mistake>> {
    let mut reader = Reader::default();
    let mut robot = Robot {
        name: root.attribute("name").unwrap_or("robot").to_owned(),
        links: Vec::new(),
        joints: Vec::new(),
        gravity: None,
        left_out: Vec::new(),
        no_drives: "URDF has no drives: every joint swings freely.",
    };
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
        // A fixed joint has no axis, even if one is written.
        let axis = if matches!(motion, Motion::Fixed) { None } else { child(node, "axis") };
        let axis = axis.map_or([1.0, 0.0, 0.0], |given| self.direction(given, &name));
        let (damping, friction) = (damping.unwrap_or(0.0), friction.unwrap_or(0.0));
        let joint = Joint::new(&name, span, motion, [parent?, end?]);
        Some(Joint { placement, axis, limits, damping, friction, follows, ..joint })
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
}
