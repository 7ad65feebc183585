//! Everything except bodies: gravity, equalities, key frames, and elements that a spec cannot express.

use std::collections::BTreeMap;

use super::File;
use crate::chain::Vector;
use crate::exchange::import::document::Element;
use crate::exchange::import::mistakes::rule;
use crate::exchange::import::robot::{Follows, Joint, Motion};

/// Default acceleration of gravity, m/s².
const GRAVITY: Vector = [0.0, 0.0, -9.81];
/// Sections that a spec cannot express, and what they belong to.
const LEFT_OUT: [(&str, &str); 11] = [
    ("actuator", "actuators"),
    ("tendon", "tendons"),
    ("contact", "contacts"),
    ("extension", "plugins"),
    ("sensor", "sensors"),
    ("asset", super::geoms::SHAPES),
    ("visual", super::geoms::SHAPES),
    ("statistic", super::geoms::SHAPES),
    ("size", "memory"),
    ("custom", "numbers and texts of users"),
    ("deformable", "deformable bodies"),
];

/// What `<flag>` of `<option>` switches that a spec has. `passive` is springs and dampers, `constraint` equalities and friction.
const FLAGS: [&str; 7] = ["gravity", "passive", "spring", "damper", "constraint", "equality", "frictionloss"];

impl<'a, 'i> File<'a, 'i> {
    /// All sections except defaults and the world.
    pub(super) fn others(&mut self, root: Element<'a, 'i>) {
        let flags = self.options(root);
        let disabled = |keys: [&str; 2]| keys.iter().any(|key| flags.get(key) == Some(&true));
        self.contacts(root);
        for node in root.named("equality").flat_map(Element::elements) {
            if disabled(["equality", "constraint"]) {
                node.leave_out("equalities that a flag disables");
            } else {
                self.equality(node);
            }
        }
        for joint in &mut self.robot.joints {
            if disabled(["spring", "passive"]) {
                joint.spring = None;
            }
            if disabled(["damper", "passive"]) {
                joint.damping = 0.0;
            }
            if disabled(["frictionloss", "constraint"]) {
                joint.friction = 0.0;
            }
        }
        let mut keys = root.named("keyframe").flat_map(Element::elements);
        let first = keys.by_ref().find(|node| node.has("qpos"));
        if let Some(key) = first {
            self.start(key.read());
            key.leave_out_rest("times, speeds and commands of key frames");
        }
        root.named("keyframe")
            .flat_map(Element::elements)
            .filter(|key| Some(key.tag()) != first.map(Element::tag))
            .for_each(|key| {
                key.leave_out("key frames except the first with `qpos`");
            });
        for (section, what) in LEFT_OUT {
            root.named(section).for_each(|node| {
                node.elements().for_each(|element| element.leave_out(what));
                node.leave_out_rest(what);
            });
        }
    }

    /// Notes that shapes do not touch, if some can.
    fn contacts(&mut self, root: Element<'a, 'i>) {
        let touches = |node: Element<'a, 'i>| {
            ["contype", "conaffinity"].iter().any(|key| self.classes.text(node, None, key) != Some("0"))
        };
        let mut geoms = root.named("worldbody").flat_map(Element::descendants).filter(|node| node.is("geom"));
        if geoms.any(touches) {
            self.robot.left_out.push("Contacts of geoms are left out.".to_owned());
        }
    }

    /// `<option>`: of several, each attribute counts where it stands last. Returns which flags disable something.
    fn options(&mut self, root: Element<'a, 'i>) -> BTreeMap<&'static str, bool> {
        let mut flags = BTreeMap::new();
        for option in root.named("option") {
            if option.has("gravity") {
                self.robot.gravity = self.numbers(option, None, "gravity", "<option>");
            }
            for key in ["density", "viscosity"] {
                if option.text(key).is_some_and(|given| given.parse() != Ok(0.0)) {
                    self.robot.left_out.push("Forces of the surrounding medium are left out.".to_owned());
                }
            }
            for flag in option.named("flag") {
                for key in FLAGS {
                    if let Some(given) = flag.text(key) {
                        flags.insert(key, given == "disable");
                    }
                }
                flag.leave_out_rest("switches of what a spec does not have");
            }
            option.leave_out_rest("settings of the solver");
        }
        self.robot.gravity = self.robot.gravity.filter(|gravity| *gravity != GRAVITY);
        if flags.get("gravity") == Some(&true) {
            self.robot.gravity = Some([0.0; 3]);
        }
        flags
    }

    /// Reads an equality that holds a joint or lets it follow another one; no other kind is supported.
    fn equality(&mut self, node: Element<'a, 'i>) {
        if self.classes.text(node, None, "active") == Some("false") {
            return node.leave_out("equalities that are not active");
        }
        let _ = node.read();
        if node.name() != "joint" {
            return self.reader.mistakes.push(rule::closed_loop(node.tag(), format!("<{}>", node.name())));
        }
        let Some(follower) = self.reader.required(node, "joint1", "<joint> of <equality>") else { return };
        let power = |exponent: usize| if exponent == 1 { 1.0 } else { 0.0 };
        let given = self.classes.find(node, None, "polycoef");
        let given = given.and_then(|given| self.reader.some_numbers(given, "`polycoef`")).unwrap_or_default();
        let [zeroth, first, higher @ ..] =
            [0, 1, 2, 3, 4].map(|exponent| given.get(exponent).copied().unwrap_or_else(|| power(exponent)));
        let leader = if node.has("joint2") { self.reader.required(node, "joint2", "") } else { None };
        if leader.is_some() && higher != [0.0; 3] {
            return self.reader.mistakes.push(rule::not_linear(node.tag(), &follower.name));
        }
        let reference =
            |robot: &[Joint], name: &str| robot.iter().find(|joint| joint.name == name).map(|joint| joint.reference);
        let Some(of_follower) = reference(&self.robot.joints, &follower.name) else {
            return self.reader.mistakes.push(rule::equality(follower.span, &follower.name));
        };
        let of_leader = leader.as_ref().map(|leader| reference(&self.robot.joints, &leader.name).unwrap_or(0.0));
        node.leave_out_rest("softness of equalities");
        let index = |robot: &[Joint], name: &str| robot.iter().position(|joint| joint.name == name);
        let Some(at) = index(&self.robot.joints, &follower.name) else { return };
        let taken = |joint: &Joint| joint.follows.is_some() || joint.held.is_some();
        match (leader, of_leader) {
            (Some(leader), Some(of_leader)) => {
                // q₁ − ref₁ = c₀ + c₁ (q₂ − ref₂).
                let offset = of_follower + zeroth - first * of_leader;
                let other = index(&self.robot.joints, &leader.name).filter(|other| *other != at);
                match other.filter(|other| taken(&self.robot.joints[at]) && !taken(&self.robot.joints[*other])) {
                    // The same equation for the other joint.
                    Some(other) if first != 0.0 => {
                        let follows = Follows { leader: follower, multiplier: 1.0 / first, offset: -offset / first };
                        self.robot.joints[other].follows = Some(follows);
                    }
                    _ if taken(&self.robot.joints[at]) => {
                        self.reader.mistakes.push(rule::second_equality(follower.span, &follower.name));
                    }
                    _ => self.robot.joints[at].follows = Some(Follows { leader, multiplier: first, offset }),
                }
            }
            _ if taken(&self.robot.joints[at]) => {
                self.reader.mistakes.push(rule::second_equality(follower.span, &follower.name));
            }
            _ => self.robot.joints[at].held = Some(of_follower + zeroth),
        }
    }

    /// The pose of a key frame.
    fn start(&mut self, key: Element<'a, 'i>) {
        let Some(given) = key.attribute("qpos") else { return };
        let Some(pose) = self.reader.some_numbers(given, "`qpos` of a key frame") else { return };
        let moving = |joint: &&mut Joint| !matches!(joint.motion, Motion::Fixed);
        let count = self.robot.joints.iter_mut().filter(moving).count();
        if pose.len() == count {
            self.robot.joints.iter_mut().filter(moving).zip(pose).for_each(|(joint, start)| joint.start = Some(start));
        } else {
            let remark = format!("The key frame is left out: it has {} numbers for {count} joints.", pose.len());
            self.robot.left_out.push(remark);
        }
    }
}
