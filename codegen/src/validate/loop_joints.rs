//! Joints that close loops.

use super::Check;
use super::limits::Limit;
use crate::chain::{Across, Chain, Cylinder, Force, Frame, LoopJoint, LoopJointKind, Vector, normalised};
use crate::diagnostic::{Span, rule};
use crate::spec::{self, Crane, Direction, Spanned};

impl<'a> Check<'a> {
    pub(super) fn loop_joints(
        &mut self,
        crane: &'a Crane,
        cylinders: &[Cylinder],
        connectors: &[Force],
    ) -> Vec<LoopJoint> {
        let mut joints: Vec<LoopJoint> = Vec::new();
        for joint in given(crane) {
            let name = self.name(&joint.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_loop_joint(&name, joint.name.span, cylinders, connectors);
            }
            let what = format!("loop joint `{name}`");
            let [from, to] = [&joint.from, &joint.to].map(|end| self.attachment(end, &format!("an end of {what}")));
            let kind = joint.joint.value.as_ref().map(|kind| self.loop_joint_kind(kind, &name));
            let (Some(from), Some(to), Some(Some(kind))) = (from, to, kind) else { continue };
            if from.body.is_none() && to.body.is_none() {
                self.report(rule::loop_in_the_world(joint.name.span, &name));
            } else if self.coordinates_of(from.body) == self.coordinates_of(to.body) {
                self.report(rule::rigid_loop(joint.name.span, &name));
            }
            joints.push(LoopJoint { name, ends: [from, to], kind });
        }
        joints
    }

    /// Like cylinders and connectors, loop joints have result columns for their forces.
    fn register_loop_joint(&mut self, name: &str, span: Span, cylinders: &[Cylinder], connectors: &[Force]) {
        self.register_name("loop joints", name, "an earlier loop joint".into(), span);
        let other = if cylinders.iter().any(|cylinder| cylinder.name == name) {
            "a cylinder"
        } else if connectors.iter().any(|connector| connector.name == name) {
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
                let axis = self.loop_axis(&pin.axis, name);
                let to_axis = pin.to_axis.as_ref().map_or(axis, |given| self.loop_axis(given, name));
                Some(LoopJointKind::Pin { across: Across::to(axis?), to_axis: normalised(to_axis?) })
            }
            spec::LoopJointKind::Rod(rod) => {
                let place = format!("the length of loop joint `{name}`");
                Some(LoopJointKind::Rod { length: self.number(&rod.length, &place, "m", Limit::Positive) })
            }
            spec::LoopJointKind::Slide(slide) => {
                let axis = self.loop_axis(&slide.axis, name);
                Some(LoopJointKind::Slide { across: Across::to(axis?) })
            }
        }
    }

    /// A direction; `None` if it has none.
    fn loop_axis(&mut self, given: &Spanned<Direction>, name: &str) -> Option<Vector> {
        let place = format!("the axis of loop joint `{name}`");
        let axis = given.value.as_ref()?.each_ref().map(|number| self.constant(number, &place, "", Limit::Any));
        if axis.iter().any(|x| x.is_nan()) {
            return None;
        }
        let size = axis.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        if size == 0.0 {
            self.report(rule::loop_axis(given.span, name));
        }
        // The size of very large or small numbers would overflow when squared.
        (size > 0.0).then(|| axis.map(|x| x / size))
    }

    /// Reports loop joints that nothing can move, and rods whose points coincide; makes both axes of a pin point the same way at the guess.
    pub(super) fn loops_move(&mut self, chain: &mut Chain, crane: &Crane) {
        /// Distance below which two points coincide up to rounding, m.
        const NONE: f64 = 1e-9;
        let frames = chain.frames(&chain.guess, &self.defaults);
        let frame = |end: &crate::chain::Attachment| end.body.map_or(Frame::WORLD, |body| frames[body.0]);
        let mut joints = std::mem::take(&mut chain.loop_joints);
        for (joint, given) in joints.iter_mut().zip(given(crane)) {
            if chain.closed_by(joint).into_iter().all(|coordinate| chain.is_prescribed(coordinate)) {
                self.report(rule::prescribed_loop(given.name.span, &joint.name));
            }
            match &mut joint.kind {
                LoopJointKind::Pin { across, to_axis } => {
                    let [of_first, of_second] = joint.ends.each_ref().map(frame);
                    let (one, other) = (of_first.direction(across.axis), of_second.direction(*to_axis));
                    if (0..3).map(|i| one[i] * other[i]).sum::<f64>() < 0.0 {
                        *to_axis = to_axis.map(|x| -x);
                    }
                }
                LoopJointKind::Rod { .. }
                    if chain.distance(joint.ends.each_ref(), &chain.guess, &self.defaults) < NONE =>
                {
                    self.report(rule::meeting_rod(given.name.span, &joint.name));
                }
                LoopJointKind::Ball | LoopJointKind::Rod { .. } | LoopJointKind::Slide { .. } => {}
            }
        }
        chain.loop_joints = joints;
        let ensemble = crane.analyses.iter().flat_map(|list| list.value.iter().flatten());
        let mut ensemble = ensemble.filter(|item| item.value == Some(spec::Analysis::Ensemble));
        if let (Some(item), false) = (ensemble.next(), chain.loop_joints.is_empty()) {
            self.report(rule::ensemble_of_loops(item.span));
        }
    }
}

/// The loop joints as written.
fn given(crane: &Crane) -> impl Iterator<Item = &spec::LoopJoint> {
    let given = crane.loop_joints.as_ref().and_then(|joints| joints.value.as_deref()).unwrap_or_default();
    given.iter().filter_map(|joint| joint.value.as_ref())
}
