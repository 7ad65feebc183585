//! Telescopes: beams that slide in beams on two pads.

use super::inertias::rounded;
use super::on::Attached;
use super::{Check, LinkBodies, Owner};
use crate::chain::{
    self, Attachment, Axis, BeamAxis, Clearance, CoordinateId, CoordinateKind, Cylinder, Force, Group, Law, LoopJoint,
    LoopJointKind, PadDirection, Sliding, Spring, Step, Strain, Value, twist_springs,
};
use crate::diagnostic::{Span, rule};
use crate::node::Limit;
use crate::spec::{AxisName, Beam, ExactDirection, Joint, Link, Pad, Spanned, Vector};

/// An overlap may exceed a beam by this fraction of its length, because both are decimal numbers.
const WRITTEN: f64 = 1e-9;

/// The least compliance of a section beside an exact pad against twist, as a share of that of the whole section: where the pad is within 2 % of an end
/// of a section. Without it, the pad would become a spring without bound there.
const LEAST_BESIDE: f64 = 0.02;

/// Motions of the inner beam besides that of its joint, which the pads hold.
const HELD: [(CoordinateKind, Axis); 5] = [
    (CoordinateKind::Translation, Axis::Y),
    (CoordinateKind::Translation, Axis::Z),
    (CoordinateKind::Rotation, Axis::Z),
    (CoordinateKind::Rotation, Axis::Y),
    (CoordinateKind::Rotation, Axis::X),
];

/// The directions in which pads hold, and the words for them in specs and names.
const DIRECTIONS: [(PadDirection, ExactDirection, &str); 3] = [
    (PadDirection::Along(Axis::Y), ExactDirection::Y, "y"),
    (PadDirection::Along(Axis::Z), ExactDirection::Z, "z"),
    (PadDirection::Twist, ExactDirection::Twist, "twist"),
];

/// How a pad holds a beam in a direction.
#[derive(Clone, Debug)]
enum Hold {
    /// Not at all, against twist.
    No,
    With(Law),
    Exactly,
}

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
    /// Front and rear, in each direction.
    pads: [[Hold; 3]; 2],
}

/// The outer beam of a stage and the place of the inner one in it.
#[derive(Clone, Debug)]
pub(super) struct Outer {
    place: LinkBodies,
    overlap: Value,
}

/// The axis of a beam; `None` if a mistake left it without bodies.
fn axis_of(bodies: &LinkBodies) -> Option<BeamAxis> {
    Some(BeamAxis { first: bodies.first()?, division: bodies.division.clone(), length: bodies.length() })
}

/// The key of a beam that is not straight and divided into sections, if it has one.
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
        let given = link.slides_in()?.value.as_ref()?;
        self.joint_of_slider(link, name);
        let outer_name = given.beam.value.as_deref()?;
        let place = self.earlier_link(links, index, (outer_name, given.beam.span)).cloned();
        let overlap = self.number(&given.overlap, &format!("the overlap of `{name}`"));
        let named =
            |link: &&Spanned<Link>| link.value.as_ref().and_then(|link| link.name.value.as_deref()) == Some(outer_name);
        let outer = links[..index].iter().find(named).and_then(|link| link.value.as_ref());
        let (bodies, outer) = (place?, outer?);
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
        let behind = bodies.length() - overlap.clone();
        let start = [behind, Value::ZERO, Value::ZERO];
        Some((Attached::at(bodies.first(), Value::ZERO, start), Outer { place: bodies, overlap }))
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
        if link.slides_in().is_none() || !slides_along_x(link) {
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
        let Some(given) = link.slides_in().and_then(|given| given.value.as_ref()) else { return };
        let name = link.name.value.as_deref().unwrap_or_default();
        let pads = given.pads.value.as_ref().map(|pads| {
            [(&pads.front, "front"), (&pads.rear, "rear")]
                .map(|(pad, which)| self.pad(pad, &format!("the {which} pad of `{name}`")))
        });
        let (Some(Outer { place: bodies, overlap }), Some(pads)) = (outer, pads) else { return };
        let [Some(outer), Some(inner)] = [&bodies, own].map(axis_of) else { return };
        self.keep_overlap(&overlap, [&bodies, own], name, given.overlap.span);
        if pads.iter().all(|[.., twist]| matches!(twist, Hold::No)) {
            self.report(rule::untwisted(given.pads.span, name));
        }
        self.stages.push(Stage {
            link: name,
            span: link.name.span,
            beams: [outer, inner],
            overlap,
            coordinate: first,
            pads,
        });
    }

    /// The overlap is within both beams.
    fn keep_overlap(&mut self, overlap: &Value, beams: [&LinkBodies; 2], name: &str, span: Span) {
        for length in beams.map(LinkBodies::length) {
            let broken = rule::overlap(span, name, self.now(overlap), rounded(self.now(&length)));
            if self.now(overlap) > (1.0 + WRITTEN) * self.now(&length) {
                self.report(broken);
                return;
            }
            self.keep_below(overlap, &((1.0 + WRITTEN) * length), &broken);
        }
    }

    /// How a pad holds; without any stiffness against twist it does not hold it.
    fn pad(&mut self, given: &'a Spanned<Pad>, what: &str) -> [Hold; 3] {
        let Some(pad) = &given.value else {
            // A mistake that has been reported; it may hold against twist.
            return [Hold::No, Hold::No, Hold::Exactly];
        };
        let exact = pad.exact.as_ref().map_or(&[][..], |list| list.value.as_deref().unwrap_or_default());
        let exact = DIRECTIONS.map(|(_, own, _)| exact.iter().any(|item| item.value == Some(own)));
        let subject = format!("the stiffness of {what}");
        let limits = [Limit::Positive, Limit::Positive, Limit::NotNegative];
        let stiffness: Vec<Value> = match pad.stiffness.as_ref().map(|stiffness| &stiffness.value) {
            Some(Some(numbers)) => {
                let each = numbers.iter().zip(limits).zip(exact);
                let each = each.map(|((number, limit), exact)| {
                    self.number_within(number, if exact { Limit::NotNegative } else { limit }, &subject)
                });
                each.collect()
            }
            Some(None) => vec![f64::NAN.into(); 3],
            None => vec![Value::ZERO; 3],
        };
        // A list with a mistake may have had the direction.
        let is_read = pad
            .exact
            .as_ref()
            .is_none_or(|list| list.value.as_ref().is_some_and(|list| list.iter().all(|item| item.value.is_some())));
        if pad.stiffness.is_none() && is_read {
            let loose = exact.into_iter().zip(DIRECTIONS).take(2).filter(|(exact, _)| !exact);
            let loose: Vec<&str> = loose.map(|(_, (.., word))| word).collect();
            if !loose.is_empty() {
                self.report(rule::loose_pad(given.span, what, loose.join(" and ")));
            }
        }
        let damping = self.vector_or_zero(pad.damping.as_ref(), &format!("the damping of {what}"));
        let clearance = self.vector_or_zero(pad.clearance.as_ref(), &format!("the clearance of {what}"));
        let stiffness: [Value; 3] = std::array::from_fn(|i| stiffness[i].clone());
        self.keep_exact("stiffness", pad.stiffness.as_ref(), (&stiffness, exact), what);
        self.keep_exact("damping", pad.damping.as_ref(), (&damping, exact), what);
        self.keep_exact("clearance", pad.clearance.as_ref(), (&clearance, exact), what);
        let mut numbers = exact.into_iter().zip(stiffness).zip(damping).zip(clearance);
        std::array::from_fn(|_| match numbers.next() {
            Some((((true, _), _), _)) => Hold::Exactly,
            Some((((false, stiffness), damping), clearance)) if !stiffness.is_zero() => {
                Hold::With(if clearance.is_zero() {
                    Law::Spring(Spring::new(stiffness, damping))
                } else {
                    Law::Clearance(Clearance { stiffness, damping, clearance })
                })
            }
            _ => Hold::No,
        })
    }

    /// What is exact has neither stiffness nor damping nor clearance.
    fn keep_exact(
        &mut self,
        key: &str,
        given: Option<&Spanned<Vector>>,
        (values, exact): (&[Value; 3], [bool; 3]),
        what: &str,
    ) {
        let numbers = given.and_then(|given| given.value.as_ref()).into_iter().flatten();
        for (((number, value), exact), (.., word)) in numbers.zip(values).zip(exact).zip(DIRECTIONS) {
            if exact && !value.is_zero() && !self.now(value).is_nan() {
                self.report(rule::exact_spring(number.span, what, word, key));
            }
        }
    }

    /// The spring of an exact pad against twist on a beam that can twist: the stiffest section's, over the least compliance of a section beside a pad.
    fn twist_beside(&self, springs: &[Force], beam: &BeamAxis) -> Option<Law> {
        let now = |spring: &&Spring| self.now(&spring.stiffness);
        let springs = twist_springs(springs, &self.coordinates, beam);
        let Spring { stiffness, damping, .. } = springs.max_by(|one, other| now(one).total_cmp(&now(other)))?;
        let [stiffness, damping] = [stiffness, damping].map(|number| (1.0 / LEAST_BESIDE) * number.clone());
        Some(Law::Spring(Spring::new(stiffness, damping)))
    }

    /// The pads of all telescopes: forces, and joints of those that are exact.
    pub(super) fn pads(&mut self, cylinders: &[Cylinder], springs: &[Force]) -> (Vec<Force>, Vec<LoopJoint>) {
        let (mut forces, mut joints) = (Vec::new(), Vec::new());
        for Stage { link, span, beams: [outer, inner], overlap, coordinate, pads: [front, rear] } in
            std::mem::take(&mut self.stages)
        {
            let on_axis = |body, x: Value| Attachment { body: Some(body), position: [x, Value::ZERO, Value::ZERO] };
            let end = self.bodies[outer.last().0].length.clone();
            let sides = [
                ("front", front, on_axis(outer.last(), end), &inner, overlap.clone(), false),
                ("rear", rear, on_axis(inner.first, Value::ZERO), &outer, outer.length.clone() - overlap, true),
            ];
            for (which, holds, pad, beam, start, grows) in sides {
                let mut held = Vec::new();
                for ((direction, _, word), hold) in DIRECTIONS.into_iter().zip(holds) {
                    let (of_pad, beam, start) = (pad.clone(), beam.clone(), start.clone());
                    let exact = matches!(hold, Hold::Exactly);
                    let law = match hold {
                        Hold::No => continue,
                        Hold::With(law) => Some(law),
                        Hold::Exactly => Some(&beam)
                            .filter(|_| direction == PadDirection::Twist)
                            .and_then(|beam| self.twist_beside(springs, beam)),
                    };
                    let sliding = Sliding { pad: of_pad, beam, start, grows, coordinate, direction, exact };
                    match law {
                        None => held.push(sliding),
                        Some(law) => {
                            let name = format!("{link}_{which}_{word}");
                            self.register_connector(&name, span, cylinders);
                            let strain = Strain::Sliding(Box::new(sliding));
                            forces.push(chain::Force { group: Group::Connectors, name, strain, law });
                        }
                    }
                }
                if !held.is_empty() {
                    let name = format!("{link}_{which}");
                    self.register_loop_joint(&name, span, cylinders);
                    let ends = [pad, on_axis(beam.first, Value::ZERO)];
                    joints.push(LoopJoint { name, ends, kind: LoopJointKind::Pad { held } });
                }
            }
        }
        (forces, joints)
    }
}
