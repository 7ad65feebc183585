//! Names of what an exported file consists of.

use std::collections::BTreeSet;

use super::free_name;
use crate::chain::{BodyId, Chain, CoordinateId, Frame, NamedFrame};

/// Name of the ground, as `MuJoCo` has it.
pub(super) const WORLD: &str = "world";

/// A place with axes on a body, or in the world.
pub(super) struct FrameOfBody {
    pub(super) name: String,
    pub(super) body: Option<BodyId>,
    pub(super) frame: Frame,
}

/// Frames that the spec names, except where a body or the ground has this name and this place anyway.
pub(super) fn frames(chain: &Chain, parameters: &[f64]) -> Vec<FrameOfBody> {
    let place = |named: &NamedFrame| FrameOfBody {
        name: named.name.clone(),
        body: named.body,
        frame: named.pose(chain, parameters),
    };
    let bodies = chain.frames(&vec![0.0; chain.coordinates.len()], parameters);
    let is_ground = |FrameOfBody { name, body, frame }: &FrameOfBody| {
        let standing = body.is_none_or(|body| chain.coordinates_of(body).is_empty());
        standing && name == WORLD && body.map_or(*frame, |BodyId(body)| bodies[body].outer(frame)) == Frame::WORLD
    };
    let is_body = |FrameOfBody { name, body, frame }: &FrameOfBody| {
        body.is_some_and(|BodyId(body)| chain.bodies[body].name == *name) && *frame == Frame::WORLD
    };
    chain.frames.iter().map(place).filter(|place| !is_ground(place) && !is_body(place)).collect()
}

/// Points of interest.
pub(super) fn points(chain: &Chain, parameters: &[f64]) -> Vec<FrameOfBody> {
    let place = |point: &crate::chain::Point| FrameOfBody {
        name: point.name.clone(),
        body: Some(point.body),
        frame: Frame { origin: point.position.each_ref().map(|value| value.at(parameters)), ..Frame::WORLD },
    };
    chain.points.iter().map(place).collect()
}

/// Names of the bodies: one that a frame elsewhere has gets a number.
pub(super) fn bodies(chain: &Chain, taken: &mut BTreeSet<String>) -> Vec<String> {
    chain.bodies.iter().map(|body| free_name(taken, &body.name, &|_, _| true)).collect()
}

/// Names of the joints, by coordinate: those that the spec gives joints, else those of the coordinates.
pub(super) fn joints(chain: &Chain) -> Vec<String> {
    let named = |index: usize| {
        let own = chain.joints.iter().find(|joint| joint.coordinate == Some(CoordinateId(index)) && joint.at == 0.0);
        own.map_or(&chain.coordinates[index].name, |joint| &joint.name)
    };
    let mut taken = BTreeSet::new();
    (0..chain.coordinates.len()).map(|index| free_name(&mut taken, named(index), &|_, _| true)).collect()
}
