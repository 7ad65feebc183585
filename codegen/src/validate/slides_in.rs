//! Telescopes: beams that slide in beams on two pads.

use super::limits::Limit;
use super::on::Attached;
use super::{Check, LinkBodies, Owner};
use crate::chain::{
    self, Attachment, Axis, BeamAxis, BodyId, Clearance, CoordinateId, CoordinateKind, Cylinder, Force, Group, Law,
    PadDirection, Sliding, Spring, Step, Strain, Value,
};
use crate::diagnostic::{Span, rule};
use crate::spec::{AxisName, Beam, Joint, Link, Pad, SlidesIn, Spanned};

/// An overlap may exceed a beam by this fraction of its length, because both are decimal numbers.
const WRITTEN: f64 = 1e-9;

/// Motions of the inner beam besides that of its joint, which the pads hold.
const HELD: [(CoordinateKind, Axis); 5] = [
    (CoordinateKind::Translation, Axis::Y),
    (CoordinateKind::Translation, Axis::Z),
    (CoordinateKind::Rotation, Axis::Z),
    (CoordinateKind::Rotation, Axis::Y),
    (CoordinateKind::Rotation, Axis::X),
];

/// The directions in which pads hold, and the words for them in names.
const DIRECTIONS: [(PadDirection, &str); 3] =
    [(PadDirection::Along(Axis::Y), "y"), (PadDirection::Along(Axis::Z), "z"), (PadDirection::Twist, "twist")];

/// A telescope's stage, of which the pads follow.
#[derive(Debug)]
pub(super) struct Stage<'a> {
    link: &'a str,
    span: Span,
    /// The outer beam and the inner one.
    beams: [BeamAxis; 2],
    /// Where the coordinate is 0, m.
    overlap: Value,
    coordinate: CoordinateId,
    /// Front and rear: the laws of each direction; `None` for a twist that is not held.
    pads: [[Option<Law>; 3]; 2],
}

/// The outer beam of a stage and the place of the inner one in it.
#[derive(Clone, Debug)]
pub(super) struct Outer {
    place: LinkBodies,
    overlap: Value,
}

/// What a link slides in, if it does.
pub(super) fn slides_in(link: &Link) -> Option<&Spanned<SlidesIn>> {
    link.beam.as_ref()?.value.as_ref()?.slides_in.as_ref()
}

/// The axis of a beam.
fn axis_of(place: &LinkBodies) -> BeamAxis {
    BeamAxis { first: BodyId(place.first), sections: place.starts.len() - 1, length: place.length() }
}

/// The key of a beam that is not straight and of equal sections, if it has one.
fn uneven(beam: &Beam) -> Option<(&'static str, Span)> {
    let bend = beam.bend.as_ref().map(|bend| ("bend", bend.span));
    bend.or(beam.elements.as_ref().map(|elements| ("elements", elements.span)))
}

/// Whether the joint of a link is prismatic along x, as far as it could be read.
fn slides_along_x(link: &Link) -> bool {
    let axis = match link.joint.as_ref().map(|joint| &joint.value) {
        Some(Some(Joint::Prismatic(Some(axis)))) => axis.axis.as_ref().map(|axis| axis.value),
        // A mistake of its own.
        Some(None) => Some(None),
        _ => None,
    };
    matches!(axis, Some(Some(AxisName::X) | None))
}

impl<'a> Check<'a> {
    /// Where a link begins that slides in a beam; `None` after a mistake.
    pub(super) fn slid(&mut self, links: &'a [Spanned<Link>], index: usize) -> Option<(Attached, Outer)> {
        let link = links[index].value.as_ref()?;
        let name = link.name.value.as_deref().unwrap_or_default();
        let given = slides_in(link)?.value.as_ref()?;
        self.joint_of_slider(link, name);
        let outer_name = given.beam.value.as_deref()?;
        let place = self.earlier_link(links, index, (outer_name, given.beam.span)).cloned();
        let overlap = self.number(&given.overlap, &format!("the overlap of `{name}`"), "m", Limit::Positive);
        let named =
            |link: &&Spanned<Link>| link.value.as_ref().and_then(|link| link.name.value.as_deref()) == Some(outer_name);
        let outer = links[..index].iter().find(named).and_then(|link| link.value.as_ref());
        let (place, outer) = (place?, outer?);
        match outer.beam.as_ref().map(|beam| &beam.value) {
            None => {
                self.report(rule::slides_in_no_beam(given.beam.span, name, outer_name));
                return None;
            }
            Some(None) => return None,
            Some(Some(beam)) => {
                if let Some((key, _)) = uneven(beam) {
                    self.report(rule::uneven_outer(given.beam.span, outer_name, key));
                }
            }
        }
        let behind = place.length() - overlap.clone();
        let start = [behind, Value::ZERO, Value::ZERO];
        Some((Attached::at(BodyId(place.first), Value::ZERO, start), Outer { place, overlap }))
    }

    /// A link that slides in a beam has a joint along x and no other place.
    fn joint_of_slider(&mut self, link: &Link, name: &str) {
        if !slides_along_x(link) {
            let span = link.joint.as_ref().map_or(link.name.span, |joint| joint.span);
            self.report(rule::slider_joint(span, name));
        }
        let placed = [
            ("on", link.on.as_ref().map(|on| on.span)),
            ("placement", link.placement.as_ref().map(|placement| placement.span)),
        ];
        for (key, span) in placed.into_iter().filter_map(|(key, span)| Some((key, span?))) {
            self.report(rule::placed_slider(span, name, key));
        }
        if let Some((key, span)) = link.beam.as_ref().and_then(|beam| uneven(beam.value.as_ref()?)) {
            self.report(rule::uneven_slider(span, name, key));
        }
    }

    /// The motions of a link that slides in a beam besides that of its joint; none for other links.
    pub(super) fn held_motions(&mut self, link: &'a Link) -> Vec<Step> {
        if slides_in(link).is_none() || !slides_along_x(link) {
            return Vec::new();
        }
        let name = link.name.value.as_deref().unwrap_or_default();
        let span = link.name.span;
        HELD.map(|(kind, axis)| {
            Step::Move(self.push_coordinate((name, name), kind, axis, Owner::Pads(name.to_owned()), span))
        })
        .into()
    }

    /// Notes a link that slides in a beam, after its bodies have been appended.
    pub(super) fn note_stage(&mut self, link: &'a Link, outer: Option<Outer>, own: &LinkBodies, first: CoordinateId) {
        let Some(given) = slides_in(link).and_then(|given| given.value.as_ref()) else { return };
        let name = link.name.value.as_deref().unwrap_or_default();
        let laws = given.pads.value.as_ref().map(|pads| {
            [(&pads.front, "front"), (&pads.rear, "rear")]
                .map(|(pad, which)| self.pad(pad, &format!("the {which} pad of `{name}`")))
        });
        let (Some(Outer { place, overlap }), Some(pads)) = (outer, laws) else { return };
        self.keep_overlap(&overlap, [&place, own], name, given.overlap.span);
        if pads.iter().all(|[.., twist]| twist.is_none()) {
            self.report(rule::untwisted(given.pads.span, name));
        }
        let beams = [&place, own].map(axis_of);
        self.stages.push(Stage { link: name, span: link.name.span, beams, overlap, coordinate: first, pads });
    }

    /// The overlap is within both beams.
    fn keep_overlap(&mut self, overlap: &Value, beams: [&LinkBodies; 2], name: &str, span: Span) {
        for length in beams.map(LinkBodies::length) {
            let broken = rule::overlap(span, name, self.now(overlap), self.now(&length));
            if self.now(overlap) > (1.0 + WRITTEN) * self.now(&length) {
                self.report(broken);
                return;
            }
            self.keep_below(overlap, &((1.0 + WRITTEN) * length), &broken);
        }
    }

    /// The laws of a pad; without any stiffness against twist it does not hold it.
    fn pad(&mut self, given: &'a Spanned<Pad>, what: &str) -> [Option<Law>; 3] {
        const RATE: &str = "N s/m or N m s/rad";
        let Some(pad) = &given.value else {
            // A mistake that has been reported; it may have a stiffness against twist.
            return [None, None, Some(Law::Spring(Spring::new(f64::NAN.into(), Value::ZERO)))];
        };
        let subject = format!("the stiffness of {what}");
        let limits = [(Limit::Positive, "N/m"), (Limit::Positive, "N/m"), (Limit::NotNegative, "N m/rad")];
        let stiffness: Vec<Value> = match &pad.stiffness.value {
            Some(numbers) => {
                let each = numbers.iter().zip(limits);
                each.map(|(number, (limit, unit))| self.number(number, &subject, unit, limit)).collect()
            }
            None => vec![f64::NAN.into(); 3],
        };
        let damping =
            self.vector_or_zero(pad.damping.as_ref(), &format!("the damping of {what}"), RATE, Limit::NotNegative);
        let clearance = format!("the clearance of {what}");
        let clearance = self.vector_or_zero(pad.clearance.as_ref(), &clearance, "m or rad", Limit::NotNegative);
        let mut numbers = stiffness.into_iter().zip(damping).zip(clearance);
        std::array::from_fn(|_| {
            let ((stiffness, damping), clearance) = numbers.next()?;
            if stiffness.is_zero() {
                return None;
            }
            Some(if clearance.is_zero() {
                Law::Spring(Spring::new(stiffness, damping))
            } else {
                Law::Clearance(Clearance { stiffness, damping, clearance })
            })
        })
    }

    /// The pads of all telescopes.
    pub(super) fn pads(&mut self, cylinders: &[Cylinder]) -> Vec<Force> {
        let mut forces = Vec::new();
        for Stage { link, span, beams: [outer, inner], overlap, coordinate, pads: [front, rear] } in
            std::mem::take(&mut self.stages)
        {
            let on_axis = |body, x: Value| Attachment { body: Some(body), position: [x, Value::ZERO, Value::ZERO] };
            let end = self.bodies.get(outer.last().0).map_or(Value::ZERO, |body| body.length.clone());
            let sides = [
                ("front", front, on_axis(outer.last(), end), &inner, overlap.clone(), false),
                ("rear", rear, on_axis(inner.first, Value::ZERO), &outer, outer.length.clone() - overlap, true),
            ];
            for (which, laws, pad, beam, start, grows) in sides {
                for ((direction, word), law) in DIRECTIONS.into_iter().zip(laws) {
                    let Some(law) = law else { continue };
                    let name = format!("{link}_{which}_{word}");
                    self.register_connector(&name, span, cylinders);
                    let (pad, beam, start) = (pad.clone(), beam.clone(), start.clone());
                    let sliding = Sliding { pad, beam, start, grows, coordinate, direction };
                    let strain = Strain::Sliding(Box::new(sliding));
                    forces.push(chain::Force { group: Group::Connectors, name, strain, law });
                }
            }
        }
        forces
    }
}
