//! A robot as a file describes it: links and joints with their locations.

use std::collections::BTreeSet;

use crate::chain::{Form, Frame, Vector};
use crate::diagnostic::Span;
use crate::exchange::mass::Lump;
use crate::exchange::rotation::about;
use crate::exchange::urdf::NO_LIMIT;

/// A robot.
pub(super) struct Robot {
    pub(super) name: String,
    pub(super) links: Vec<Link>,
    pub(super) joints: Vec<Joint>,
    /// Springs and dampers between joints.
    pub(super) couplings: Vec<Coupling>,
    /// Acceleration of gravity, m/s², if the file gives it.
    pub(super) gravity: Option<Vector>,
    /// What the file contains and a spec made from it does not, one sentence each.
    pub(super) left_out: Vec<String>,
    /// Why joints move freely, if none has a spring.
    pub(super) no_drives: &'static str,
}

/// A link and its mass, in the link's frame; `None`, or zero, if it carries nothing.
pub(super) struct Link {
    pub(super) name: String,
    pub(super) span: Span,
    pub(super) lump: Option<Lump>,
    /// What it looks like, in the link's frame.
    pub(super) shapes: Vec<(Frame, Form)>,
    /// Pose in it of the frame to which the file gives its name; `None` if the file has none.
    pub(super) frame: Option<Frame>,
}

/// Whether a form has a size that can be seen: its sides are from 1 µm to 1000 km.
pub(super) fn is_visible(form: &Form) -> bool {
    form.sides().iter().all(|side| (1e-6..=1e6).contains(side))
}

/// A joint between two links.
pub(super) struct Joint {
    pub(super) name: String,
    pub(super) span: Span,
    pub(super) motion: Motion,
    pub(super) parent: Named,
    pub(super) child: Named,
    /// Pose of the child in the frame of the parent, at zero.
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
    /// Its spring.
    pub(super) spring: Option<Spring>,
    /// Time constant, s, and damping ratio that its spring and damper are to give.
    pub(super) oscillation: Option<[f64; 2]>,
    /// Where springs on it are relaxed, rad or m.
    pub(super) relaxed: f64,
    /// Inertia of its rotor, kg m² or kg.
    pub(super) armature: f64,
    /// The position at which it is held, m or rad.
    pub(super) held: Option<f64>,
    /// Where it starts, m or rad.
    pub(super) start: Option<f64>,
    /// Its position in the pose in which the file describes the robot, m or rad.
    pub(super) reference: f64,
}

impl Joint {
    /// A joint on which nothing acts.
    pub(super) fn new(name: &str, span: Span, motion: Motion, [parent, child]: [Named; 2]) -> Self {
        Joint {
            name: name.to_owned(),
            span,
            motion,
            parent,
            child,
            placement: Frame::WORLD,
            axis: [1.0, 0.0, 0.0],
            limits: None,
            damping: 0.0,
            friction: 0.0,
            follows: None,
            spring: None,
            oscillation: None,
            relaxed: 0.0,
            armature: 0.0,
            held: None,
            start: None,
            reference: 0.0,
        }
    }

    /// Its range, m or rad, if it has one: exports of cranes write large numbers for none.
    pub(super) fn range(&self) -> Option<[f64; 2]> {
        self.limits.filter(|limits| limits.iter().any(|limit| limit.abs() < NO_LIMIT[0]))
    }

    /// The pose of its child at a position, m or rad, in that at zero.
    pub(super) fn moved_by(&self, position: f64) -> Frame {
        self.motion.moved_by(self.axis, position)
    }

    /// Whether nothing acts on it: it has no force, rotor or constraint.
    pub(super) fn is_plain(&self) -> bool {
        let forces = self.damping != 0.0 || self.friction != 0.0 || self.armature != 0.0;
        !forces && self.spring.is_none() && self.oscillation.is_none() && self.held.is_none() && self.follows.is_none()
    }
}

/// A spring of a joint.
pub(super) struct Spring {
    /// N m/rad or N/m.
    pub(super) stiffness: f64,
    /// The position in which it is relaxed, rad or m.
    pub(super) rest: f64,
}

/// A joint at `multiplier · leader + offset`.
pub(super) struct Follows {
    pub(super) leader: Named,
    pub(super) multiplier: f64,
    /// m or rad.
    pub(super) offset: f64,
}

/// A spring and a damper along `s = follower − ratio · leader`: `−k (s − offset) − d ṡ` on the follower.
pub(super) struct Coupling {
    pub(super) name: String,
    pub(super) follower: String,
    pub(super) leader: String,
    pub(super) ratio: f64,
    /// m or rad.
    pub(super) offset: f64,
    /// N m/rad or N/m.
    pub(super) stiffness: f64,
    /// N m s/rad or N s/m.
    pub(super) damping: f64,
}

/// How a joint moves.
pub(super) enum Motion {
    Fixed,
    Revolute,
    Prismatic,
    /// Along and about several axes, one after the other. It is split before the robot is grouped.
    Several {
        /// The word for it in a file.
        kind: &'static str,
        /// In the frame of the child.
        axes: Vec<SingleAxis>,
        /// Where each of them starts, m or rad.
        starts: Vec<f64>,
    },
    /// In a way that cranes do not support.
    Other(Named),
}

impl Motion {
    /// The pose that a position, m or rad, about or along a unit vector gives a frame.
    pub(super) fn moved_by(&self, axis: Vector, position: f64) -> Frame {
        match self {
            Motion::Revolute => about(axis, position),
            Motion::Prismatic => Frame { origin: axis.map(|component| component * position), ..Frame::WORLD },
            Motion::Fixed | Motion::Several { .. } | Motion::Other(_) => Frame::WORLD,
        }
    }
}

/// One of several axes of a joint.
pub(super) struct SingleAxis {
    /// Of the name of its joint.
    pub(super) ending: &'static str,
    /// Whether the joint turns about it; otherwise it slides along it.
    pub(super) turns: bool,
    /// Unit vector.
    pub(super) axis: Vector,
}

/// A name or a word, and its location.
#[derive(Clone)]
pub(super) struct Named {
    pub(super) name: String,
    pub(super) span: Span,
}

impl Robot {
    /// Names of the joints in springs or equations with other joints.
    pub(super) fn tied(&self) -> BTreeSet<&str> {
        let springs = self.couplings.iter().flat_map(|coupling| [&coupling.follower, &coupling.leader]);
        let following =
            self.joints.iter().filter_map(|joint| Some([&joint.name, &joint.follows.as_ref()?.leader.name]));
        springs.chain(following.flatten()).map(String::as_str).collect()
    }
}
