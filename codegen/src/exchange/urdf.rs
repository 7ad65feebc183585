//! A crane as URDF: kinematics and masses; springs and dampers are in a second file.

use std::collections::BTreeSet;

use super::look::{Look, colours, on};
use super::mass::Lump;
use super::names::FrameOfBody;
use super::rotation::{along_z, length, roll_pitch_yaw};
use super::xml::{Xml, number_text, numbers};
use super::{Inexpressible, RADIUS, approximations, free_name, hinged, names, origin, placements, shown};
use crate::chain::{
    BodyId, Chain, CoordinateId, CoordinateKind, Follower, Form, Frame, LoopJoint, RigidCoupling, Step, Vector,
};

/// URDF requires limits for joints that are not `continuous`, which would have two coordinates in Pinocchio. The crane has no
/// limits: this value is used for positions (rad or m), velocities (rad/s or m/s) and efforts (N m or N).
pub(super) const NO_LIMIT: [f64; 3] = [1e3, 1e3, 1e9];

/// URDF describes open chains in which a joint mimics one other.
fn expressible(chain: &Chain) -> Result<(), Inexpressible> {
    let Chain { name: crane, loop_joints, rigid_couplings, .. } = chain;
    if let Some(LoopJoint { name, .. }) = loop_joints.first() {
        return Err(Inexpressible {
            title: format!("{crane} has a loop, which `{name}` closes; URDF describes open chains"),
            help: "export MJCF (`--format mjcf`) or a functional mock-up unit (`--format fmu`) for co-simulation, or a spec without `loop_joints` and exact \
                   pads, and close the loop in the other program"
                .into(),
        });
    }
    let follows = |coupling: &RigidCoupling| coupling.follower.coordinate;
    let second = |(index, coupling): &(usize, &RigidCoupling)| {
        rigid_couplings[..*index].iter().any(|other| follows(other) == follows(coupling))
    };
    rigid_couplings.iter().enumerate().find(second).map_or(Ok(()), |(_, coupling)| {
        Err(Inexpressible {
            title: format!(
                "`{}` makes a joint of {crane} follow a second one; in URDF a joint mimics one other",
                coupling.name
            ),
            help: "write the coupling the other way around, with the `coordinate` under `follows`, or export MJCF (`--format mjcf`)"
                .into(),
        })
    })
}

/// The URDF text of a crane with the given parameter values.
///
/// There is one joint per coordinate, with its name, or that of `joints` of the spec; a body with several coordinates has massless links
/// between them. Names of fixed joints end in `_mount`; frames and points of interest are massless links. A body with the name of a frame elsewhere gets
/// a number. A joint that a rigid coupling ties to another one mimics it.
/// `looks` are its visuals; without any, the shapes of the spec, and a bar for each body without one.
///
/// # Errors
/// A closed loop, or several rigid couplings of one joint.
///
/// # Panics
/// If `parameters` is shorter than the chain's list of parameters.
pub fn urdf(chain: &Chain, parameters: &[f64], looks: &[Look]) -> Result<String, Inexpressible> {
    expressible(chain)?;
    let mut xml = Xml::new(&origin(chain, parameters));
    xml.open("robot", &[("name", chain.name.clone())]);
    if let Some(text) = approximations(chain) {
        xml.comment(&text);
    }
    xml.comment("Stiffness and damping of the joints are in the springs file, not here.");
    let frames = names::frames(chain, parameters);
    let mut taken: BTreeSet<String> = frames.iter().map(|frame| frame.name.clone()).collect();
    let bodies = names::bodies(chain, &mut taken);
    let mut free = |name: &str| free_name(&mut taken, name, &|_, _| true);
    // A crane may have a link with the name of the world.
    let ground = free(names::WORLD);
    let joints = names::joints(chain);
    let mut mounts: BTreeSet<String> = joints.iter().cloned().collect();
    let mut mount = |name: &str| free_name(&mut mounts, &format!("{name}_mount"), &|_, _| true);
    let (looks, bars) = shown(chain, &placements(chain, parameters), (parameters, looks));
    for (name, colour) in colours(&looks) {
        xml.open("material", &[("name", name.to_owned())]);
        xml.leaf("color", &[("rgba", colour)]);
        xml.close();
    }
    link(&mut xml, &ground, None, on(&looks, None), None);
    for (index, (body, bar)) in chain.bodies.iter().zip(bars).enumerate() {
        let name = &bodies[index];
        let mut parent = body.parent.map_or(&ground, |BodyId(parent)| &bodies[parent]).clone();
        let mut placement = Frame::WORLD;
        let path = hinged(&body.path);
        for (place, step) in path.iter().enumerate() {
            let Step::Move(id) = step else {
                placement = placement.after(step, chain, &[], parameters);
                continue;
            };
            let coordinate = &chain.coordinates[id.0];
            let kind = if coordinate.kind == CoordinateKind::Rotation { "revolute" } else { "prismatic" };
            let is_last = place + 1 == path.len();
            let child = if is_last { name.clone() } else { free(&format!("{}_frame", coordinate.name)) };
            let mut axis = [0.0; 3];
            axis[coordinate.axis.index()] = 1.0;
            let moves = Moves { kind, axis, mimics: mimics(chain, &joints, *id, parameters) };
            joint(&mut xml, &joints[id.0], (&parent, &child), &placement, Some(moves));
            if !is_last {
                xml.leaf("link", &[("name", child.clone())]);
            }
            (parent, placement) = (child, Frame::WORLD);
        }
        if parent != *name {
            joint(&mut xml, &mount(name), (&parent, name), &placement, None);
        }
        let mass = body.inertia.as_ref().map(|inertia| Lump::from_inertia(inertia, parameters));
        link(&mut xml, name, mass.as_ref(), on(&looks, Some(BodyId(index))), bar);
    }
    let points = names::points(chain, parameters).into_iter();
    let points = points.map(|point| FrameOfBody { name: free(&format!("{}_point", point.name)), ..point });
    for FrameOfBody { name, body, frame } in frames.into_iter().chain(points) {
        let carrier = body.map_or(&ground, |BodyId(body)| &bodies[body]);
        joint(&mut xml, &mount(&name), (carrier, &name), &frame, None);
        xml.leaf("link", &[("name", name)]);
    }
    Ok(xml.finish())
}

/// How a joint moves.
struct Moves {
    /// The word for it in URDF.
    kind: &'static str,
    axis: Vector,
    /// What it mimics, as attributes.
    mimics: Option<[(&'static str, String); 3]>,
}

/// The joint that a coordinate follows exactly, `multiplier · leader + offset`.
fn mimics(
    chain: &Chain,
    joints: &[String],
    id: CoordinateId,
    parameters: &[f64],
) -> Option<[(&'static str, String); 3]> {
    let Follower { leader, ratio, offset, .. } =
        chain.rigid_couplings.iter().map(|coupling| &coupling.follower).find(|follower| follower.coordinate == id)?;
    let [ratio, offset] = [ratio, offset].map(|value| number_text(value.at(parameters)));
    Some([("joint", joints[leader.0].clone()), ("multiplier", ratio), ("offset", offset)])
}

/// A joint of one coordinate, or a fixed joint.
fn joint(xml: &mut Xml, name: &str, (parent, child): (&str, &str), placement: &Frame, moves: Option<Moves>) {
    let kind = moves.as_ref().map_or("fixed", |moves| moves.kind);
    xml.open("joint", &[("name", name.to_owned()), ("type", kind.to_owned())]);
    xml.leaf("parent", &[("link", parent.to_owned())]);
    xml.leaf("child", &[("link", child.to_owned())]);
    if *placement != Frame::WORLD {
        xml.leaf("origin", &pose(placement));
    }
    if let Some(Moves { axis, mimics, .. }) = moves {
        let [far, fast, strong] = NO_LIMIT.map(number_text);
        xml.leaf("axis", &[("xyz", numbers(&axis))]);
        let limits = [("lower", format!("-{far}")), ("upper", far), ("velocity", fast), ("effort", strong)];
        xml.leaf("limit", &limits);
        if let Some(mimics) = mimics {
            xml.leaf("mimic", &mimics);
        }
    }
    xml.close();
}

/// A body: its mass, and what is shown of it: parts, or the bar that represents it.
fn link<'a>(
    xml: &mut Xml,
    name: &str,
    mass: Option<&Lump>,
    looks: impl Iterator<Item = &'a Look>,
    bar: Option<Vector>,
) {
    let named = [("name", name.to_owned())];
    let mut looks = looks.peekable();
    if mass.is_none() && bar.is_none() && looks.peek().is_none() {
        return xml.leaf("link", &named);
    }
    xml.open("link", &named);
    if let Some(Lump { mass, com, tensor }) = mass {
        xml.open("inertial", &[]);
        xml.leaf("origin", &[("xyz", numbers(com))]);
        xml.leaf("mass", &[("value", number_text(*mass))]);
        let entries = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"].into_iter().zip(tensor.map(number_text));
        xml.leaf("inertia", &entries.collect::<Vec<_>>());
        xml.close();
    }
    for Look { frame, form, paint, .. } in looks {
        visual(xml, frame, form, paint.map(|(name, _)| name));
    }
    if let Some(end) = bar {
        let middle = end.map(|component| component / 2.0);
        let form = Form::Cylinder { diameter: 2.0 * RADIUS, length: length(end) };
        visual(xml, &Frame { origin: middle, ..along_z(end) }, &form, None);
    }
    xml.close();
}

fn visual(xml: &mut Xml, frame: &Frame, form: &Form, paint: Option<&str>) {
    // URDF has no capsules.
    if let Form::Capsule { diameter, length } = *form
        && length > 0.0
    {
        visual(xml, frame, &Form::Cylinder { diameter, length }, paint);
        for end in [-0.5, 0.5] {
            let origin = frame.transform_point([0.0, 0.0, end * length]);
            visual(xml, &Frame { origin, ..*frame }, &Form::Capsule { diameter, length: 0.0 }, paint);
        }
        return;
    }
    xml.open("visual", &[]);
    if *frame != Frame::WORLD {
        xml.leaf("origin", &pose(frame));
    }
    xml.open("geometry", &[]);
    match form {
        Form::Box(sides) => xml.leaf("box", &[("size", numbers(sides))]),
        Form::Cylinder { diameter, length } => {
            xml.leaf("cylinder", &[("radius", number_text(diameter / 2.0)), ("length", number_text(*length))]);
        }
        Form::Capsule { diameter, .. } => xml.leaf("sphere", &[("radius", number_text(diameter / 2.0))]),
        Form::Mesh { file, scale, .. } => {
            let mut attributes = vec![("filename", file.clone())];
            attributes.extend((*scale != 1.0).then(|| ("scale", numbers(&[*scale; 3]))));
            xml.leaf("mesh", &attributes);
        }
    }
    xml.close();
    if let Some(paint) = paint {
        xml.leaf("material", &[("name", paint.to_owned())]);
    }
    xml.close();
}

fn pose(frame: &Frame) -> [(&'static str, String); 2] {
    [("xyz", numbers(&frame.origin)), ("rpy", numbers(&roll_pitch_yaw(frame)))]
}
