//! Loops that cannot be closed, and loop joints that hold what others hold.

use super::{Plausibility, rounded};
use crate::chain::{Across, Attachment, BodyId, CoordinateKind, Frame, LoopJoint, LoopJointKind, Vector};
use crate::diagnostic::rule;
use crate::spec::entries;

/// Largest angle between the axes of a pin at the guess, degrees.
const CROSSED: f64 = 60.0;
/// Distance below which points coincide, m; and part by which a side may exceed all others.
const SAME: f64 = 1e-9;
/// How far a point may be beyond a beam, in lengths of the beam.
const BEYOND: f64 = 1.5;

impl Plausibility<'_> {
    pub(super) fn loops(&mut self) {
        let (crane, chain) = (self.crane, self.chain);
        let frames = chain.frames(&chain.guess, &self.values);
        for (index, (loop_joint, joint)) in entries(crane.loop_joints.as_ref()).zip(&chain.loop_joints).enumerate() {
            let [longest, others] = self.sides(joint, &frames);
            if longest > others * (1.0 + SAME) + SAME {
                self.warn(rule::open_polygon(loop_joint.name.span, &joint.name, rounded(longest), rounded(others)));
            }
            if let LoopJointKind::Pin { across: Across { axis, .. }, to_axis } = &joint.kind {
                let frame = |end: &Attachment| end.body.map_or(Frame::WORLD, |BodyId(body)| frames[body]);
                let [first, second] = joint.ends.each_ref().map(frame);
                let (one, other) = (first.direction(*axis), second.direction(*to_axis));
                let cosine: f64 = (0..3).map(|i| one[i] * other[i]).sum();
                let angle = libm::acos(cosine.clamp(-1.0, 1.0)).to_degrees();
                if angle > CROSSED {
                    self.warn(rule::crossed_axes(loop_joint.joint.span, &joint.name, rounded(angle)));
                }
            }
            if let Some(other) = chain.loop_joints[..index].iter().find(|other| self.is_same(joint, other)) {
                self.warn(rule::held_twice(loop_joint.name.span, &joint.name, &other.name));
            }
            for end in [&loop_joint.from, &loop_joint.to].into_iter().filter_map(|end| end.value.as_ref()) {
                let beam = entries(Some(&crane.links)).find(|link| {
                    link.beam.is_some() && end.link.as_ref().is_some_and(|name| name.value == link.name.value)
                });
                let length =
                    beam.and_then(|link| link.beam.as_ref()?.value.as_ref()).map(|beam| self.number(&beam.length).0);
                let x = end.at.value.as_ref().map(|at| self.number(&at[0]));
                if let (Some(length), Some((x, at)), Some(link)) = (length, x, &end.link)
                    && x > BEYOND * length
                {
                    let name = link.value.as_deref().unwrap_or_default();
                    self.warn(rule::beyond_beam(at, &joint.name, rounded(x), name, rounded(length)));
                }
            }
        }
    }

    /// The longest side of a loop, and the sum of the others: distances between the joints around the loop, which do not change. Nothing is known
    /// of a loop in which something slides.
    fn sides(&self, joint: &LoopJoint, frames: &[Frame]) -> [f64; 2] {
        let chain = self.chain;
        let turns = |id: &crate::chain::CoordinateId| chain.coordinates[id.0].kind == CoordinateKind::Rotation;
        let closed_by = chain.closed_by(joint);
        if matches!(joint.kind, LoopJointKind::Slide { .. }) || !closed_by.iter().all(turns) {
            return [0.0; 2];
        }
        // From the first point back to where both ways meet, and on to the second point.
        let [of_first, of_second] = joint.ends.each_ref().map(|end| {
            let reach = chain.reach(end);
            let moving = closed_by
                .iter()
                .filter(|id| reach.contains(id))
                .map(|id| chain.axis(*id, &chain.guess, &self.values)[0]);
            let place = end.position.each_ref().map(|x| x.at(&self.values));
            let frame = end.body.map_or(Frame::WORLD, |BodyId(body)| frames[body]);
            moving.chain([frame.transform_point(place)]).collect::<Vec<Vector>>()
        });
        let corners: Vec<Vector> = of_first.into_iter().rev().chain(of_second).collect();
        let mut sides: Vec<f64> = corners.windows(2).map(|pair| distance(pair[0], pair[1])).collect();
        if let LoopJointKind::Rod { length } = &joint.kind {
            sides.push(length.at(&self.values));
        }
        let longest = sides.iter().copied().fold(0.0, f64::max);
        [longest, sides.iter().sum::<f64>() - longest]
    }

    /// Whether two loop joints hold the same points of the same bodies.
    fn is_same(&self, joint: &LoopJoint, other: &LoopJoint) -> bool {
        let place = |end: &Attachment| (end.body, end.position.each_ref().map(|x| x.at(&self.values)));
        let is_there = |one: &Attachment, other: &Attachment| {
            let ((body, at), (of, there)) = (place(one), place(other));
            body == of && distance(at, there) < SAME
        };
        let [a, b] = &joint.ends;
        let [c, d] = &other.ends;
        is_there(a, c) && is_there(b, d) || is_there(a, d) && is_there(b, c)
    }
}

fn distance(one: Vector, other: Vector) -> f64 {
    (0..3).map(|i| (other[i] - one[i]).powi(2)).sum::<f64>().sqrt()
}
