//! Everything except bodies and equalities: gravity, key frames, and elements that a spec cannot express.

use std::collections::BTreeMap;

use super::File;
use crate::chain::{Frame, Vector};
use crate::exchange::import::document::Element;
use crate::exchange::import::robot::{Joint, Motion};
use crate::exchange::import::split::{positions_of_ball, positions_of_free};
use crate::exchange::rotation::from_quaternion;

/// Default acceleration of gravity, m/s².
const GRAVITY: Vector = [0.0, 0.0, -9.81];
/// Sections that a spec cannot express, and what they belong to.
const LEFT_OUT: [(&str, &str); 10] = [
    ("actuator", "actuators"),
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
        let tendons = self.tendons(root);
        for node in root.named("equality").flat_map(Element::elements) {
            if disabled(["equality", "constraint"]) {
                node.leave_out("equalities that a flag disables");
            } else {
                self.equality(node, &tendons);
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
        for coupling in &mut self.robot.couplings {
            if disabled(["spring", "passive"]) {
                coupling.stiffness = 0.0;
            }
            if disabled(["damper", "passive"]) {
                coupling.damping = 0.0;
            }
        }
        self.robot.couplings.retain(|coupling| coupling.stiffness != 0.0 || coupling.damping != 0.0);
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
            let acts = |key: &&str| option.text(key).is_some_and(|text| text.parse() != Ok(0.0));
            // All of them are read.
            if ["density", "viscosity"].iter().filter(|key| acts(key)).count() > 0 {
                self.robot.left_out.push("Forces of the surrounding medium are left out.".to_owned());
            }
            for flag in option.named("flag") {
                for key in FLAGS {
                    if let Some(text) = flag.text(key) {
                        flags.insert(key, text == "disable");
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

    /// The pose of a key frame.
    fn start(&mut self, key: Element<'a, 'i>) {
        let Some(attribute) = key.attribute("qpos") else { return };
        let Some(pose) = self.reader.some_numbers(attribute, "`qpos` of a key frame") else { return };
        let counts: Vec<usize> = self.robot.joints.iter().map(|joint| joint.motion.positions_of_mujoco()).collect();
        let count: usize = counts.iter().sum();
        if pose.len() == count {
            let mut rest = pose.as_slice();
            for (joint, count) in self.robot.joints.iter_mut().zip(counts) {
                let (own, others) = rest.split_at(count);
                rest = others;
                joint.start_at(own);
            }
        } else {
            let remark = format!("The key frame is left out: it has {} numbers instead of {count}.", pose.len());
            self.robot.left_out.push(remark);
        }
    }
}

impl Motion {
    /// How many numbers of `qpos` it has.
    fn positions_of_mujoco(&self) -> usize {
        match self {
            Motion::Fixed => 0,
            Motion::Revolute | Motion::Prismatic | Motion::Other(_) => 1,
            // A quaternion, with a position before it.
            Motion::Several { kind: "free", .. } => 7,
            Motion::Several { .. } => 4,
        }
    }
}

/// The orientation of a quaternion; without length, as `MuJoCo` reads it, none.
fn orientation(quaternion: [f64; 4]) -> Frame {
    from_quaternion(quaternion).unwrap_or(Frame::WORLD)
}

impl Joint {
    /// Lets it start at its numbers of `qpos`.
    fn start_at(&mut self, given: &[f64]) {
        match (&mut self.motion, given) {
            (Motion::Several { starts, .. }, [w, x, y, z]) => {
                *starts = positions_of_ball(&orientation([*w, *x, *y, *z]));
            }
            (Motion::Several { starts, .. }, [a, b, c, w, x, y, z]) => {
                *starts = positions_of_free(&Frame { origin: [*a, *b, *c], ..orientation([*w, *x, *y, *z]) });
            }
            (_, [position]) => self.start = Some(*position),
            _ => {}
        }
    }
}
