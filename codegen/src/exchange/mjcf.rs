//! A crane as MJCF: kinematics, masses, springs, dampers and supports.

use std::fmt;

use super::mass::Lump;
use super::rotation::quaternion;
use super::springs::{JointSpring, linear_rows, on};
use super::xml::{Xml, number_text, numbers};
use super::{RADIUS, approximations, bars, hinged, origin, placements};
use crate::chain::{BodyId, Chain, CoordinateId, CoordinateKind, Frame, Step, Support, SupportKinematics};

/// `MuJoCo` refuses moving bodies without mass or inertia: a massless frame, or a point, gets this value, kg or kg m². It is
/// negligible against the mass of any crane.
const LEAST: f64 = 1e-14;

/// A part of a crane that MJCF cannot express.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inexpressible {
    /// What cannot be expressed, in the user's own names, and why.
    pub title: String,
    /// What to do instead.
    pub help: String,
}

impl fmt::Display for Inexpressible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.title, self.help)
    }
}

impl std::error::Error for Inexpressible {}

/// The MJCF text of a crane with the given parameter values.
///
/// There is one joint per coordinate, with its name. Springs of elements, drives (held at their positions at t = 0) and passive
/// damping become stiffness, damping and spring reference of joints, rotors become armature, rigid drives equality
/// constraints; a linear support becomes three tendons, whose lengths are linear in the base's coordinates. The guess is the
/// key frame `start`.
///
/// # Errors
/// A support with exact kinematics or one that lifts off, or a body with the name of the ground.
///
/// # Panics
/// If `parameters` is shorter than the chain's list of parameters.
pub fn mjcf(chain: &Chain, parameters: &[f64]) -> Result<String, Inexpressible> {
    if let Some(support) = chain.supports.iter().find(|support| support.kinematics == SupportKinematics::Exact) {
        return Err(Inexpressible {
            title: format!("MJCF has no springs along the world's axes, which support `{}` needs", support.name),
            help: "write `kinematics: linear` for small rotations of the base, or export URDF with its file of springs"
                .into(),
        });
    }
    if let Some(support) = chain.supports.iter().find(|support| support.friction.is_some()) {
        return Err(Inexpressible {
            title: format!("MJCF has no supports that lift off, such as `{}`", support.name),
            help: "remove `one_sided` for a crane whose feet are anchored, or export URDF with its file of springs"
                .into(),
        });
    }
    if chain.bodies.iter().any(|body| body.name == "world") {
        return Err(Inexpressible {
            title: "MuJoCo calls the ground `world`, but a link of this crane has that name".into(),
            help: "give the link another name".into(),
        });
    }
    let mut xml = Xml::new(&origin(chain, parameters));
    if let Some(text) = approximations(chain) {
        xml.comment(&text);
    }
    xml.open("mujoco", &[("model", chain.name.clone())]);
    xml.leaf("compiler", &[("angle", "radian".into()), ("inertiafromgeom", "false".into())]);
    let gravity = chain.gravity.each_ref().map(|value| value.at(parameters));
    let step = [("timestep", number_text(chain.run.step)), ("integrator", "implicitfast".into())];
    let [timestep, integrator] = step;
    xml.leaf("option", &[("gravity", numbers(&gravity)), timestep, integrator]);
    xml.open("default", &[]);
    let seen = [("contype", "0".into()), ("conaffinity", "0".into()), ("mass", "0".into())];
    let [contype, conaffinity, mass] = seen;
    xml.leaf("geom", &[("type", "capsule".into()), ("size", number_text(RADIUS)), contype, conaffinity, mass]);
    xml.close();

    xml.open("worldbody", &[]);
    bodies(&mut xml, chain, parameters);
    xml.close();

    if !chain.supports.is_empty() {
        xml.open("tendon", &[]);
        for support in &chain.supports {
            tendons(&mut xml, chain, support, parameters);
        }
        xml.close();
    }
    if chain.rigid_drives().next().is_some() {
        xml.open("equality", &[]);
        for drive in chain.rigid_drives() {
            let name = chain.coordinates[drive.coordinate.0].name.clone();
            // q = q₀ + 0 + …
            let held = [drive.profile.start(parameters), 0.0, 0.0, 0.0, 0.0];
            xml.leaf("joint", &[("joint1", name), ("polycoef", numbers(&held))]);
        }
        xml.close();
    }
    xml.open("keyframe", &[]);
    // MuJoCo lists joints in the order of the file.
    let order = chain.depth_first().into_iter().flat_map(|body| &chain.bodies[body.0].path).flat_map(Step::coordinates);
    let start = chain.guess_at(parameters);
    let guess: Vec<f64> = order.map(|id| start[id.0]).collect();
    xml.leaf("key", &[("name", "start".into()), ("qpos", numbers(&guess))]);
    Ok(xml.finish())
}

/// All bodies, each within the one that carries it.
fn bodies(xml: &mut Xml, chain: &Chain, parameters: &[f64]) {
    let placements = placements(chain, parameters);
    let bars = bars(chain, &placements, parameters);
    let rest = vec![0.0; chain.coordinates.len()];
    let mut open: Vec<BodyId> = Vec::new();
    for id in chain.depth_first() {
        let (index, body, placement) = (id.0, &chain.bodies[id.0], &placements[id.0]);
        while open.last().copied() != body.parent {
            open.pop();
            xml.close();
        }
        open.push(id);
        let attributes = [
            ("name", body.name.clone()),
            ("pos", numbers(&placement.origin)),
            ("quat", numbers(&quaternion(placement))),
        ];
        xml.open("body", &attributes);
        let mut frame = Frame::WORLD;
        let path = hinged(&body.path);
        for step in &path {
            if let Step::Move(id) = step {
                joint(xml, chain, *id, &placement.local(&frame), parameters);
            }
            frame = frame.after(step, chain, &rest, parameters);
        }
        let moves = path.iter().any(|step| matches!(step, Step::Move(_)));
        match &body.inertia {
            Some(inertia) => {
                let lump = Lump::of(inertia, parameters);
                inertial(xml, &Lump { mass: lump.mass.max(LEAST), ..lump });
            }
            None if moves => inertial(xml, &Lump { mass: LEAST, com: [0.0; 3], tensor: [0.0; 6] }),
            None => {}
        }
        if let Some(end) = bars[index] {
            xml.leaf("geom", &[("fromto", numbers(&[[0.0; 3], end].concat()))]);
        }
        for point in chain.points.iter().filter(|point| point.body.0 == index) {
            let at = point.position.each_ref().map(|value| value.at(parameters));
            xml.leaf("site", &[("name", point.name.clone()), ("pos", numbers(&at))]);
        }
    }
    for _ in open {
        xml.close();
    }
}

/// A joint with its spring, damper and rotor; `frame`: its pose in the frame of its body at `q = 0`.
fn joint(xml: &mut Xml, chain: &Chain, id: CoordinateId, frame: &Frame, parameters: &[f64]) {
    let coordinate = &chain.coordinates[id.0];
    let kind = if coordinate.kind == CoordinateKind::Rotation { "hinge" } else { "slide" };
    let mut attributes = vec![("name", coordinate.name.clone()), ("type", kind.to_owned())];
    if frame.origin != [0.0; 3] {
        attributes.push(("pos", numbers(&frame.origin)));
    }
    attributes.push(("axis", numbers(&frame.axes[coordinate.axis.index()])));
    let JointSpring { stiffness, damping, rest } = on(chain, id, parameters);
    let rotor = chain.rotors.iter().find(|rotor| rotor.coordinate == id);
    let armature = rotor.map_or(0.0, |rotor| rotor.armature.at(parameters));
    let spring = [("stiffness", stiffness), ("damping", damping), ("springref", rest), ("armature", armature)];
    attributes.extend(spring.iter().filter(|(_, value)| *value != 0.0).map(|(key, value)| (*key, number_text(*value))));
    xml.leaf("joint", &attributes);
}

fn inertial(xml: &mut Xml, Lump { mass, com, tensor }: &Lump) {
    let [xx, yy, zz, xy, xz, yz] = tensor;
    let inertia = if [xy, xz, yz] == [&0.0; 3] {
        ("diaginertia", numbers(&[*xx, *yy, *zz].map(|moment| moment.max(LEAST))))
    } else {
        ("fullinertia", numbers(tensor))
    };
    xml.leaf("inertial", &[("pos", numbers(com)), ("mass", number_text(*mass)), inertia]);
}

/// The three tendons of a linear support.
fn tendons(xml: &mut Xml, chain: &Chain, support: &Support, parameters: &[f64]) {
    let at = |values: &[crate::chain::Value; 3]| values.each_ref().map(|value| value.at(parameters));
    let (stiffness, damping, free_play) = (at(&support.stiffness), at(&support.damping), at(&support.free_play));
    for (axis, row) in linear_rows(at(&support.position)).iter().enumerate() {
        let moved: Vec<(CoordinateId, f64)> = chain
            .base
            .iter()
            .zip(row)
            .filter_map(|(id, share)| Some(((*id)?, *share)))
            .filter(|(_, s)| *s != 0.0)
            .collect();
        if moved.is_empty() || (stiffness[axis] == 0.0 && damping[axis] == 0.0) {
            continue;
        }
        let attributes = [
            ("name", format!("{}_{}", support.name, ["x", "y", "z"][axis])),
            ("stiffness", number_text(stiffness[axis])),
            ("damping", number_text(damping[axis])),
            ("springlength", number_text(free_play[axis])),
        ];
        xml.open("fixed", &attributes);
        for (id, share) in moved {
            let name = chain.coordinates[id.0].name.clone();
            xml.leaf("joint", &[("joint", name), ("coef", number_text(share))]);
        }
        xml.close();
    }
}
