//! A robot in URDF.

use std::collections::BTreeMap;

use super::document::{Element, Reader, finite_numbers};
use super::mistakes::rule;
use super::robot::{Follows, Joint, Link, Motion, Named, Robot, SingleAxis, is_visible};
use crate::chain::{Axis, Form, Frame, Value, Vector};
use crate::diagnostic::Mistake;
use crate::exchange::mass::Lump;
use crate::exchange::rotation::length;

/// What links have besides masses.
const SHAPES: &str = "shapes and colours";
/// Elements for certain programs.
const OF_OTHERS: &str = "extensions of other programs";
/// What joints have besides masses and forces.
const OF_DRIVES: &str = "limits and control of drives";

/// Reads a file by its root; returns what could be read, and all mistakes.
pub(super) fn read_robot(root: Element) -> Result<Robot, Vec<Mistake>> {
    let mut reader = Reader::default();
    let mut rotors: BTreeMap<String, f64> = BTreeMap::new();
    let mut robot = Robot {
        name: root.text("name").unwrap_or("robot").to_owned(),
        links: Vec::new(),
        joints: Vec::new(),
        couplings: Vec::new(),
        gravity: None,
        left_out: Vec::new(),
        no_drives: "URDF has no drives: every joint swings freely.",
    };
    for node in root.elements() {
        match (node.namespace(), node.local_name()) {
            (None, "link") => robot.links.extend(reader.link(node.read())),
            (None, "joint") => robot.joints.extend(reader.joint(node.read())),
            (None, "material") => node.leave_out(SHAPES),
            (None, "transmission") => {
                if let Some((joint, inertia)) = reader.rotor(node.read()) {
                    *rotors.entry(joint).or_insert(0.0) += inertia;
                }
            }
            (Some(address), _) if address.contains("xacro") => {
                reader.mistakes.push(rule::not_a_robot(node.tag(), node.name()));
            }
            (Some(_), _) | (None, "gazebo") => node.leave_out(OF_OTHERS),
            _ => {}
        }
    }
    for joint in &mut robot.joints {
        joint.armature = rotors.remove(&joint.name).unwrap_or(0.0);
    }
    let lost = rotors.keys().map(|joint| format!("The rotor of joint `{joint}` is left out: there is no such joint."));
    robot.left_out.extend(lost);
    if reader.mistakes.is_empty() { Ok(robot) } else { Err(reader.mistakes) }
}

impl Reader {
    fn link(&mut self, node: Element) -> Option<Link> {
        let name = self.required(node, "name", "a link")?;
        node.elements().filter(|inner| inner.is("collision")).for_each(|shape| shape.leave_out(SHAPES));
        let visuals = node.elements().filter(|inner| inner.is("visual"));
        let shapes = visuals.filter_map(|visual| self.shape(visual, &name.name)).collect();
        let lump = node.child("inertial").and_then(|inertial| self.lump(inertial, &name.name));
        Some(Link { name: name.name, span: name.span, lump, shapes, frame: Some(Frame::WORLD) })
    }

    /// The solid that a `<visual>` shows, and its pose in the frame of the link. Others, and those without a size, are left out.
    fn shape(&mut self, node: Element, link: &str) -> Option<(Frame, Form)> {
        let geometry = node.elements().find(|inner| inner.is("geometry"));
        let solid = geometry.and_then(|geometry| geometry.elements().next());
        let form = solid.and_then(|solid| {
            let number = |key: &str| solid.text(key)?.trim().parse().ok();
            let diameter = || Some(2.0 * number("radius")?);
            let form = match solid.local_name() {
                "box" => Form::Box(finite_numbers(solid.text("size")?)?.try_into().ok()?),
                "cylinder" => Form::Cylinder { diameter: diameter()?, length: number("length")? },
                "capsule" => Form::Capsule { diameter: diameter()?, length: number("length")? },
                "sphere" => Form::Capsule { diameter: diameter()?, length: 0.0 },
                _ => return None,
            };
            is_visible(&form).then_some(form)
        });
        let (Some(form), Some(geometry), Some(solid)) = (form, geometry, solid) else {
            node.leave_out(SHAPES);
            return None;
        };
        let _ = (node.read(), geometry.read(), solid.read());
        let frame = self.placement(node, &format!("a shape of link `{link}`"));
        node.elements().for_each(|inner| inner.leave_out(SHAPES));
        Some((frame, form))
    }

    fn lump(&mut self, node: Element, link: &str) -> Option<Lump> {
        let owner = format!("the mass of link `{link}`");
        let placement = self.placement(node, &owner);
        let Some(mass) = node.child("mass") else {
            self.mistakes.push(rule::missing(node.tag(), format!("link `{link}`"), "<mass value=\"…\"/>"));
            return None;
        };
        let [mass_value] = self.numbers(mass, "value", &owner)?;
        if mass_value < 0.0 {
            self.mistakes.push(rule::negative_mass(mass.tag(), link, mass_value));
        }
        let mut moment = |key| match node.child("inertia") {
            Some(inertia) if inertia.has(key) => {
                self.numbers(inertia, key, &format!("`{key}` of link `{link}`")).map_or(f64::NAN, |[moment]| moment)
            }
            _ => 0.0,
        };
        let tensor = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"].map(&mut moment);
        Some(Lump { mass: mass_value, com: [0.0; 3], tensor }.seen_through(&placement))
            .filter(|lump| !lump.is_nothing())
    }

    fn joint(&mut self, node: Element) -> Option<Joint> {
        let Named { name, span } = self.required(node, "name", "a joint")?;
        let owner = format!("joint `{name}`");
        let kind = self.required(node, "type", &owner);
        let parent = self.end(node, "parent", &owner);
        let end = self.end(node, "child", &owner);
        let placement = self.placement(node, &owner);
        // What is left out first stays so when it is read.
        let is_fixed = kind.as_ref().is_some_and(|kind| kind.name == "fixed");
        let of_moving = |inner: &Element| is_fixed && ["dynamics", "limit", "mimic"].contains(&inner.local_name());
        node.elements().filter(of_moving).for_each(|inner| inner.leave_out("what acts on fixed joints"));
        let mut number = |element, key| {
            let given = node.child(element).filter(|given| given.has(key))?;
            self.numbers(given, key, &format!("`{key}` of {owner}")).map(|[number]| number)
        };
        let limits = ["lower", "upper"].map(|key| {
            // A joint without a limit may say so.
            let given = node.child("limit").and_then(|limit| limit.text(key));
            let infinite = given.and_then(|text| text.trim().parse().ok()).filter(|limit: &f64| limit.is_infinite());
            infinite.or_else(|| number("limit", key))
        });
        // The default of one of them is zero.
        let limits = limits.iter().any(Option::is_some).then(|| limits.map(|limit| limit.unwrap_or(0.0)));
        let (damping, friction) = (number("dynamics", "damping"), number("dynamics", "friction"));
        let [multiplier, offset] =
            [number("mimic", "multiplier").unwrap_or(1.0), number("mimic", "offset").unwrap_or(0.0)];
        let leader = node.child("mimic").and_then(|mimic| self.required(mimic, "joint", "<mimic>"));
        let follows = leader.map(|leader| Follows { leader, multiplier, offset });
        let kind = kind?;
        // A fixed or floating joint has no axis, even if one is written.
        let has_axis = !["fixed", "floating"].contains(&kind.name.as_str());
        let axis = if has_axis { node.child("axis") } else { None };
        let axis = axis.map_or([1.0, 0.0, 0.0], |given| self.direction(given, &name));
        let motion = match kind.name.as_str() {
            "fixed" => Motion::Fixed,
            "revolute" | "continuous" => Motion::Revolute,
            "prismatic" => Motion::Prismatic,
            "floating" => Motion::Several { kind: "floating", axes: SingleAxis::free(), starts: vec![0.0; 6] },
            "planar" => Motion::Several { kind: "planar", axes: SingleAxis::planar(axis), starts: vec![0.0; 3] },
            _ => Motion::Other(kind),
        };
        if let Some(limit) = node.child("limit") {
            limit.leave_out_rest(OF_DRIVES);
        }
        for inner in node.elements() {
            match inner.local_name() {
                "safety_controller" | "calibration" => inner.leave_out(OF_DRIVES),
                "axis" if !has_axis => inner.leave_out("axes of fixed and floating joints"),
                _ if inner.namespace().is_some() => inner.leave_out(OF_OTHERS),
                _ => {}
            }
        }
        let (damping, friction) = (damping.unwrap_or(0.0), friction.unwrap_or(0.0));
        let joint = Joint::new(&name, span, motion, [parent?, end?]);
        Some(Joint { placement, axis, limits, damping, friction, follows, ..joint })
    }

    /// The joint of a transmission, and the inertia of its rotor about the joint: `J i²` with the reduction i, kg m² or kg. A rotor turns
    /// about its joint's axis only in this approximation, as in Drake and `MuJoCo`.
    fn rotor(&mut self, node: Element) -> Option<(String, f64)> {
        let [joint] = node.elements().filter(|inner| inner.is("joint")).collect::<Vec<_>>()[..] else {
            node.elements().for_each(|inner| inner.leave_out("transmissions to several joints"));
            return None;
        };
        let joint_name = self.required(joint.read(), "name", "a transmission")?;
        let owner = format!("the transmission of joint `{}`", joint_name.name);
        // Of a transmission without a rotor, the reduction means nothing here.
        let has_rotor = node.descendants().any(|inner| inner.local_name() == "rotor_inertia");
        let (mut inertia, mut reduction) = (None, None);
        for part in node.elements().filter(|inner| inner.is("joint") || inner.is("actuator")).map(Element::read) {
            for element in part.elements() {
                let number = match element.local_name() {
                    "rotor_inertia" => &mut inertia,
                    "gear_ratio" | "mechanicalReduction" if has_rotor => &mut reduction,
                    _ => {
                        element.leave_out(OF_DRIVES);
                        continue;
                    }
                };
                *number = self.content_or_value(element.read(), &owner);
            }
        }
        node.elements()
            .filter(|inner| !inner.is("joint") && !inner.is("actuator"))
            .for_each(|rest| rest.leave_out(OF_DRIVES));
        Some((joint_name.name, inertia? * reduction.unwrap_or(1.0).powi(2)))
    }

    /// The number between the tags of an element, or that of its `value`.
    fn content_or_value(&mut self, node: Element, owner: &str) -> Option<f64> {
        if node.has("value") {
            return self.numbers(node, "value", &format!("<{}> of {owner}", node.name())).map(|[number]| number);
        }
        let number = node.content().parse().ok().filter(|number: &f64| number.is_finite());
        if number.is_none() {
            let subject = format!("<{}> of {owner}", node.name());
            self.mistakes.push(rule::wrong_numbers(node.tag(), subject, node.content(), "a finite number"));
        }
        number
    }

    /// The unit vector of an axis.
    fn direction(&mut self, node: Element, joint: &str) -> Vector {
        let axis = self.numbers(node, "xyz", &format!("the axis of joint `{joint}`")).unwrap_or([1.0, 0.0, 0.0]);
        let size = length(axis);
        if size == 0.0 {
            self.mistakes.push(rule::no_direction(node.tag(), joint));
        }
        axis.map(|component| component / size)
    }

    /// The link at one end of a joint.
    fn end(&mut self, node: Element, element: &str, owner: &str) -> Option<Named> {
        let Some(end) = node.child(element) else {
            self.mistakes.push(rule::missing(node.tag(), owner, format!("<{element} link=\"…\"/>")));
            return None;
        };
        self.required(end, "link", &format!("<{element}> of {owner}"))
    }

    /// `<origin xyz="…" rpy="…"/>`: translation, then `Rz(yaw) Ry(pitch) Rx(roll)`.
    fn placement(&mut self, node: Element, owner: &str) -> Frame {
        let Some(origin) = node.child("origin") else { return Frame::WORLD };
        let mut vector = |key: &str| {
            let given = origin.has(key).then(|| self.numbers(origin, key, &format!("`{key}` of {owner}")));
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
