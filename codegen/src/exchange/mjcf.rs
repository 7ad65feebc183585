//! A crane as MJCF: kinematics, masses, springs, dampers and supports.

use std::collections::BTreeSet;

use super::look::{Look, colours, on as looks_on, surfaces};
use super::mass::Lump;
use super::names::{self, FrameOfBody};
use super::rotation::{length as distance, quaternion};
use super::springs::{JointSpring, linear_rows, on};
use super::xml::{Xml, number_text, numbers};
use super::{Inexpressible, RADIUS, approximations, free_name, hinged, origin, placements, shown};
use crate::chain::{
    BodyId, Chain, CoordinateId, CoordinateKind, Follower, Form, Frame, LoopJoint, LoopJointKind, RigidCoupling, Step,
    Support, SupportKinematics, Value,
};

/// `MuJoCo` refuses moving bodies without mass or inertia: a massless frame, or a point, gets this value, kg or kg m². It is
/// negligible against the mass of any crane.
const LEAST: f64 = 1e-14;

/// The MJCF text of a crane with the given parameter values.
///
/// There is one joint per coordinate, with its name, or that of `joints` of the spec. Frames and points of interest are sites; a body with the name
/// of the ground or of a frame elsewhere gets a number, and so does a point. Springs of elements, drives (held at their positions at t = 0) and passive
/// damping become stiffness, damping and spring reference of joints, efforts of drives actuators with a constant force, rotors armature; a
/// linear support becomes three tendons, whose lengths are linear in the base's coordinates. Rigid drives, rigid couplings and joints that close
/// loops become equality constraints, as stiff as `MuJoCo` allows: they yield by about 1e-4 of the acceleration that they prevent.
///
/// `looks`: geoms without contacts, in group 2; without any, the shapes of the spec, and a capsule for each body without one. `start`: the pose of the key frame `start`, and what it is.
///
/// # Errors
/// A support with exact kinematics or one that lifts off, or a line or a pad that closes a loop.
///
/// # Panics
/// If `parameters` or `start` are shorter than the chain's lists of parameters and of coordinates.
pub fn mjcf(
    chain: &Chain,
    parameters: &[f64],
    looks: &[Look],
    (start, about_start): (&[f64], &str),
) -> Result<String, Inexpressible> {
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
    let inexpressible = |kind: &LoopJointKind| matches!(kind, LoopJointKind::Slide { .. } | LoopJointKind::Pad { .. });
    if let Some(joint) = chain.loop_joints.iter().find(|joint| inexpressible(&joint.kind)) {
        return Err(Inexpressible {
            title: format!("MJCF has no joints such as `{}` that keep a point on a line and close a loop", joint.name),
            help: "write a `ball`, a `pin` or a `rod` for it, or export a functional mock-up unit (`--format fmu`)"
                .into(),
        });
    }
    let mut xml = Xml::new(&origin(chain, parameters));
    if let Some(text) = approximations(chain) {
        xml.comment(&text);
    }
    xml.comment(&format!("Key frame `start`: {about_start}."));
    xml.open("mujoco", &[("model", chain.name.clone())]);
    xml.leaf("compiler", &[("angle", "radian".into()), ("inertiafromgeom", "false".into())]);
    let gravity = chain.gravity.each_ref().map(|value| value.at(parameters));
    let step = [("timestep", number_text(chain.run.step)), ("integrator", "implicitfast".into())];
    let [timestep, integrator] = step;
    xml.leaf("option", &[("gravity", numbers(&gravity)), timestep, integrator]);
    xml.open("default", &[]);
    let seen = [("contype", "0"), ("conaffinity", "0"), ("mass", "0"), ("group", "2")];
    let mut seen: Vec<(&str, String)> = seen.iter().map(|(key, value)| (*key, (*value).to_owned())).collect();
    if looks.is_empty() {
        seen.splice(0..0, [("type", "capsule".to_owned()), ("size", number_text(RADIUS))]);
    }
    xml.leaf("geom", &seen);
    xml.close();
    let (looks, bars) = shown(chain, &placements(chain, parameters), (parameters, looks));
    let surfaces = surfaces(&looks);
    assets(&mut xml, &looks, &surfaces);

    xml.open("worldbody", &[]);
    looks_on(&looks, None).for_each(|look| geom(&mut xml, look, &surfaces));
    let (joints, sites) = (names::joints(chain), sites(chain, parameters));
    sites_on(&mut xml, &sites, None);
    loop_sites(&mut xml, chain, None, parameters);
    bodies(&mut xml, chain, parameters, (&sites, &joints), |xml, id| {
        looks_on(&looks, Some(id)).for_each(|look| geom(xml, look, &surfaces));
        if let Some(end) = bars[id.0] {
            xml.leaf("geom", &[("fromto", numbers(&[[0.0; 3], end].concat()))]);
        }
    });
    xml.close();

    let rods: Vec<(&LoopJoint, &Value)> = chain.loop_joints.iter().filter_map(as_rod).collect();
    if !chain.supports.is_empty() || !rods.is_empty() {
        xml.open("tendon", &[]);
        for support in &chain.supports {
            tendons(&mut xml, chain, support, (parameters, &joints));
        }
        for (joint, _) in &rods {
            xml.open("spatial", &[("name", joint.name.clone())]);
            for site in sites_of(joint).map(|[site, _]| site) {
                xml.leaf("site", &[("site", site)]);
            }
            xml.close();
        }
        xml.close();
    }
    equalities(&mut xml, chain, (parameters, &joints));
    let efforts = (0..chain.coordinates.len()).map(|index| (index, on(chain, CoordinateId(index), parameters).effort));
    let efforts: Vec<(usize, f64)> = efforts.filter(|(_, effort)| *effort != 0.0).collect();
    if !efforts.is_empty() {
        xml.open("actuator", &[]);
        for (index, effort) in efforts {
            let joint = joints[index].clone();
            let no_gain =
                [("gaintype", "fixed".to_owned()), ("gainprm", "0".to_owned()), ("biastype", "affine".to_owned())];
            let [gain_type, gain, bias_type] = no_gain;
            let name = format!("{joint}_effort");
            let bias = numbers(&[effort, 0.0, 0.0]);
            xml.leaf("general", &[("name", name), ("joint", joint), gain_type, gain, bias_type, ("biasprm", bias)]);
        }
        xml.close();
    }
    xml.open("keyframe", &[]);
    // MuJoCo lists joints in the order of the file.
    let order = chain.depth_first().into_iter().flat_map(|body| &chain.bodies[body.0].path).flat_map(Step::coordinates);
    let positions: Vec<f64> = order.map(|id| start[id.0]).collect();
    xml.leaf("key", &[("name", "start".into()), ("qpos", numbers(&positions))]);
    Ok(xml.finish())
}

/// All bodies, each within the one that carries it; `show` writes what is shown of one.
fn bodies(
    xml: &mut Xml,
    chain: &Chain,
    parameters: &[f64],
    (sites, joints): (&[FrameOfBody], &[String]),
    show: impl Fn(&mut Xml, BodyId),
) {
    let mut taken: BTreeSet<String> = names::frames(chain, parameters).into_iter().map(|frame| frame.name).collect();
    taken.insert(names::WORLD.to_owned());
    let names = names::bodies(chain, &mut taken);
    let placements = placements(chain, parameters);
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
            ("name", names[index].clone()),
            ("pos", numbers(&placement.origin)),
            ("quat", numbers(&quaternion(placement))),
        ];
        xml.open("body", &attributes);
        let mut frame = Frame::WORLD;
        let path = hinged(&body.path);
        for step in &path {
            if let Step::Move(id) = step {
                joint(xml, chain, (*id, &joints[id.0]), &placement.local(&frame), parameters);
            }
            frame = frame.after(step, chain, &rest, parameters);
        }
        let moves = path.iter().any(|step| matches!(step, Step::Move(_)));
        match &body.inertia {
            Some(inertia) => {
                let lump = Lump::from_inertia(inertia, parameters);
                inertial(xml, &Lump { mass: lump.mass.max(LEAST), ..lump });
            }
            None if moves => inertial(xml, &Lump { mass: LEAST, com: [0.0; 3], tensor: [0.0; 6] }),
            None => {}
        }
        show(xml, id);
        sites_on(xml, sites, Some(id));
        loop_sites(xml, chain, Some(id), parameters);
    }
    for _ in open {
        xml.close();
    }
}

/// Frames, and the points of interest that are not the origins of frames with their names.
fn sites(chain: &Chain, parameters: &[f64]) -> Vec<FrameOfBody> {
    let mut sites = names::frames(chain, parameters);
    let stands_for = |frame: &FrameOfBody, point: &FrameOfBody| {
        (frame.body, frame.frame.origin, &frame.name) == (point.body, point.frame.origin, &point.name)
    };
    let mut points = names::points(chain, parameters);
    points.retain(|point| !sites.iter().any(|frame| stands_for(frame, point)));
    sites.extend(points);
    let mut taken: BTreeSet<String> = chain.loop_joints.iter().flat_map(sites_of).flatten().collect();
    for site in &mut sites {
        site.name = free_name(&mut taken, &site.name, &|_, _| true);
    }
    sites
}

fn sites_on(xml: &mut Xml, sites: &[FrameOfBody], body: Option<BodyId>) {
    for FrameOfBody { name, frame, .. } in sites.iter().filter(|site| site.body == body) {
        let mut attributes = vec![("name", name.clone()), ("pos", numbers(&frame.origin))];
        if frame.axes != Frame::WORLD.axes {
            attributes.push(("quat", numbers(&quaternion(frame))));
        }
        xml.leaf("site", &attributes);
    }
}

/// Colours and meshes.
fn assets(xml: &mut Xml, looks: &[Look], surfaces: &[(&Form, String)]) {
    let colours = colours(looks);
    if colours.is_empty() && surfaces.is_empty() {
        return;
    }
    xml.open("asset", &[]);
    for (name, colour) in colours {
        xml.leaf("material", &[("name", name.to_owned()), ("rgba", colour)]);
    }
    for (form, name) in surfaces {
        if let Form::Mesh { file, scale, .. } = form {
            // Surfaces are not solids to be weighed.
            let mut attributes = vec![("name", name.clone()), ("file", file.clone()), ("inertia", "shell".into())];
            attributes.extend((*scale != 1.0).then(|| ("scale", numbers(&[*scale; 3]))));
            xml.leaf("mesh", &attributes);
        }
    }
    xml.close();
}

fn geom(xml: &mut Xml, Look { frame, form, paint, .. }: &Look, surfaces: &[(&Form, String)]) {
    let (kind, shape) = match form {
        Form::Box(sides) => ("box", ("size", numbers(&sides.map(|side| side / 2.0)))),
        Form::Cylinder { diameter, length } => ("cylinder", ("size", numbers(&[diameter / 2.0, length / 2.0]))),
        Form::Capsule { diameter, length } if *length == 0.0 => ("sphere", ("size", number_text(diameter / 2.0))),
        Form::Capsule { diameter, length } => ("capsule", ("size", numbers(&[diameter / 2.0, length / 2.0]))),
        Form::Mesh { .. } => {
            let name = surfaces.iter().find(|(other, _)| *other == form).map(|(_, name)| name.clone());
            ("mesh", ("mesh", name.unwrap_or_default()))
        }
    };
    let mut attributes = vec![("type", kind.to_owned()), shape];
    attributes.extend(paint.map(|(name, _)| ("material", name.to_owned())));
    if *frame != Frame::WORLD {
        attributes.extend([("pos", numbers(&frame.origin)), ("quat", numbers(&quaternion(frame)))]);
    }
    xml.leaf("geom", &attributes);
}

/// Length along the axis of a pin between its two sites, m.
const ALONG_PIN: f64 = 0.1;

/// Names of the sites of both ends of a joint that closes a loop: at the end, and along the axis of a pin. No point of a spec has a dot in its
/// name.
fn sites_of(joint: &LoopJoint) -> [[String; 2]; 2] {
    ["from", "to"].map(|end| [format!("{}.{end}", joint.name), format!("{}.{end}.axis", joint.name)])
}

/// A rod that closes a loop, and its length.
fn as_rod(joint: &LoopJoint) -> Option<(&LoopJoint, &Value)> {
    match &joint.kind {
        LoopJointKind::Rod { length } => Some((joint, length)),
        _ => None,
    }
}

/// Sites on a body, or in the world, of the joints that close loops.
fn loop_sites(xml: &mut Xml, chain: &Chain, body: Option<BodyId>, parameters: &[f64]) {
    for joint in &chain.loop_joints {
        let axes = match &joint.kind {
            LoopJointKind::Pin { across, to_axis } => Some([across.axis, *to_axis]),
            _ => None,
        };
        for (end, [name, along]) in sites_of(joint).into_iter().enumerate() {
            if joint.ends[end].body != body {
                continue;
            }
            let at = joint.ends[end].position.each_ref().map(|value| value.at(parameters));
            xml.leaf("site", &[("name", name), ("pos", numbers(&at))]);
            if let Some(axes) = axes {
                let beyond = [0, 1, 2].map(|i| at[i] + ALONG_PIN * axes[end][i]);
                xml.leaf("site", &[("name", along), ("pos", numbers(&beyond))]);
            }
        }
    }
}

/// Rigid drives, rigid couplings and joints that close loops.
fn equalities(xml: &mut Xml, chain: &Chain, (parameters, joints): (&[f64], &[String])) {
    if chain.rigid_drives().next().is_none() && !chain.has_loops() {
        return;
    }
    // Time constant and damping ratio of what is left of an error; the largest share of an acceleration that may be prevented.
    let stiff = [("solref", numbers(&[2.0 * chain.run.step, 1.0])), ("solimp", numbers(&[0.9999, 0.9999, 0.001]))];
    xml.open("equality", &[]);
    for drive in chain.rigid_drives() {
        let name = joints[drive.coordinate.0].clone();
        // q = q₀ + 0 + …
        let held = [drive.profile.start(parameters), 0.0, 0.0, 0.0, 0.0];
        xml.leaf("joint", &[&[("joint1", name), ("polycoef", numbers(&held))], stiff.as_slice()].concat());
    }
    for RigidCoupling { follower: Follower { coordinate, leader, ratio, offset }, .. } in &chain.rigid_couplings {
        let [follower, leader] = [coordinate, leader].map(|id| joints[id.0].clone());
        // q_j = c + r q_i + 0 + …
        let law = [offset.at(parameters), ratio.at(parameters), 0.0, 0.0, 0.0];
        let ties = [("joint1", follower), ("joint2", leader), ("polycoef", numbers(&law))];
        xml.leaf("joint", &[ties.as_slice(), stiff.as_slice()].concat());
    }
    let frames = chain.frames(&vec![0.0; chain.coordinates.len()], parameters);
    for joint in &chain.loop_joints {
        let [[from, from_axis], [to, to_axis]] = sites_of(joint);
        if let Some((_, length)) = as_rod(joint) {
            // From the length at q = 0.
            let [from, to] = joint.ends.each_ref().map(|end| {
                let at = end.position.each_ref().map(|value| value.at(parameters));
                end.body.map_or(at, |BodyId(body)| frames[body].transform_point(at))
            });
            let change = length.at(parameters) - distance([0, 1, 2].map(|i| to[i] - from[i]));
            let held = [change, 0.0, 0.0, 0.0, 0.0];
            let tendon = [("tendon1", joint.name.clone()), ("polycoef", numbers(&held))];
            xml.leaf("tendon", &[tendon.as_slice(), stiff.as_slice()].concat());
            continue;
        }
        let pairs = [(from, to), (from_axis, to_axis)];
        let count = if matches!(joint.kind, LoopJointKind::Pin { .. }) { 2 } else { 1 };
        for (site1, site2) in pairs.into_iter().take(count) {
            xml.leaf("connect", &[&[("site1", site1), ("site2", site2)], stiff.as_slice()].concat());
        }
    }
    xml.close();
}

/// A joint with its spring, damper and rotor; `frame`: its pose in the frame of its body at `q = 0`.
fn joint(xml: &mut Xml, chain: &Chain, (id, name): (CoordinateId, &String), frame: &Frame, parameters: &[f64]) {
    let coordinate = &chain.coordinates[id.0];
    let kind = if coordinate.kind == CoordinateKind::Rotation { "hinge" } else { "slide" };
    let mut attributes = vec![("name", name.clone()), ("type", kind.to_owned())];
    if frame.origin != [0.0; 3] {
        attributes.push(("pos", numbers(&frame.origin)));
    }
    attributes.push(("axis", numbers(&frame.axes[coordinate.axis.index()])));
    let JointSpring { stiffness, damping, rest, .. } = on(chain, id, parameters);
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
fn tendons(xml: &mut Xml, chain: &Chain, support: &Support, (parameters, joints): (&[f64], &[String])) {
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
            let name = joints[id.0].clone();
            xml.leaf("joint", &[("joint", name), ("coef", number_text(share))]);
        }
        xml.close();
    }
}
