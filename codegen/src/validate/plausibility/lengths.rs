//! Lengths of beams, and positions within the crane.

use super::beams::in_metres;
use super::{Plausibility, rounded};
use crate::diagnostic::{Span, rule};
use crate::spec::{Either, Link, LoopJointKind, Number, On, Place, Placement, Shape, Spanned, Vector, entries};

/// Upper limit of lengths and distances in a crane, m.
const LONGEST: f64 = 200.0;

impl Plausibility<'_> {
    pub(super) fn lengths(&mut self) {
        let crane = self.crane;
        for (index, link) in entries(Some(&crane.links)).enumerate() {
            self.lengths_of(link, index == 0);
        }
        for support in entries(crane.supports.as_ref()) {
            let name = support.name.value.as_deref().unwrap_or_default();
            self.check_position(Some(&support.at), &format!("support `{name}`"));
        }
        for load in entries(crane.loads.as_ref()) {
            let name = load.name.value.as_deref().unwrap_or_default();
            self.check_position(load.at.as_ref(), &format!("load `{name}`"));
        }
        for connector in entries(crane.connectors.as_ref()) {
            let name = connector.name.value.as_deref().unwrap_or_default();
            let ends = [&connector.from, &connector.to].into_iter().filter_map(|end| end.value.as_ref());
            for end in ends.chain(entries(connector.over.as_ref())) {
                // Points of the world are not checked: the crane may stand anywhere.
                if end.link.is_some() {
                    self.check_position(Some(&end.at), &format!("connector `{name}`"));
                }
            }
        }
        for joint in entries(crane.loop_joints.as_ref()) {
            let what = format!("loop joint `{}`", joint.name.value.as_deref().unwrap_or_default());
            for end in [&joint.from, &joint.to].into_iter().filter_map(|end| end.value.as_ref()) {
                if end.link.is_some() {
                    self.check_position(Some(&end.at), &what);
                }
            }
            if let Some(LoopJointKind::Rod(rod)) = &joint.joint.value {
                self.check_length(&rod.length, &format!("the length of {what}"));
            }
        }
        for point in entries(crane.points.as_ref()) {
            let name = point.name.value.as_deref().unwrap_or_default();
            self.check_position(point.at.as_ref(), &format!("point `{name}`"));
        }
    }

    fn lengths_of(&mut self, link: &Link, first: bool) {
        let name = link.name.value.as_deref().unwrap_or_default();
        if let Some(beam) = link.beam.as_ref().and_then(|beam| beam.value.as_ref()) {
            self.check_length(&beam.length, &format!("the length of beam `{name}`"));
        }
        if let Some(rope) = link.rope.as_ref().and_then(|rope| rope.value.as_ref()) {
            self.check_length(&rope.length, &format!("the length of rope `{name}`"));
        }
        if let Some(Either::Full(On { at: Some(at), .. })) = link.on.as_ref().and_then(|on| on.value.as_ref())
            && let Some(Place::Point(position)) = &at.value
        {
            let given = Spanned { value: Some(position.clone()), span: at.span };
            self.check_position(Some(&given), &format!("the place of link `{name}` on another"));
        }
        self.check_position(link.com.as_ref(), &format!("the centre of mass of link `{name}`"));
        for body in entries(link.bodies.as_ref()) {
            let body_name = body.name.value.as_deref().unwrap_or_default();
            self.check_position(Some(&body.com), &format!("the centre of mass of body `{body_name}`"));
        }
        let shapes = link.shape.as_ref().and_then(|shape| shape.value.as_ref());
        for shape in shapes.into_iter().flat_map(|shapes| &shapes.0).filter_map(|shape| shape.value.as_ref()) {
            let what = format!("the shape of link `{name}`");
            match shape {
                Shape::Box(of) => self.check_position(Some(&of.size), &what),
                Shape::Cylinder(of) | Shape::Capsule(of) => {
                    self.check_length(&of.diameter, &what);
                    self.check_length(&of.length, &what);
                }
                Shape::Mesh(_) => {}
            }
        }
        // The crane as a whole may be anywhere in the world.
        let placement = link.placement.as_ref().filter(|_| !first).and_then(|placement| placement.value.as_ref());
        let what = format!("the placement of link `{name}`");
        let along = match placement {
            Some(Placement::Transform(transform)) => return self.check_position(transform.translation.as_ref(), &what),
            Some(Placement::ModifiedDh(row)) => [&row.a, &row.d],
            Some(Placement::ClassicDh(row)) => [&row.a, &row.d],
            None => return,
        };
        for given in along.into_iter().flatten() {
            self.check_length(given, &what);
        }
    }

    /// Three lengths; only the first that is too long is reported.
    fn check_position(&mut self, given: Option<&Spanned<Vector>>, what: &str) {
        let Some(numbers) = given.and_then(|given| given.value.as_ref()) else { return };
        let far = numbers.each_ref().map(|number| self.number(number)).into_iter().find(|(number, _)| is_far(*number));
        if let Some((number, at)) = far {
            self.far(number, at, what);
        }
    }

    fn check_length(&mut self, given: &Spanned<Number>, what: &str) {
        let (number, at) = self.number(given);
        if is_far(number) {
            self.far(number, at, what);
        }
    }

    /// Warns of a length that is too long.
    pub(super) fn far(&mut self, number: f64, at: Span, what: &str) {
        self.warn(rule::far(at, what, rounded(number), in_metres(number)));
    }
}

/// Whether a length is out of proportion.
pub(super) fn is_far(length: f64) -> bool {
    length.abs() > LONGEST
}
