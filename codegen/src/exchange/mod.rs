//! Cranes in the languages of other programs: URDF and MJCF, written and read.
//!
//! URDF: <https://docs.ros.org/en/rolling/p/urdfdom_headers>; MJCF: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.
//! Exported files have the coordinates of the crane: one joint of one degree of freedom per coordinate, with its name, in the
//! order of `q`.

mod import;
mod inexpressible;
mod look;
mod mass;
mod mjcf;
mod names;
mod rotation;
mod springs;
mod urdf;
pub mod xml;

pub use import::{CATALOGUE, ImportOptions, Imported, Reference, ReferenceDynamics, import, with_includes};
pub use inexpressible::Inexpressible;
pub use look::{Look, shapes};
pub use mjcf::mjcf;
pub use springs::springs;
pub use urdf::urdf;

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fmt::Write;

use crate::chain::{Body, BodyId, Chain, Frame, Group, Step, Strain, Vector};

/// The origin of a crane, and the values of its parameters.
fn origin(chain: &Chain, parameters: &[f64]) -> String {
    let mut text = format!("{}, spec hash {}. Units: SI, rad.", chain.title, chain.spec_hash);
    for (parameter, value) in chain.parameters.iter().zip(parameters) {
        let _ = write!(text, " {} = {value} {}.", parameter.name, parameter.unit);
    }
    text
}

/// The path with one hinge per coordinate of a rotation vector, in the order of the coordinates: neither format has a joint
/// that rotates by a vector with a spring on each component. Both are equal to first order in the angles.
fn hinged(path: &[Step]) -> Vec<Step> {
    let hinges = |step: &Step| match step {
        Step::RotationVector(ids) => ids.map(Step::Move).to_vec(),
        other => vec![other.clone()],
    };
    path.iter().flat_map(hinges).collect()
}

/// The parts that an export omits, for the header of the file and the screen; `None` if nothing is omitted.
#[must_use]
pub fn approximations(chain: &Chain) -> Option<String> {
    let symmetric = |body: &&Body| body.path.iter().any(|step| matches!(step, Step::RotationVector(_)));
    let count = chain.bodies.iter().filter(symmetric).count();
    let hinges = (count > 0).then(|| {
        format!(
            "{count} symmetric section joints become three hinges each, psi, theta, phi in this order: the same pose up to \
             products of their angles. Write `section_joint: paper` for a crane that is exported exactly."
        )
    });
    let joints = [Group::Stops, Group::Friction]
        .iter()
        .any(|group| !chain.forces_of_group(*group).is_empty())
        .then(|| "End stops and friction of joints are left out.".to_owned());
    let loads = (!chain.loads.is_empty()).then(|| "Loads applied from outside are left out.".to_owned());
    let has = |of_kind: fn(&Strain) -> bool| chain.connectors().iter().any(|connector| of_kind(&connector.strain));
    let connectors = [
        (has(|strain| matches!(strain, Strain::Line(_))), "Springs and ropes between points are left out."),
        (has(|strain| matches!(strain, Strain::Coupling { .. })), "Couplings with springs are left out."),
        (has(|strain| matches!(strain, Strain::Depth { .. })), "Contacts with the ground are left out."),
        (
            has(|strain| matches!(strain, Strain::Sliding(_))),
            "Pads of telescopes are left out: nothing but its drive holds a stage.",
        ),
        (
            has(|strain| matches!(strain, Strain::Turning(_))),
            "Friction and damping of pins that close loops are left out.",
        ),
    ];
    let connectors = connectors.into_iter().filter(|(has, _)| *has).map(|(_, text)| Some(text.to_owned()));
    let oil = chain.has_valves().then(|| {
        "Cylinders with valves are left out: their joints have no drive and fall; add drives for them.".to_owned()
    });
    let limits = chain.has_limited_drives().then(|| "Limits of drives are left out.".to_owned());
    let events = (!chain.events.is_empty()).then(|| "Events of runs are left out.".to_owned());
    let lost = [hinges, joints, loads].into_iter().chain(connectors).chain([oil, limits, events]).flatten();
    let lost: Vec<String> = lost.collect();
    (!lost.is_empty()).then(|| lost.join(" "))
}

/// Poses of all bodies at `q = 0`, each in the frame of the body that carries it.
fn placements(chain: &Chain, parameters: &[f64]) -> Vec<Frame> {
    let rest = vec![0.0; chain.coordinates.len()];
    let along =
        |path: &[Step]| path.iter().fold(Frame::WORLD, |frame, step| frame.after(step, chain, &rest, parameters));
    chain.bodies.iter().map(|body| along(&body.path)).collect()
}

/// A name that is not in use yet and that fits, which is in use from here on: `first`, or with a number behind it.
#[must_use]
pub fn free_name(names: &mut BTreeSet<String>, first: &str, fits: &dyn Fn(&BTreeSet<String>, &str) -> bool) -> String {
    let numbered = (2..).map(|number| format!("{first}_{number}"));
    let mut candidates = std::iter::once(first.to_owned()).chain(numbered);
    let free = candidates.find(|name| !names.contains(name) && fits(names, name)).unwrap_or_else(|| first.to_owned());
    names.insert(free.clone());
    free
}

/// What is shown of a crane: `given` or, without any, the shapes of its spec; and for each body of which nothing is shown then the end of the bar that
/// represents it, from the origin of its frame: the first body that it carries, or its centre of mass.
fn shown<'l>(
    chain: &Chain,
    placements: &[Frame],
    (parameters, given): (&[f64], &'l [Look]),
) -> (Cow<'l, [Look]>, Vec<Option<Vector>>) {
    if !given.is_empty() {
        return (given.into(), vec![None; chain.bodies.len()]);
    }
    let looks = shapes(chain, parameters);
    let end = |(index, body): (usize, &Body)| {
        if looks.iter().any(|look| look.body == Some(BodyId(index))) {
            return None;
        }
        let next = chain.bodies.iter().skip(index).position(|other| other.parent == Some(BodyId(index)));
        let next = next.map(|next| placements[index + next].origin);
        let com = body.inertia.as_ref().map(|inertia| mass::Lump::from_inertia(inertia, parameters).com);
        [next, com].into_iter().flatten().find(|end| rotation::length(*end) > SHORTEST_BAR)
    };
    let bars = chain.bodies.iter().enumerate().map(end).collect();
    (looks.into(), bars)
}

/// Shorter bars are not drawn, m.
const SHORTEST_BAR: f64 = 1e-3;
/// Radius of the bars that represent bodies, m.
const RADIUS: f64 = 0.03;
