//! Cranes in the languages of other programs: URDF and MJCF written, URDF read.
//!
//! URDF: <https://docs.ros.org/en/rolling/p/urdfdom_headers>; MJCF: <https://mujoco.readthedocs.io/en/stable/XMLreference.html>.
//! What is written has the coordinates of the crane: a joint of one degree of freedom each, of its name, in the order of `q`.

mod import;
mod mass;
mod mjcf;
mod rotation;
mod springs;
mod urdf;
mod xml;

pub use import::{CATALOGUE, import};
pub use mjcf::{Inexpressible, mjcf};
pub use springs::springs;
pub use urdf::urdf;

use std::fmt::Write;

use crate::chain::{Body, Chain, Frame, Step, Vector};

/// Where a crane came from, and with which values of its parameters it was written.
fn origin(chain: &Chain, parameters: &[f64]) -> String {
    let mut text = format!("{}, spec hash {}. Units: SI, rad.", chain.title, chain.spec_hash);
    for (parameter, value) in chain.parameters.iter().zip(parameters) {
        let _ = write!(text, " {} = {value} {}.", parameter.name, parameter.unit);
    }
    text
}

/// Poses of all bodies at `q = 0`, each in the frame of the body before it.
fn placements(chain: &Chain, parameters: &[f64]) -> Vec<Frame> {
    let rest = vec![0.0; chain.coordinates.len()];
    let along =
        |path: &[Step]| path.iter().fold(Frame::WORLD, |frame, step| frame.after(step, chain, &rest, parameters));
    chain.bodies.iter().map(|body| along(&body.path)).collect()
}

/// Where the bar ends by which a body is drawn, from the origin of its frame: at the next body, or at its centre of mass.
fn bars(chain: &Chain, placements: &[Frame], parameters: &[f64]) -> Vec<Option<Vector>> {
    let end = |(index, body): (usize, &Body)| {
        let next = placements.get(index + 1).map(|next| next.origin);
        let com = body.inertia.as_ref().map(|inertia| mass::Lump::of(inertia, parameters).com);
        [next, com].into_iter().flatten().find(|end| rotation::length(*end) > SHORTEST_BAR)
    };
    chain.bodies.iter().enumerate().map(end).collect()
}

/// Nothing shorter is drawn, m.
const SHORTEST_BAR: f64 = 1e-3;
/// Radius of the bars that bodies are drawn by, m.
const RADIUS: f64 = 0.03;
