//! Joints that close loops.

use super::Check;
use super::joints::WIDTH;
use crate::chain::{
    Across, Chain, CoordinateKind, Cylinder, Force, Frame, Friction, Group, Law, LoopJoint, LoopJointKind, Strain,
    Turning, Value, Vector, cross, normalised,
};
use crate::diagnostic::{Span, rule};
use crate::spec::{self, Crane, entries};

impl<'a> Check<'a> {
    /// Loop joints, and friction in their pins.
    pub(super) fn loop_joints(&mut self, crane: &'a Crane, cylinders: &[Cylinder]) -> (Vec<LoopJoint>, Vec<Force>) {
        let (mut joints, mut forces) = (Vec::new(), Vec::new());
        for written in entries(crane.loop_joints.as_ref()) {
            let name = self.name(&written.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_loop_joint(&name, written.name.span, cylinders);
            }
            let what = format!("loop joint `{name}`");
            let [from, to] = [&written.from, &written.to].map(|end| self.attachment(end, &format!("an end of {what}")));
            let kind = written.joint.value.as_ref().map(|kind| self.loop_joint_kind(kind, &name));
            let (Some(from), Some(to), Some(Some(kind))) = (from, to, kind) else { continue };
            if from.body.is_none() && to.body.is_none() {
                self.report(rule::loop_in_the_world(written.name.span, &name));
            } else if self.coordinates_of(from.body) == self.coordinates_of(to.body) {
                self.report(rule::rigid_loop(written.name.span, &name));
            }
            let joint = LoopJoint { name, ends: [from, to], kind };
            forces.extend(self.friction_in(written, &joint));
            joints.push(joint);
        }
        (joints, forces)
    }

    /// Friction and damping of a pin, if it has any.
    fn friction_in(&mut self, written: &spec::LoopJoint, joint: &LoopJoint) -> Option<Force> {
        const TURNS: Option<CoordinateKind> = Some(CoordinateKind::Rotation);
        let LoopJoint { name, ends, kind } = joint;
        let keys = [
            ("friction", written.friction.as_ref().map(|friction| friction.span)),
            ("damping", written.damping.as_ref().map(|damping| damping.span)),
        ];
        let (key, span) = keys.into_iter().find_map(|(key, span)| Some((key, span?)))?;
        let mut friction = Friction {
            coulomb: Value::ZERO,
            breakaway: None,
            width: WIDTH.into(),
            viscous: Value::ZERO,
            bristle: None,
        };
        if let Some(keys) = written.friction.as_ref().and_then(|friction| friction.value.as_ref()) {
            if let Some(bristle) = &keys.bristle {
                self.report(rule::bristles_in_a_loop(bristle.span, name));
            }
            friction = self.friction(keys, name, TURNS);
        }
        let what = format!("the damping of loop joint `{name}`");
        let damping = self.number_or(written.damping.as_ref(), 0.0, &what);
        friction.viscous = friction.viscous + damping;
        let LoopJointKind::Pin { across, to_axis } = kind else {
            self.report(rule::friction_of_no_pin(span, name, key, kind.name()));
            return None;
        };
        let [reference, _] = Across::to(*to_axis).directions;
        let turning = Turning { ends: ends.clone(), across: across.directions, reference };
        let strain = Strain::Turning(Box::new(turning));
        Some(Force { group: Group::Connectors, name: name.clone(), strain, law: Law::Friction(friction) })
    }

    /// Like cylinders and connectors, loop joints have result columns for their forces.
    pub(super) fn register_loop_joint(&mut self, name: &str, span: Span, cylinders: &[Cylinder]) {
        self.register_name("loop joints", name, "an earlier loop joint".into(), span);
        let other = if cylinders.iter().any(|cylinder| cylinder.name == name) {
            "a cylinder"
        } else if self.expanded.has("connectors", name) {
            "a connector"
        } else {
            return;
        };
        self.report(rule::duplicate_name(span, "elements", name, other));
    }

    /// What a joint holds together; `None` if its axis has no direction.
    fn loop_joint_kind(&mut self, kind: &spec::LoopJointKind, name: &str) -> Option<LoopJointKind> {
        match kind {
            spec::LoopJointKind::Ball => Some(LoopJointKind::Ball),
            spec::LoopJointKind::Pin(pin) => {
                let place = format!("the axis of loop joint `{name}`");
                let axis = self.direction(&pin.axis, &place);
                let to_axis = pin.to_axis.as_ref().map_or(axis, |given| self.direction(given, &place));
                Some(LoopJointKind::Pin { across: Across::to(axis?), to_axis: normalised(to_axis?) })
            }
            spec::LoopJointKind::Rod(rod) => {
                let place = format!("the length of loop joint `{name}`");
                Some(LoopJointKind::Rod { length: self.number(&rod.length, &place) })
            }
            spec::LoopJointKind::Slide(slide) => {
                let axis = self.direction(&slide.axis, &format!("the axis of loop joint `{name}`"));
                Some(LoopJointKind::Slide { across: Across::to(axis?) })
            }
        }
    }

    /// Reports loop joints that nothing can move, and rods whose points coincide; makes both axes of a pin point the same way at the guess,
    /// where its angle is 0.
    pub(super) fn loops_move(&mut self, chain: &mut Chain, crane: &Crane) {
        /// Distance below which two points coincide up to rounding, m.
        const NONE: f64 = 1e-9;
        let frames = chain.frames(&chain.guess, &self.defaults);
        let frame = |end: &crate::chain::Attachment| end.body.map_or(Frame::WORLD, |body| frames[body.0]);
        let mut joints = std::mem::take(&mut chain.loop_joints);
        for (joint, loop_joint) in joints.iter_mut().zip(entries(crane.loop_joints.as_ref())) {
            if chain.closed_by(joint).into_iter().all(|coordinate| chain.is_prescribed(coordinate)) {
                self.report(rule::prescribed_loop(
                    loop_joint.name.span,
                    format!("loop joint `{}`", joint.name),
                    "loop",
                ));
            }
            match &mut joint.kind {
                LoopJointKind::Pin { across, to_axis } => {
                    let [of_first, of_second] = joint.ends.each_ref().map(frame);
                    let (one, other) = (of_first.direction(across.axis), of_second.direction(*to_axis));
                    if (0..3).map(|i| one[i] * other[i]).sum::<f64>() < 0.0 {
                        *to_axis = to_axis.map(|x| -x);
                    }
                    let turning = chain.forces.iter_mut().filter(|force| force.name == joint.name);
                    for force in turning {
                        if let Strain::Turning(turning) = &mut force.strain {
                            turning.reference = along_first(across, *to_axis, &of_first, &of_second);
                        }
                    }
                }
                LoopJointKind::Rod { .. }
                    if chain.distance(joint.ends.each_ref(), &chain.guess, &self.defaults) < NONE =>
                {
                    self.report(rule::meeting_rod(loop_joint.name.span, &joint.name));
                }
                LoopJointKind::Ball
                | LoopJointKind::Rod { .. }
                | LoopJointKind::Slide { .. }
                | LoopJointKind::Pad { .. } => {}
            }
        }
        chain.loop_joints = joints;
        let ensemble = crane.analyses.iter().flat_map(|list| list.value.iter().flatten());
        let mut ensemble = ensemble.filter(|item| item.value == Some(spec::Analysis::Ensemble));
        let what = if chain.loop_joints.is_empty() {
            ("rigid couplings", ", or give couplings a `stiffness`")
        } else {
            ("loop joints", "")
        };
        if let (Some(item), true) = (ensemble.next(), chain.has_loops()) {
            self.report(rule::ensemble_of_loops(item.span, what.0, what.1));
        }
    }
}

/// The direction of the second body, normal to its axis, that lies along u of the first; `u = w × a` if u is nearly along that axis.
fn along_first(across: &Across, axis: Vector, first: &Frame, second: &Frame) -> Vector {
    let [u, w] = across.directions.map(|across| normal_part(second.local_direction(first.direction(across)), axis));
    let size = |vector: Vector| vector.iter().map(|x| x * x).sum::<f64>();
    normalised(if size(u) > size(w) { u } else { cross(w, axis) })
}

/// What is left of a vector without its part along a unit vector.
fn normal_part(vector: Vector, axis: Vector) -> Vector {
    let along: f64 = (0..3).map(|i| vector[i] * axis[i]).sum();
    [0, 1, 2].map(|i| vector[i] - along * axis[i])
}
