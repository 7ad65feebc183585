//! Everything except bodies: gravity, equalities, key frames, and elements that a spec cannot express.

use roxmltree::Node;

use super::File;
use crate::chain::Vector;
use crate::exchange::import::document::{child, name_of, tag};
use crate::exchange::import::mistakes::rule;
use crate::exchange::import::robot::{Follows, Joint, Motion, Named};

/// Default acceleration of gravity, m/s².
const GRAVITY: Vector = [0.0, 0.0, -9.81];
/// Sections whose elements a spec cannot express.
const LEFT_OUT: [(&str, &str); 4] =
    [("actuator", "actuators"), ("tendon", "tendons"), ("contact", "pairs of contact"), ("extension", "plugins")];

impl<'a, 'i> File<'a, 'i> {
    /// All sections except settings, defaults and the world.
    pub(super) fn others(&mut self, root: Node<'a, 'i>) {
        let sections = |name: &'static str| root.children().filter(move |node| node.has_tag_name(name));
        let elements = |name: &'static str| sections(name).flat_map(|node| node.children()).filter(Node::is_element);
        for node in sections("option") {
            self.gravity(node);
        }
        for node in elements("equality") {
            self.equality(node);
        }
        if let Some(key) = elements("keyframe").find(|node| node.has_attribute("qpos")) {
            self.start(key);
        }
        for (section, what) in LEFT_OUT {
            let count = elements(section).count();
            if count > 0 {
                self.robot.left_out.push(format!("{count} {what} are left out."));
            }
        }
        let touches = |node: Node<'a, 'i>| {
            node.has_tag_name("geom")
                && ["contype", "conaffinity"].iter().any(|key| self.classes.text(node, None, key) != Some("0"))
        };
        if sections("worldbody").flat_map(|world| world.descendants()).any(touches) {
            self.robot.left_out.push("Contacts of geoms are left out.".to_owned());
        }
        if self.robot.joints.iter().any(|joint| joint.limits.is_some()) {
            let limits = "Ranges of joints become comments: write `stops` for those that the crane reaches.";
            self.robot.left_out.push(limits.to_owned());
        }
    }

    fn gravity(&mut self, option: Node<'a, 'i>) {
        let given = self.numbers(option, None, "gravity", "<option>");
        self.robot.gravity = given.filter(|gravity| *gravity != GRAVITY);
        let flag = child(option, "flag").and_then(|flag| flag.attribute("gravity"));
        if flag == Some("disable") {
            self.robot.gravity = Some([0.0; 3]);
        }
        let flows = ["density", "viscosity"]
            .iter()
            .any(|key| option.attribute(*key).is_some_and(|given| given.parse() != Ok(0.0)));
        if flows {
            self.robot.left_out.push("Forces of the surrounding medium are left out.".to_owned());
        }
    }

    /// Reads an equality that holds a joint or lets it follow another one; no other kind is supported.
    fn equality(&mut self, node: Node<'a, 'i>) {
        if self.classes.text(node, None, "active") == Some("false") {
            return;
        }
        if name_of(node) != "joint" {
            return self.reader.mistakes.push(rule::closed_loop(tag(node), format!("<{}>", name_of(node))));
        }
        let Some(follower) = self.reader.required(node, "joint1", "<joint> of <equality>") else { return };
        let power = |exponent: usize| if exponent == 1 { 1.0 } else { 0.0 };
        let given = self.classes.find(node, None, "polycoef");
        let given = given.and_then(|given| self.reader.some_numbers(given, "`polycoef`")).unwrap_or_default();
        let [zeroth, first, higher @ ..] =
            [0, 1, 2, 3, 4].map(|exponent| given.get(exponent).copied().unwrap_or_else(|| power(exponent)));
        let leader = node.attribute_node("joint2").and_then(|_| self.reader.required(node, "joint2", ""));
        if leader.is_some() && higher != [0.0; 3] {
            return self.reader.mistakes.push(rule::not_linear(tag(node), &follower.name));
        }
        let reference =
            |robot: &[Joint], name: &str| robot.iter().find(|joint| joint.name == name).map(|joint| joint.reference);
        let Some(of_follower) = reference(&self.robot.joints, &follower.name) else {
            return self.reader.mistakes.push(rule::equality(follower.span, &follower.name));
        };
        let of_leader = leader.as_ref().map(|leader| reference(&self.robot.joints, &leader.name).unwrap_or(0.0));
        let Some(joint) = self.robot.joints.iter_mut().find(|joint| joint.name == follower.name) else { return };
        match (leader, of_leader) {
            (Some(Named { name, span }), Some(of_leader)) => {
                // q₁ − ref₁ = c₀ + c₁ (q₂ − ref₂).
                let offset = of_follower + zeroth - first * of_leader;
                joint.follows = Some(Follows { leader: Named { name, span }, multiplier: first, offset });
            }
            _ => joint.held = Some(of_follower + zeroth),
        }
    }

    /// The pose of a key frame.
    fn start(&mut self, key: Node<'a, 'i>) {
        let Some(given) = key.attribute_node("qpos") else { return };
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
