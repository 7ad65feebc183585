//! Sections of beams at which forces and stresses are known: where they may be largest.
//!
//! Forces and moments jump where a force acts on a beam, the shape jumps at a step. There, a section is known on both sides; besides these
//! at both ends of the beam and where each of its elements begins.

use super::Check;
use crate::chain::{
    Axis, Beam, BodyId, Cylinder, Force, Inside, Load, LoopJoint, Moduli, Outline, PadDirection, Section, Side,
    Sliding, Strain, Value,
};
use crate::expand::beam::Distribution;

/// Places of an element that are closer to each other than this fraction of its beam are one place.
const SAME: f64 = 1e-9;

/// A place of a beam where something acts or changes.
struct Mark {
    /// Index of the element in the beam.
    element: usize,
    /// Distance from its beginning, m.
    distance: Value,
    /// What is there.
    what: String,
    /// Whether forces or the shape jump there.
    jumps: bool,
}

impl Check<'_> {
    /// Appends a beam or a rope, whose sections follow when it is known what acts on it.
    pub(super) fn push_beam(
        &mut self,
        link: &str,
        outlines: Vec<(Value, Outline)>,
        allowable_stress: Option<Value>,
        distribution: Option<Distribution>,
    ) {
        self.beams.push(Beam { link: link.to_owned(), outlines, sections: Vec::new(), allowable_stress });
        self.distributions.push(distribution);
    }

    /// Finds the sections of all beams.
    pub(super) fn beam_sections(
        &mut self,
        loads: &[Load],
        cylinders: &[Cylinder],
        connectors: &[Force],
        loop_joints: &[LoopJoint],
    ) {
        if !self.mistakes.is_empty() {
            return;
        }
        let mut pins = pins(loads, cylinders, connectors, loop_joints);
        pins.extend(self.branches());
        let mut beams = std::mem::take(&mut self.beams);
        for (beam, distribution) in beams.iter_mut().zip(std::mem::take(&mut self.distributions)) {
            beam.sections = self.sections_of(&beam.link, distribution.as_ref(), &pins);
            let of_pads = Self::at_pads(beam, distribution.as_ref(), connectors, loop_joints);
            beam.sections.extend(of_pads);
        }
        self.beams = beams;
    }

    /// The places at which other links are attached to bodies, apart from their ends.
    fn branches(&self) -> impl Iterator<Item = Pin> {
        self.bodies.iter().filter_map(|body| {
            let BodyId(parent) = body.parent?;
            let what = || format!("attachment of {}", body.link);
            let elsewhere = body.link != self.bodies[parent].link && body.along != self.bodies[parent].length;
            elsewhere.then(|| Pin { body: parent, along: body.along.clone(), what: what(), jumps: true })
        })
    }

    /// The sections of a beam at the pads on which it slides, before and after each of them.
    fn at_pads(
        beam: &Beam,
        distribution: Option<&Distribution>,
        connectors: &[Force],
        loop_joints: &[LoopJoint],
    ) -> Vec<Section> {
        let (Some(distribution), Some(last)) = (distribution, beam.sections.iter().map(|section| section.body).max())
        else {
            return Vec::new();
        };
        let springs = connectors.iter().filter_map(|connector| Some((connector.strain.sliding()?, &connector.name)));
        let springs = springs
            .filter(|(sliding, _)| sliding.direction == PadDirection::Along(Axis::Y))
            .map(|(sliding, name)| (sliding, name.trim_end_matches("_y")));
        let exact = loop_joints.iter().filter_map(|joint| Some((joint.kind.slides()?, joint.name.as_str())));
        let on_beam = springs.chain(exact).filter(|(sliding, _)| sliding.beam.last() == last);
        let section = |(sliding, name): (&Sliding, &str), side| Section {
            body: last,
            x: sliding.start.clone(),
            side,
            at: format!("pads {name}"),
            inside: None,
            slides: Some(Box::new(sliding.clone())),
            moduli: distribution.moduli(0.0)[1].clone(),
        };
        on_beam.flat_map(|pad| [Side::Before, Side::After].map(|side| section(pad, side))).collect()
    }

    fn sections_of(&self, link: &str, distribution: Option<&Distribution>, pins: &[Pin]) -> Vec<Section> {
        let Some(link_place) = self.links.get(link) else { return Vec::new() };
        let elements = Elements { check: self, first: link_place.first, starts: &link_place.starts };
        let Some(distribution) = distribution else {
            let begins = |element| elements.beginning(element, Side::Both, String::new(), None);
            return (0..link_place.starts.len()).map(begins).collect();
        };
        let marks = elements.marks(distribution, pins);
        let mut sections = Vec::new();
        // What is at the end of the element before.
        let mut before = String::new();
        for element in 0..link_place.starts.len() {
            let in_element: Vec<&Mark> = marks.iter().filter(|mark| mark.element == element).collect();
            let same_place = |a: &&Mark, b: &&Mark| elements.same(&a.distance, &b.distance);
            let mut groups: Vec<&[&Mark]> = in_element.chunk_by(same_place).collect();
            let at_beginning = groups.first().is_some_and(|group| elements.same(&group[0].distance, &Value::ZERO));
            let at_its_beginning: &[&Mark] = if at_beginning { groups.remove(0) } else { &[] };
            let here = words(at_its_beginning);
            let x = self.now(&elements.starts[element]);
            let [_, moduli] = distribution.moduli(x);
            let (side, at) = match (at_its_beginning.iter().any(|mark| mark.jumps), before.is_empty()) {
                (true, _) => (Side::Before, here.clone()),
                (false, true) => (Side::Both, here.clone()),
                (false, false) => (Side::After, std::mem::take(&mut before)),
            };
            sections.push(elements.beginning(element, side, at, moduli.clone()));
            if side == Side::Before {
                sections.push(elements.inside(distribution, (element, &Value::ZERO), Side::After, here, moduli));
            }
            before.clear();
            for group in groups {
                let distance = &group[0].distance;
                let moduli = distribution.moduli(x + self.now(distance));
                let [one, other] = &moduli;
                let at = words(group);
                let mut add = |side, moduli: &Option<_>| {
                    let section = elements.inside(distribution, (element, distance), side, at.clone(), moduli.clone());
                    sections.push(section);
                };
                if !group.iter().any(|mark| mark.jumps) {
                    add(Side::Both, one);
                    continue;
                }
                add(Side::Before, one);
                if element + 1 < link_place.starts.len() && elements.same(distance, elements.length(element)) {
                    before.clone_from(&at);
                } else {
                    add(Side::After, other);
                }
            }
        }
        sections
    }
}

/// A place where a force acts on a body.
struct Pin {
    body: usize,
    /// Position along the body, m.
    along: Value,
    what: String,
    /// Whether forces jump there.
    jumps: bool,
}

/// All places where forces act on bodies.
fn pins(loads: &[Load], cylinders: &[Cylinder], connectors: &[Force], loop_joints: &[LoopJoint]) -> Vec<Pin> {
    let pin = |BodyId(body): BodyId, position: &[Value; 3], what: String| Pin {
        body,
        along: position[0].clone(),
        what,
        jumps: true,
    };
    let mut pins: Vec<Pin> = Vec::new();
    pins.extend(loads.iter().map(|load| pin(load.body, &load.position, format!("load {}", load.name))));
    for cylinder in cylinders.iter().filter(|cylinder| cylinder.valve.is_some()) {
        for (end, what) in cylinder.pins().zip(["foot", "head", "pivot"]) {
            pins.push(pin(end.body, &end.position, format!("{what} of {}", cylinder.name)));
        }
    }
    for connector in connectors {
        if let Some(Sliding { pad, direction: PadDirection::Along(Axis::Y), .. }) = connector.strain.sliding() {
            let what = format!("pads {}", connector.name.trim_end_matches("_y"));
            pins.extend(pad.body.map(|body| pin(body, &pad.position, what)));
        }
        if let Strain::Depth { point, .. } = &connector.strain {
            pins.extend(point.body.map(|body| pin(body, &point.position, format!("contact {}", connector.name))));
        }
        let points = connector.strain.line().map_or(&[][..], |line| &line.points);
        for (index, end) in points.iter().enumerate() {
            let what = if index == 0 || index + 1 == points.len() { "attachment" } else { "sheave" };
            pins.extend(end.body.map(|body| pin(body, &end.position, format!("{what} of {}", connector.name))));
        }
    }
    for joint in loop_joints {
        if let Some(sliding) = joint.kind.slides() {
            let what = format!("pads {}", joint.name);
            pins.extend(sliding.pad.body.map(|body| pin(body, &sliding.pad.position, what)));
            continue;
        }
        for end in &joint.ends {
            pins.extend(end.body.map(|body| pin(body, &end.position, format!("joint {}", joint.name))));
        }
    }
    pins
}

/// All that is at one place.
fn words(group: &[&Mark]) -> String {
    let named = group.iter().map(|mark| mark.what.as_str()).filter(|what| !what.is_empty());
    named.collect::<Vec<_>>().join(" and ")
}

/// The elements of a beam.
struct Elements<'c, 'a> {
    check: &'c Check<'a>,
    /// Index of the first body.
    first: usize,
    starts: &'c [Value],
}

impl Elements<'_, '_> {
    fn length(&self, element: usize) -> &Value {
        &self.check.bodies[self.first + element].length
    }

    fn same(&self, one: &Value, other: &Value) -> bool {
        let last = self.starts.len() - 1;
        let whole = self.check.now(&self.starts[last]) + self.check.now(self.length(last));
        (self.check.now(one) - self.check.now(other)).abs() <= SAME * whole
    }

    /// All marks of the beam, from its beginning to its end.
    fn marks(&self, distribution: &Distribution, pins: &[Pin]) -> Vec<Mark> {
        let now = |value: &Value| self.check.now(value);
        let last = self.starts.len() - 1;
        let mark = |element, distance, what: String, jumps| Mark { element, distance, what, jumps };
        let mut marks = vec![mark(last, self.length(last).clone(), "end".to_owned(), false)];
        for (part, x) in distribution.steps().into_iter().enumerate() {
            // At a spring, a step is at the end of the element before.
            let begins_before = |start: &Value| now(start) < x && !self.same(start, &x.into());
            let element = self.starts.iter().rposition(begins_before).unwrap_or(0);
            let distance = Value::from(x) - self.starts[element].clone();
            marks.push(mark(element, distance, format!("beginning of part {}", part + 2), true));
        }
        for pin in pins {
            let Some(element) = pin.body.checked_sub(self.first).filter(|element| *element <= last) else { continue };
            // What is beside the element acts on its end.
            let length = self.length(element);
            let distance = if now(&pin.along) <= 0.0 {
                Value::ZERO
            } else if now(&pin.along) >= now(length) {
                length.clone()
            } else {
                pin.along.clone()
            };
            marks.push(mark(element, distance, pin.what.clone(), pin.jumps));
        }
        marks.sort_by(|a, b| a.element.cmp(&b.element).then(now(&a.distance).total_cmp(&now(&b.distance))));
        marks
    }

    fn beginning(&self, element: usize, side: Side, at: String, moduli: Option<Moduli>) -> Section {
        let (body, x) = (BodyId(self.first + element), self.starts[element].clone());
        Section { body, x, side, at, inside: None, slides: None, moduli }
    }

    fn inside(
        &self,
        distribution: &Distribution,
        (element, distance): (usize, &Value),
        side: Side,
        at: String,
        moduli: Option<Moduli>,
    ) -> Section {
        let start = &self.starts[element];
        let beyond = distribution.beyond([start, self.length(element), distance], |value| self.check.now(value));
        let inside = Inside { distance: distance.clone(), beyond };
        Section {
            inside: Some(inside),
            x: start.clone() + distance.clone(),
            ..self.beginning(element, side, at, moduli)
        }
    }
}
