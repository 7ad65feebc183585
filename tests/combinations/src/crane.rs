//! Random cranes: a loader crane of random numbers with a random set of features.

use std::cell::RefCell;

use fastrand::Rng;
use serde_json::json;

use crate::feature::{Feature as F, Features, excluded, with_needs};
use crate::forms::vary;
use crate::tree::{Tree, entry, push, round};

/// A random crane.
#[derive(Clone, Debug)]
pub struct Case {
    /// The seed that gives it again.
    pub seed: u64,
    /// Its features.
    pub features: Features,
    /// Its spec.
    pub tree: Tree,
}

/// Share of the features that a crane has.
const SHARE: f64 = 0.35;
/// Length of the boom, m.
pub const BOOM: f64 = 3.4;
/// Length of the arm, m.
pub const ARM: f64 = 3.0;
/// Length of a stage, m, and how far it is in the arm or in the other stage with its coordinate at 0.
const STAGE: f64 = 2.0;
const OVERLAP: f64 = 1.9;
/// Height of the boom's joint above the base, m, and its distance from the slewing axis.
const SHOULDER: [f64; 2] = [-0.1, 2.4];

/// The features of a seed. The pair of the seed is among them, so that every pair occurs.
#[must_use]
pub fn features(seed: u64) -> Features {
    let mut rng = Rng::with_seed(seed ^ 0x5eed);
    let pairs = crate::feature::pairs();
    let pair = pairs[usize::try_from(seed).unwrap_or(0) * 37 % pairs.len()];
    let mut chosen: Features = with_needs(pair.0).union(&with_needs(pair.1)).copied().collect();
    let mut all = F::ALL.to_vec();
    rng.shuffle(&mut all);
    for feature in all {
        let fits = with_needs(feature).iter().all(|new| chosen.iter().all(|old| excluded(*new, *old).is_none()));
        if fits && rng.f64() < SHARE {
            chosen.extend(with_needs(feature));
        }
    }
    chosen
}

/// The crane of a seed.
#[must_use]
pub fn crane(seed: u64) -> Case {
    let features = features(seed);
    Case { seed, tree: with_features(seed, &features), features }
}

/// The crane of a seed with given features.
#[must_use]
pub fn with_features(seed: u64, features: &Features) -> Tree {
    let rng = RefCell::new(Rng::with_seed(seed));
    let mut writer = Writer { rng, features, tree: json!({}), angles: [0.0; 3], stage: None };
    writer.write(seed);
    vary(seed, &mut writer.tree);
    writer.tree
}

struct Writer<'f> {
    rng: RefCell<Rng>,
    features: &'f Features,
    tree: Tree,
    /// Angles of column, boom and arm at the start.
    angles: [f64; 3],
    /// Where the first stage begins on the arm at the start, m, if it is a beam on pads.
    stage: Option<f64>,
}

impl Writer<'_> {
    fn has(&self, feature: F) -> bool {
        self.features.contains(&feature)
    }

    /// A number between two others, with four digits.
    fn between(&self, low: f64, high: f64) -> f64 {
        round(low + (high - low) * self.rng.borrow_mut().f64())
    }

    fn write(&mut self, seed: u64) {
        self.angles = [self.between(-2.0, 2.0), self.between(0.25, 0.9), self.between(-0.7, -0.1)];
        self.tree = json!({
            "format": 1,
            "name": format!("random_{seed}"),
            "materials": {"steel": {"E": 2.1e11, "G": 8.1e10, "density": 7850, "yield_stress": 7e8}},
            "links": [], "drives": [], "damping": {}, "guess": {}, "parameters": {},
            "run": {"duration": 0.4, "step": 1e-4, "output": 0.1},
        });
        if self.rng.borrow_mut().bool() {
            self.tree["gravity"] = json!([self.between(-0.5, 0.5), self.between(-0.5, 0.5), self.between(-9.9, -9.7)]);
        }
        self.base(seed);
        self.column();
        self.boom();
        self.arm();
        self.stages();
        self.hook();
        self.branches();
        self.lever();
        self.forces();
        self.connectors();
        self.cylinders(seed);
        self.push("points", json!({"name": "tip", "link": "arm", "at": [ARM, 0, 0]}));
        let position = self.random_point(BOOM);
        self.push("points", json!({"name": "middle", "link": "boom", "at": position}));
        self.push("points", json!({"name": "load", "link": "hook", "at": [0.4, 0, 0]}));
    }

    fn push(&mut self, list: &str, new: Tree) {
        push(&mut self.tree, list, new);
    }

    fn link(&mut self, link: Tree) {
        self.push("links", link);
    }

    fn base(&mut self, seed: u64) {
        let free = self.has(F::FreeBase);
        let mass = self.between(7000.0, 9000.0);
        let com = [self.between(-1.5, -1.0), self.between(-0.05, 0.05), self.between(0.8, 1.0)];
        self.link(json!({"name": "truck", "joint": if free { "free" } else { "fixed" }, "mass": mass, "com": com,
            "inertia": {"Ixx": 6.5e3, "Iyy": 3.6e4, "Izz": 3.8e4}}));
        if !free {
            return;
        }
        let feet = [
            ("front_left", 0.0, 2.4),
            ("front_right", 0.0, -2.4),
            ("rear_left", -4.6, 1.9),
            ("rear_right", -4.6, -1.9),
        ];
        // Without a random number, which would change all that follow.
        let first = usize::try_from(seed % 4).unwrap_or(0);
        let friction = [0.3, 0.6, 0.9].map(|coefficient| ("friction_coefficient", json!(coefficient)));
        let friction: Vec<_> = friction.into_iter().chain([("sticks", json!(true))]).collect();
        for ((name, x, y), (key, value)) in feet.into_iter().zip(friction.into_iter().cycle().skip(first)) {
            let at = [x, round(y + self.between(-0.1, 0.1)), self.between(-0.1, 0.1)];
            let stiffness = [self.between(2e6, 4e6), self.between(2e6, 4e6), self.between(5e6, 9e6)];
            let mut foot = json!({"name": name, "at": at, "stiffness": stiffness, "damping": [4e4, 4e4, 8e4]});
            if self.has(F::ExactSupports) {
                foot["kinematics"] = json!("exact");
            }
            if name == "front_left" {
                foot["plate"] = json!({"area": 0.1, "max_pressure": 2e5});
            }
            if self.has(F::OneSidedFeet) {
                foot["one_sided"] = json!(true);
                foot[key] = value;
            }
            self.push("supports", foot);
        }
    }

    /// Height of the column's frame above the base, m.
    fn column_height(&self) -> f64 {
        if self.has(F::DenavitHartenberg) { SHOULDER[1] } else { 1.05 }
    }

    fn column(&mut self) {
        let height = self.column_height();
        let placement = if self.has(F::DenavitHartenberg) {
            json!({"modified_dh": {"d": height, "theta": 0.05}})
        } else {
            json!({"transform": {"translation": [0, 0, height]}})
        };
        let com = [0.02, 0.0, round(1.75 - height)];
        self.link(
            json!({"name": "column", "placement": placement, "joint": "revolute", "mass": self.between(250.0, 350.0),
            "com": com, "inertia": {"Ixx": 70, "Iyy": 70, "Izz": 9}}),
        );
        let drive =
            if self.has(F::RigidDrive) { json!({"rigid": true}) } else { json!({"stiffness": 3e6, "damping": 3e4}) };
        self.drive("column_psi", drive, self.angles[0], 0.3);
        if self.has(F::Bristles) {
            self.tree["friction"]["column_psi"] =
                json!({"coulomb": 900, "breakaway": 1100, "bristle": {"stiffness": 2e6, "damping": 3e3}});
        }
    }

    /// A drive that holds a position, or moves away from it.
    fn drive(&mut self, coordinate: &str, mut drive: Tree, at: f64, by: f64) {
        drive["coordinate"] = json!(coordinate);
        drive["motion"] =
            if self.has(F::Motion) { moving(at, by, drive["rigid"] == json!(true)) } else { json!({"hold": at}) };
        if self.has(F::Rotor) {
            drive["armature"] = json!(self.between(2.0, 20.0));
        }
        self.push("drives", drive);
    }

    fn boom(&mut self) {
        let placement = if self.has(F::DenavitHartenberg) {
            json!({"modified_dh": {"a": SHOULDER[0], "alpha": "90 deg"}})
        } else {
            json!({"transform": {"translation": [SHOULDER[0], 0, round(SHOULDER[1] - 1.05)], "rotation": {"x": "90 deg"}}})
        };
        let mut link = json!({"name": "boom", "placement": placement, "joint": "revolute"});
        if self.has(F::FlexibleBoom) {
            let height = self.between(0.22, 0.3);
            let section = json!({"box": {"height": height, "width": 0.2, "thickness": 0.006}});
            let mut beam = json!({"length": BOOM, "sections": self.rng.borrow_mut().u8(1..4), "material": "steel", "safety_factor": 1.5,
                "damping": {"beta": 1.5e-3}});
            if self.has(F::Taper) {
                let first = (100.0 * self.between(0.7, 1.4)).round() / 100.0;
                beam["parts"] = json!([
                    {"length": first, "section": {"box": {"height": height, "width": 0.2, "thickness": 0.008}}},
                    {"length": (100.0 * (BOOM - first)).round() / 100.0, "section": section.clone(),
                     "to": {"box": {"height": 0.2, "width": 0.16, "thickness": 0.006}}},
                ]);
            } else {
                beam["section"] = section;
            }
            if self.has(F::Bend) {
                beam["bend"] = json!({"psi": self.between(-0.15, 0.15), "theta": self.between(-0.1, 0.1)});
            }
            if self.has(F::PaperJoint) {
                beam["section_joint"] = json!("paper");
            }
            if self.has(F::ExtraMass) {
                beam["extra_mass"] = json!(self.between(10.0, 40.0));
            }
            link["beam"] = beam;
        } else {
            link["mass"] = json!(self.between(150.0, 250.0));
            link["com"] = json!([self.between(1.5, 1.8), 0.02, 0.01]);
            link["inertia"] = json!({"Ixx": 5, "Iyy": 190, "Izz": 195, "Ixy": 2, "Iyz": -0.5});
        }
        self.link(link);
        let mut drive = json!({"stiffness": 5e7, "damping": 5e4});
        if self.has(F::Input) {
            drive["offset"] = json!("trim");
        }
        self.drive("boom_psi", drive, self.angles[1], 0.15);
    }

    fn arm(&mut self) {
        let mut link = json!({"name": "arm", "joint": "revolute"});
        if self.has(F::OneByOne) {
            let lengths = [0.6, 1.3, 1.1];
            let element = |length: f64| {
                json!({"length": length, "mass": round(36.0 * length), "com": [round(0.48 * length), 0.003, -0.004],
                "inertia": {"Ixx": 0.3, "Iyy": round(0.3 + 3.0 * length * length), "Izz": round(0.2 + 3.0 * length * length)}})
            };
            let spring = |k: f64| {
                json!({"stiffness": {"psi": k, "theta": round(0.7 * k), "phi": round(0.5 * k)},
                "damping": {"psi": 4e3, "theta": 3e3, "phi": 2e3}})
            };
            link["beam"] =
                json!({"length": ARM, "elements": lengths.map(element), "springs": [spring(5e6), spring(4e6)]});
        } else if self.has(F::FlexibleArm) {
            link["beam"] = json!({"length": ARM, "sections": self.rng.borrow_mut().u8(1..3), "material": "steel",
                "section": {"box": {"height": 0.21, "width": self.between(0.12, 0.18), "thickness": 0.005}}, "extra_mass": 14,
                "damping": {"beta": 1.5e-3}});
        } else {
            link["mass"] = json!(self.between(80.0, 150.0));
            link["com"] = json!([1.4, 0.01, -0.02]);
            link["inertia"] = json!({"Ixx": 2, "Iyy": 90, "Izz": 91});
        }
        // After a beam, a link is on its tip.
        if !self.has(F::FlexibleBoom) {
            let by_row = self.has(F::DenavitHartenberg);
            let placement = if by_row {
                json!({"modified_dh": {"a": BOOM}})
            } else {
                json!({"transform": {"translation": [BOOM, 0, 0]}})
            };
            link["placement"] = placement;
        }
        self.link(link);
        let mut drive = json!({"stiffness": 3e7, "damping": 3e4});
        if self.has(F::LimitedDrive) {
            drive["max_effort"] = json!(self.between(9e4, 2e5));
        }
        if self.has(F::Effort) {
            let [from, to] = [self.between(2e3, 6e3), self.between(-6e3, -2e3)];
            let rising = json!({"cubic": {"from": from, "to": to, "begin": 0.02, "duration": 0.3}});
            drive["effort"] = if self.has(F::Input) { json!({"input": "push"}) } else { rising };
        }
        self.drive("arm_psi", drive, self.angles[2], -0.1);
        if self.has(F::Stop) && !self.has(F::Telescope) {
            self.tree["stops"]["arm_psi"] =
                json!({"max": round(self.angles[2] - 0.0005), "stiffness": 4e6, "damping": 0.3});
        }
        if self.has(F::Friction) {
            self.tree["friction"]["arm_psi"] = json!({"coulomb": 300, "breakaway": 400, "viscous": 50});
        }
    }

    /// Where the next link is on the arm: a beam's next link is at its tip.
    fn end_of_arm(&self) -> f64 {
        if self.has(F::FlexibleArm) { 0.0 } else { ARM }
    }

    fn stages(&mut self) {
        if !self.has(F::Telescope) {
            return;
        }
        if self.has(F::Pads) {
            self.stage_on_pads("stage_one", "arm", 0.17);
        } else {
            let begin = round(self.end_of_arm() - OVERLAP);
            self.link(json!({"name": "stage_one", "placement": {"transform": {"translation": [begin, 0, 0]}},
                "joint": {"prismatic": {"axis": "x"}}, "mass": self.between(50.0, 70.0), "com": [1.0, 0, 0.01],
                "inertia": {"Ixx": 0.5, "Iyy": 20, "Izz": 20}}));
        }
        let out = self.between(0.5, 1.0);
        self.stage = self.has(F::Pads).then_some(ARM - OVERLAP + out);
        self.drive("stage_one_x", json!({"stiffness": 6e6, "damping": 6e4}), out, 0.2);
        if self.has(F::Stop) {
            self.tree["stops"]["stage_one_x"] = json!({"min": round(out + 0.0005), "stiffness": 5e6, "damping": 0.4});
        }
        if self.has(F::Friction) {
            self.tree["friction"]["stage_one_x"] = json!({"coulomb": 200, "viscous": 100});
        }
        if self.has(F::Coupling) {
            if self.has(F::Pads) {
                self.stage_on_pads("stage_two", "stage_one", 0.14);
            } else {
                self.link(json!({"name": "stage_two", "placement": {"transform": {"translation": [0.1, 0, 0]}},
                    "joint": {"prismatic": {"axis": "x"}}, "mass": self.between(30.0, 40.0), "com": [1.1, 0, 0],
                    "inertia": {"Ixx": 0.3, "Iyy": 12, "Izz": 12}}));
            }
            self.push(
                "couplings",
                json!({"name": "chains", "coordinate": "stage_two_x", "follows": "stage_one_x",
                "ratio": 0.9, "offset": 0.05, "stiffness": 5e6, "damping": 3e4}),
            );
        }
    }

    /// A beam of a height that slides in another one on pads, which may have clearance or be exact.
    fn stage_on_pads(&mut self, name: &str, outer: &str, height: f64) {
        let clearance = if self.rng.borrow_mut().bool() { 2e-4 } else { 0.0 };
        let pad = |twist: f64| {
            json!({"stiffness": [self.between(5e7, 2e8), self.between(5e7, 2e8), twist], "damping": [1e5, 1e5, 2e3],
                "clearance": [clearance, clearance, 5.0 * clearance]})
        };
        let pads = if self.has(F::ExactPads) {
            let rear =
                json!({"exact": ["y", "z"], "stiffness": [0, 0, self.between(1e5, 1e6)], "damping": [0, 0, 2e3]});
            json!({"front": {"exact": ["y", "z", "twist"]}, "rear": rear})
        } else {
            json!({"front": pad(self.between(1e6, 4e6)), "rear": pad(if height > 0.15 { 1e6 } else { 0.0 })})
        };
        let sections = match self.rng.borrow_mut().u8(0..3) {
            0 => json!("rigid"),
            sections => json!(sections),
        };
        self.link(json!({"name": name, "joint": {"prismatic": {"axis": "x"}},
            "beam": {"length": STAGE, "sections": sections, "material": "steel", "damping": {"beta": 1.5e-3},
                "section": {"box": {"height": height, "width": round(0.6 * height), "thickness": 0.005}},
                "slides_in": {"beam": outer, "overlap": OVERLAP, "pads": pads}}}));
    }

    fn hook(&mut self) {
        // After a beam, a link is on its tip.
        let end = match (self.has(F::Telescope), self.has(F::Pads)) {
            (true, false) => STAGE,
            (true, true) => 0.0,
            (false, _) => self.end_of_arm(),
        };
        let hangs = json!({"transform": {"translation": [end, 0, 0], "rotation": {"z": "-90 deg"}}});
        let upright = round(-self.angles[1] - self.angles[2]);
        let mass = if self.has(F::Parameters) {
            let value = self.between(150.0, 400.0);
            self.tree["parameters"]["payload"] = json!({"value": value, "unit": "kg"});
            json!("payload")
        } else {
            json!(self.between(150.0, 400.0))
        };
        let mut hook =
            json!({"name": "hook", "mass": mass, "com": [0.4, 0, 0], "inertia": {"gyration": [0.3, 0.35, 0.4]}});
        if self.has(F::Rope) {
            self.link(json!({"name": "rope", "placement": hangs,
                "rope": {"length": 2, "links": self.rng.borrow_mut().u8(1..3), "mass_per_length": 3, "damping": 20}}));
            self.tree["guess"]["rope_1_psi"] = json!(upright);
        } else if self.has(F::Swing) {
            self.link(json!({"name": "swing", "placement": hangs, "joint": "revolute"}));
            hook["joint"] = json!({"revolute": {"axis": "y"}});
            hook["com"] = json!([0.8, 0, 0]);
            self.tree["guess"]["swing_psi"] = json!(upright);
            for swings in ["swing_psi", "hook_theta"] {
                self.tree["damping"][swings] = json!(30);
            }
        } else {
            hook["placement"] = hangs;
        }
        self.link(hook);
    }

    /// A flexible arm with a platform on the back of the column, and a lamp on the boom.
    fn branches(&mut self) {
        if !self.has(F::SecondArm) {
            return;
        }
        let back = json!({"transform": {"translation": [-0.2, 0, round(SHOULDER[1] - self.column_height())],
            "rotation": [{"z": "180 deg"}, {"x": "90 deg"}]}});
        self.link(json!({"name": "jib", "on": "column", "placement": back, "joint": "revolute",
            "beam": {"length": 2.2, "sections": self.rng.borrow_mut().u8(1..3), "material": "steel",
                "section": {"box": {"height": 0.16, "width": self.between(0.1, 0.14), "thickness": 0.005}}, "damping": {"beta": 1.5e-3}}}));
        self.link(
            json!({"name": "platform", "mass": self.between(80.0, 150.0), "com": [0.4, 0.3, self.between(-0.2, 0.2)],
            "inertia": {"gyration": [0.3, 0.35, 0.4]}}),
        );
        let angle = self.between(0.2, 0.9);
        self.drive("jib_psi", json!({"stiffness": 2e7, "damping": 3e4}), angle, 0.1);
        let at = self.random_point(BOOM);
        self.link(json!({"name": "lamp", "on": {"link": "boom", "at": at}, "mass": self.between(10.0, 30.0), "com": [0.02, 0.2, -0.01],
            "inertia": {"gyration": [0.1, 0.12, 0.14]}}));
    }

    /// A lever on the column that follows the boom: through a massless rod, through a bar of its own that a ball joint, or a pin with friction,
    /// holds to the boom, or by its tip, which slides along the boom.
    fn lever(&mut self) {
        if !self.has(F::Loop) {
            return;
        }
        let (aside, angle) = (self.between(-0.35, -0.25), self.between(0.4, 0.8));
        let origin = [0.35, aside, 1.6];
        let place = json!({"transform": {"translation": [origin[0], aside, round(origin[2] - self.column_height())], "rotation": {"x": "90 deg"}}});
        self.link(json!({"name": "lever", "on": "column", "placement": place, "joint": "revolute", "mass": self.between(20.0, 40.0),
            "com": [0.3, 0.01, 0], "inertia": {"Ixx": 0.2, "Iyy": 1, "Izz": 1}}));
        self.tree["damping"]["lever_psi"] = json!(30);
        self.tree["guess"]["lever_psi"] = json!(angle);
        // The boom's z points to the right, as the lever's does. Off the lever's plane, the rod is one in space.
        let x = self.between(1.0, 1.6);
        let tip = [origin[0] + 0.6 * angle.cos(), origin[2] + 0.6 * angle.sin()];
        let lift = self.angles[1];
        let end = [SHOULDER[0] + x * lift.cos(), SHOULDER[1] + x * lift.sin()];
        let between = (end[0] - tip[0]).hypot(end[1] - tip[1]);
        let bar = self.rng.borrow_mut().bool();
        let off = if bar { 0.0 } else { self.between(-0.15, 0.15) };
        let to = json!({"link": "boom", "at": [x, 0, round(-aside + off)]});
        if bar {
            let turned = round((end[1] - tip[1]).atan2(end[0] - tip[0]) - angle);
            self.link(json!({"name": "bar", "placement": {"transform": {"translation": [0.6, 0, 0]}}, "joint": "revolute",
                "mass": self.between(8.0, 15.0), "com": [0.45, 0, 0], "inertia": {"Ixx": 0.05, "Iyy": 0.8, "Izz": 0.8}}));
            self.tree["damping"]["bar_psi"] = json!(10);
            self.tree["guess"]["bar_psi"] = json!(turned);
            let mut joint = json!({"name": "end", "from": {"link": "bar", "at": [round(between), 0, 0]}, "to": to, "joint": "ball"});
            if self.has(F::Friction) && self.rng.borrow_mut().bool() {
                joint["joint"] = json!({"pin": {"axis": [0, 0, 1]}});
                joint["friction"] = json!({"coulomb": 40, "breakaway": 60, "viscous": 5});
                joint["damping"] = json!(3);
            }
            self.push("loop_joints", joint);
        } else if off > 0.0 {
            // Where the tip is, along the boom and off its axis.
            let [along, up] = [tip[0] - SHOULDER[0], tip[1] - SHOULDER[1]];
            let at = [0.3, round(up * lift.cos() - along * lift.sin()), round(-aside)];
            self.push(
                "loop_joints",
                json!({"name": "groove", "from": {"link": "boom", "at": at}, "to": {"link": "lever", "at": [0.6, 0, 0]},
                "joint": {"slide": {"axis": [1, 0, 0]}}}),
            );
        } else {
            let length = round(between.hypot(off));
            self.push(
                "loop_joints",
                json!({"name": "rod", "from": {"link": "lever", "at": [0.6, 0, 0]}, "to": to,
                "joint": {"rod": {"length": length}}}),
            );
        }
    }

    /// A place on a link of this length: at its beginning, its tip, or anywhere, mostly off the axis.
    fn random_point(&self, length: f64) -> [f64; 3] {
        let kind = self.rng.borrow_mut().u8(0..5);
        let x = match kind {
            0 => 0.0,
            1 => length,
            _ => self.between(0.1, length - 0.1),
        };
        [x, self.between(-0.2, 0.2), self.between(-0.1, 0.1)]
    }

    fn forces(&mut self) {
        if self.has(F::WorldForce) {
            let at = self.random_point(BOOM);
            let mut load = json!({"name": "wind", "link": "boom", "at": at,
                "force": [self.between(-800.0, 800.0), self.between(-800.0, 800.0), self.between(-500.0, 500.0)]});
            if self.has(F::TimedLoad) {
                load["scale"] = json!({"cubic": {"from": 0.4, "to": 1.3, "begin": 0.1, "duration": 1}});
            }
            self.push("loads", load);
        }
        if self.has(F::LinkMoment) {
            let (link, length) = if self.has(F::Pads) { ("stage_one", STAGE) } else { ("arm", ARM) };
            let at = self.random_point(length);
            self.push(
                "loads",
                json!({"name": "twist", "link": link, "at": at, "axes": "link",
                "force": [self.between(-200.0, 200.0), 150, self.between(-200.0, 200.0)],
                "moment": [300, self.between(-300.0, 300.0), self.between(-400.0, 400.0)]}),
            );
        }
        if self.has(F::Input) {
            self.tree["inputs"] = json!({"trim": {"value": 0.01, "unit": "rad"}, "gust": {"value": 0.7}});
            if self.has(F::Effort) {
                self.tree["inputs"]["push"] = json!({"value": self.between(2e3, 6e3), "unit": "N m"});
            }
            self.push(
                "loads",
                json!({"name": "gusts", "link": "arm", "at": [1.0, 0, 0], "force": [100, 400, -100],
                "scale": {"input": "gust"}}),
            );
        }
    }

    /// A point of the boom in the world at the guess.
    fn boom_point(&self, x: f64) -> [f64; 3] {
        let [slew, lift, _] = self.angles;
        let radius = SHOULDER[0] + x * lift.cos();
        [radius * slew.cos(), radius * slew.sin(), SHOULDER[1] + x * lift.sin()]
    }

    fn connectors(&mut self) {
        let down = 1.05 - self.column_height();
        if self.has(F::Spring) {
            let at = self.random_point(2.0);
            self.push(
                "connectors",
                json!({"name": "spring", "from": {"link": "column", "at": [0.5, 0.3, round(0.4 + down)]},
                "to": {"link": "boom", "at": [round(at[0] + 0.5), at[1], at[2]]},
                "law": {"spring": {"stiffness": 2e4, "length": 1.4, "damping": 500}}}),
            );
        }
        if self.has(F::GasSpring) {
            let (from, to) = (self.random_point(1.5), self.random_point(1.5));
            // Where the stage is in the arm.
            let to = if self.has(F::Pads) {
                json!({"link": "stage_one", "at": [round(0.5 * to[0]), -0.25, -0.1]})
            } else {
                json!({"link": "arm", "at": [round(to[0] + 1.0), -0.25, -0.1]})
            };
            self.push(
                "connectors",
                json!({"name": "gas", "from": {"link": "boom", "at": [round(from[0] + 1.0), -0.3, 0.1]},
                "to": to,
                "law": {"gas_spring": {"force": 3e3, "length": 2.5, "stiffness": 4e3, "damping": 300}}}),
            );
        }
        if self.has(F::Guy) {
            let x = *self.rng.borrow_mut().choice(&[BOOM, 2.5, 1.7]).unwrap_or(&BOOM);
            let from = [-3.0, self.between(-2.0, 2.0), 6.0];
            let to = self.boom_point(x);
            let distance = (0..3).map(|k| (to[k] - from[k]).powi(2)).sum::<f64>().sqrt();
            let length = round(distance - 0.02);
            let mut rope = json!({"stiffness": 1e5, "damping": 0.5});
            if self.has(F::Winch) {
                rope["motion"] = json!({"quintic": {"from": length, "to": round(length - 0.05), "duration": 1}});
            } else {
                rope["length"] = json!(length);
            }
            self.push(
                "connectors",
                json!({"name": "guy", "from": {"at": from}, "to": {"link": "boom", "at": [x, 0, 0]},
                "law": {"rope": rope}}),
            );
        }
        if self.has(F::Sheaves) {
            self.reeving(down);
        }
    }

    /// A rope from the column or from a place in the world over sheaves on the boom and perhaps on a mast to the arm.
    fn reeving(&mut self, down: f64) {
        let [slew, lift, bend] = self.angles;
        // Radius, distance to the left and height at the guess.
        let along = |[x, up, aside]: [f64; 3], [radius, height]: [f64; 2], angle: f64| {
            let (sin, cos) = angle.sin_cos();
            [radius + x * cos - up * sin, -aside, height + x * sin + up * cos]
        };
        let in_world = |[radius, left, height]: [f64; 3]| {
            let (sin, cos) = slew.sin_cos();
            [radius * cos - left * sin, radius * sin + left * cos, height].map(round)
        };
        // Where a curved boom is, x m along it, and by which angle it has turned upwards: to the second order.
        let boom =
            entry(&self.tree, "links", "name", "boom").map(|boom| boom["beam"]["bend"].clone()).unwrap_or_default();
        let curved = |x: f64| {
            let [psi, theta] = ["psi", "theta"].map(|axis| boom[axis].as_f64().unwrap_or(0.0) * x / BOOM);
            ([x * (1.0 - psi * psi / 6.0), 0.5 * x * psi, -0.5 * x * theta], psi)
        };
        let mut way = Vec::new();
        let [left, height] = [self.between(-0.3, 0.3), self.between(0.4, 0.9)];
        if self.rng.borrow_mut().bool() {
            way.push(([0.5, left, 1.05 + height], json!({"link": "column", "at": [0.5, left, round(height + down)]})));
        } else {
            let place = [-2.5, left, 1.05 + height];
            way.push((place, json!({"at": in_world(place)})));
        }
        let on_boom = [self.between(1.0, BOOM), self.between(0.15, 0.3), self.between(-0.1, 0.1)];
        let ([x, up, aside], turned) = curved(on_boom[0]);
        let place = [x - on_boom[1] * turned, up + on_boom[1], aside + on_boom[2]];
        way.push((along(place, SHOULDER, lift), json!({"link": "boom", "at": on_boom})));
        if self.rng.borrow_mut().bool() {
            let place = [self.between(1.5, 2.5), left, self.between(6.0, 7.0)];
            way.push((place, json!({"at": in_world(place)})));
        }
        let on_arm = [self.between(0.8, ARM), self.between(0.1, 0.2), self.between(-0.1, 0.1)];
        let (tip, turned) = curved(BOOM);
        let [radius, aside_of_tip, height] = along(tip, SHOULDER, lift);
        let [x, up, aside] = on_arm;
        let (link, at) = match self.stage {
            Some(begin) if x > begin => ("stage_one", [round(x - begin), up, aside]),
            _ => ("arm", on_arm),
        };
        let [radius, left, height] = along(on_arm, [radius, height], lift + turned + bend);
        way.push(([radius, left + aside_of_tip, height], json!({"link": link, "at": at})));
        let falls = self.rng.borrow_mut().u8(1..4);
        let distance =
            |pair: &[([f64; 3], Tree)]| (0..3).map(|k| (pair[1].0[k] - pair[0].0[k]).powi(2)).sum::<f64>().sqrt();
        let parts: Vec<f64> = way.windows(2).map(distance).collect();
        let last = parts.last().map_or(0.0, |last| f64::from(falls - 1) * last);
        let free = round(parts.iter().sum::<f64>() + last - 0.1);
        let mut rope = json!({"axial_stiffness": 1e5, "damping": 0.3});
        if self.rng.borrow_mut().bool() {
            rope["motion"] = json!({"cubic": {"from": free, "to": round(free - 0.05), "duration": 1}});
        } else {
            rope["length"] = json!(free);
            rope["max_tension"] = json!(1200);
        }
        let points: Vec<Tree> = way.into_iter().map(|(_, point)| point).collect();
        if let [from, over @ .., to] = points.as_slice() {
            let mut reeving = json!({"name": "reeving", "from": from, "over": over, "to": to, "law": {"rope": rope}});
            if falls > 1 {
                reeving["falls"] = json!(falls);
            }
            self.push("connectors", reeving);
        }
    }

    fn cylinders(&mut self, seed: u64) {
        let down = 1.05 - self.column_height();
        let oil =
            json!({"max_pressure": 320e5, "back_pressure": 5e5, "bulk_modulus": 1.2e9, "hose_volumes": [1e-3, 1e-3]});
        let with_oil = |mut cylinder: Tree| {
            for key in ["max_pressure", "back_pressure", "bulk_modulus", "hose_volumes"] {
                cylinder[key] = oil[key].clone();
            }
            cylinder
        };
        if self.has(F::Cylinder) {
            let head = [self.between(0.5, 2.6), -0.12, self.between(-0.05, 0.05)];
            let mut lift = with_oil(
                json!({"name": "lift", "coordinate": "boom_psi", "foot": {"link": "column", "at": [0.1, 0.02, round(0.35 + down)]},
                "head": {"link": "boom", "at": head}, "bore": 0.16, "rod": 0.08, "retracted": 0.8, "stroke": 3}),
            );
            if self.has(F::Valve) {
                lift["valve"] = valve();
            }
            self.push("cylinders", lift);
        }
        if self.has(F::Cylinder) && self.has(F::Telescope) && self.rng.borrow_mut().bool() {
            let mut extend = with_oil(json!({"name": "extend", "coordinate": "stage_one_x",
                "foot": {"link": "arm", "at": [self.between(0.1, 0.5), -0.05, 0.01]},
                "head": {"link": "stage_one", "at": [self.between(0.1, 0.6), -0.05, 0]},
                "bore": 0.08, "rod": 0.05, "retracted": 0.5, "stroke": 3}));
            if self.has(F::Valve) {
                extend["valve"] = valve();
            }
            self.push("cylinders", extend);
        }
        if self.has(F::Linkage) {
            let (foot, pivot) = (self.between(0.9, 1.9), self.between(2.9, 3.2));
            let rise = self.between(-0.03, 0.03);
            // On the arm of every other crane: the mirror image, along both links from the joint.
            let (links, side, along): (_, _, fn(f64) -> f64) = if seed.is_multiple_of(2) {
                (["boom", "arm"], "right", |x| x)
            } else {
                (["arm", "boom"], "left", |x| round(BOOM - x))
            };
            let mut knuckle = with_oil(json!({"name": "knuckle", "coordinate": "arm_psi",
                "foot": {"link": links[0], "at": [along(foot), -0.24, 0.02]},
                "head": {"link": links[1], "at": [along(0.24), -0.2, 0]},
                "linkage": {"pivot": [along(pivot), rise, 0], "rocker": 0.46, "link": 0.52, "side": side},
                "bore": 0.14, "rod": 0.07, "retracted": 0.6, "stroke": 3}));
            // A drive with a maximum effort, or with an effort besides its spring, has no oil.
            if self.has(F::Valve) && !self.has(F::LimitedDrive) && !self.has(F::Effort) {
                knuckle["valve"] = valve();
            }
            self.push("cylinders", knuckle);
        }
        if self.has(F::Cylinder) || self.has(F::Linkage) {
            self.tree["pump"] = json!({"max_flow": 1.5e-3, "pressure": 300e5});
        }
    }
}

/// A valve with a servo, as each cylinder has it.
fn valve() -> Tree {
    json!({"flow": 6e-4, "pressure_drop": 1e6, "lag": 0.03, "gain": 2, "overlap": 0.03, "leakage": 1e-13})
}

/// A motion from one position by some way: a smooth one, or a curve through points in one of its shapes. Rates of rigid drives must not jump, and all
/// rest at first.
fn moving(at: f64, by: f64, rigid: bool) -> Tree {
    let (to, between) = (round(at + by), round(at + 0.7 * by));
    let table = |shape: &str| json!({"table": {"times": [0.05, 0.8, 2], "values": [at, between, to], "shape": shape}});
    match (to.abs() * 1e3).round().rem_euclid(4.0) {
        1.0 => table("monotone"),
        2.0 => table("spline"),
        3.0 if !rigid => table("linear"),
        _ => json!({"quintic": {"from": at, "to": to, "duration": 2}}),
    }
}
