//! Beams: division into sections, and conversion of elements into bodies.

use super::elements::WRITTEN;
use super::on::Attached;
use super::plausibility::rounded;
use super::section::Elastic;
use super::{Carried, Check, Owner};
use crate::chain::{self, Axis, Chain, CoordinateKind, Division, Force, Group, Law, Outline, Spring, Step, Value};
use crate::diagnostic::{Span, rule};
use crate::expand::beam::{self, Distribution, DividedBeam, Joint, RigidElement, TaperedPart};
use crate::spec::{Beam, BeamDamping, BeamPart, Bend, Directions, Either, Number, SectionJoint, Sections, Spanned};

/// Maximum number of sections of a beam.
const MOST_SECTIONS: f64 = 1000.0;
/// Default factor between the yield stress and the allowable stress.
const SAFETY_FACTOR: f64 = 1.5;
/// Greatest usual ratio of the additional mass of a beam to that of its section.
const HEAVY: f64 = 20.0;
/// Advice for a beam with too many sections.
const FEWER_SECTIONS: &str =
    "divide beams into fewer sections: the error falls with the square of their number, and 4 to 20 are common";
/// Rotations of an element after the first, in order.
const ROTATIONS: [Axis; 3] = [Axis::Z, Axis::Y, Axis::X];

impl<'a> Check<'a> {
    /// Appends the elements of a beam.
    pub(super) fn beam(&mut self, given: &'a Spanned<Beam>, link: &str, span: Span, attached: Attached) -> Carried {
        let elements = given.value.as_ref().and_then(|inside| {
            let length = self.number(&inside.length, "`length`");
            match &inside.elements {
                Some(elements) => {
                    self.push_beam(link, Vec::new(), None, None);
                    self.one_by_one(inside, &length, elements)
                }
                None => self.in_sections(inside, (link, given.span), &length),
            }
        });
        let count = |elements: &DividedBeam| self.coordinates.len() + ROTATIONS.len() * elements.joints.len();
        let total = elements.as_ref().map_or(0, count);
        if total > Chain::MOST_COORDINATES {
            self.report(rule::too_many(
                given.span,
                format!("beam `{link}`"),
                total,
                Chain::MOST_COORDINATES,
                FEWER_SECTIONS,
            ));
        }
        let section_joint = given.value.as_ref().and_then(|inside| inside.section_joint.as_ref()?.value);
        let Some(elements) = elements.filter(|_| total <= Chain::MOST_COORDINATES) else {
            // The beam's coordinates are not known.
            self.unknown.links = true;
            return Carried::default();
        };
        let section_joint = section_joint.unwrap_or(SectionJoint::Symmetric);
        self.unroll((link, span), attached, elements, section_joint)
    }

    /// Appends rigid elements as bodies: element 0 on the link's joint, element i ≥ 1 at the end of the previous one,
    /// rotated by the rotation vector (φ, θ, ψ) or by `Rz(ψ) Ry(θ) Rx(φ)`. In a curved beam, half the angle of a section is before the
    /// spring and half after it, so that its axes are those of the middle of the section.
    fn unroll(
        &mut self,
        (link, span): (&str, Span),
        mut attached: Attached,
        DividedBeam { elements, joints, division }: DividedBeam,
        section_joint: SectionJoint,
    ) -> Carried {
        let rigid = joints.is_empty();
        let mut starts = Vec::new();
        let mut start = Value::ZERO;
        let mut joints = joints.into_iter();
        let mut tip = Value::ZERO;
        for (index, RigidElement { length, inertia }) in elements.into_iter().enumerate() {
            let name = if rigid { link.to_owned() } else { format!("{link}_{index}") };
            if index > 0 {
                attached = self.on_the_last_body(tip);
            }
            let path = &mut attached.path;
            if let Some(joint) = (index > 0).then(|| joints.next()).flatten() {
                let mut rotation = |axis| {
                    let owner = Owner::Beam(link.to_owned());
                    self.push_coordinate((link, &name), CoordinateKind::Rotation, axis, owner, span)
                };
                let ids = ROTATIONS.map(&mut rotation);
                path.extend(joint.half_bend.iter().cloned());
                match section_joint {
                    SectionJoint::Symmetric => path.push(Step::RotationVector(ids)),
                    SectionJoint::Paper => path.extend(ids.map(Step::Move)),
                }
                path.extend(joint.half_bend);
                for (id, (stiffness, damping)) in ids.into_iter().zip(joint.stiffness.into_iter().zip(joint.damping)) {
                    let law = Law::Spring(Spring::new(stiffness, damping));
                    self.element_springs.push(Force::on(&self.coordinates, Group::Elements, id, law));
                }
            }
            let Attached { parent, along, path } = std::mem::take(&mut attached);
            let body = chain::Body {
                name,
                link: link.to_owned(),
                parent,
                along,
                path,
                inertia: Some(inertia),
                parts: Vec::new(),
                length: length.clone(),
            };
            self.push_body(body, span);
            starts.push(start.clone());
            start = start + length.clone();
            tip = length;
        }
        Carried { starts, tip, division }
    }

    /// A beam of sections of one material, with one cross-section or with parts.
    fn in_sections(&mut self, beam: &'a Beam, (link, span): (&str, Span), length: &Value) -> Option<DividedBeam> {
        if let Some(springs) = &beam.springs {
            self.report(rule::missing_key(springs.span, "elements", "a beam with `springs`"));
        }
        let required = [
            ("sections", beam.sections.is_none()),
            ("material", beam.material.is_none()),
            ("section", beam.section.is_none() && beam.parts.is_none()),
        ];
        for (key, _) in required.iter().filter(|(_, missing)| *missing && beam.springs.is_none()) {
            self.report(rule::missing_key(span, key, "the beam"));
        }
        if let (Some(_), Some(parts)) = (&beam.section, &beam.parts) {
            self.report(rule::section_and_parts(parts.span));
        }
        let sections = beam.sections.as_ref().and_then(|sections| self.sections(sections));
        let material = beam.material.as_ref().and_then(|material| self.material(material));
        let section = beam.section.as_ref().and_then(|section| self.shape(section)).map(|shape| shape.section());
        let parts = beam.parts.as_ref().and_then(|parts| self.parts(parts, &beam.length, length));
        let extra = self.number_or(beam.extra_mass.as_ref(), 0.0, "`extra_mass`");
        let damping = self.beam_damping(beam.damping.as_ref());
        let safety = self.number_or(beam.safety_factor.as_ref(), SAFETY_FACTOR, "`safety_factor`");
        let bend = self.bend(beam.bend.as_ref(), sections);
        let (Elastic { youngs, shear, density, yield_stress }, sections) = (material?, sections?);
        let stations = self.stations.get(link).cloned().unwrap_or_default();
        let stations = if parts.is_some() { stations.iter().map(|x| self.now(x).into()).collect() } else { stations };
        let division = beam::division(length, sections, stations, |value| self.now(value));
        self.keep_sections(&division, span);
        let lengths = beam::element_lengths(length, &division);
        let divided = match (section, parts) {
            (Some(section), None) => {
                let own = density * section.area.clone();
                if let Some(given) = beam.extra_mass.as_ref().filter(|_| self.now(&extra) > HEAVY * self.now(&own)) {
                    let [extra, own] = [&extra, &own].map(|mass| rounded(self.now(mass)));
                    self.warnings.push(rule::heavy_extra(given.span, extra, own));
                }
                let line_density = own + extra;
                let element = |length| beam::prismatic(length, &line_density, &section);
                Divided {
                    outlines: section.outline.iter().map(|outline| (Value::ZERO, outline.clone())).collect(),
                    elements: lengths.into_iter().map(element).collect(),
                    stiffness: division.each().map(|(_, d)| beam::stiffness(&youngs, &shear, &section, d)).collect(),
                    distribution: Distribution::Prismatic { line_density, section: Box::new(section) },
                }
            }
            (None, Some(parts)) => {
                let mut begin = 0.0;
                let ends: Vec<[f64; 2]> = lengths
                    .iter()
                    .map(|length| {
                        let ends = [begin, begin + self.now(length)];
                        begin = ends[1];
                        ends
                    })
                    .collect();
                let element = |ends: &[f64; 2]| beam::element_of_parts(&parts, *ends, &density, &extra);
                let stiffness = division.stretches.iter().flat_map(|stretch| {
                    let ends = |k: usize| [k, k + 1].map(|k| self.now(&stretch.at(k as f64)));
                    let spring = |k| beam::stiffness_of_parts(&parts, ends(k), &youngs, &shear);
                    (0..stretch.sections).map(spring).collect::<Vec<_>>()
                });
                Divided {
                    outlines: beam::outlines_of_parts(&parts),
                    elements: ends.iter().map(element).collect(),
                    stiffness: stiffness.collect(),
                    distribution: Distribution::Parts { parts, density, extra },
                }
            }
            _ => return None,
        };
        let allowable = yield_stress.map(|stress| stress / safety);
        self.push_beam(link, divided.outlines, allowable, Some(divided.distribution));
        // What is given for a beam of equal sections, in a section of length d.
        let equal = length.clone() / (sections.max(1) as f64).into();
        let joint = |(stiffness, (_, d)): ([Value; 3], (Value, &Value))| Joint {
            damping: damping
                .coefficients(&stiffness, || if *d == equal { Value::ONE } else { equal.clone() / d.clone() }),
            stiffness,
            half_bend: bend.half_of(length, d, sections),
        };
        let joints = divided.stiffness.into_iter().zip(division.each()).map(joint).collect();
        Some(DividedBeam { elements: divided.elements, joints, division })
    }

    /// Live places stay between their neighbours.
    fn keep_sections(&mut self, division: &Division, span: Span) {
        for stretch in &division.stretches {
            self.keep_positive(stretch.section.clone(), &rule::places_meet(span));
        }
    }

    /// Parts with sections of their own.
    fn parts(
        &mut self,
        given: &'a Spanned<Vec<Spanned<BeamPart>>>,
        written: &Spanned<Number>,
        length: &Value,
    ) -> Option<Vec<TaperedPart>> {
        let whole = length.as_constant();
        if whole.is_none() {
            self.report(rule::live_part(written.span, "the length of a beam with `parts`"));
        }
        let parts: Vec<Option<TaperedPart>> =
            given.value.as_ref()?.iter().map(|part| self.part(part.value.as_ref()?)).collect();
        let parts = parts.into_iter().collect::<Option<Vec<_>>>()?;
        let sum: f64 = parts.iter().map(|part| part.length).sum();
        let whole = whole?;
        if (sum - whole).abs() > WRITTEN * whole || parts.is_empty() {
            self.report(rule::parts_length(given.span, (sum * 1e9).round() / 1e9, whole));
            return None;
        }
        Some(parts)
    }

    /// A part of a beam.
    fn part(&mut self, part: &'a BeamPart) -> Option<TaperedPart> {
        let length = self.number(&part.length, "`length`");
        if length.as_constant().is_none() {
            self.report(rule::live_part(part.length.span, "the length of a part"));
        }
        let from = self.shape(&part.section);
        let to = part.to.as_ref().map(|to| (to, self.shape(to)));
        let from = from?;
        let to = match to {
            None => None,
            Some((section, to)) => {
                let to = to?;
                if from.between(&to, 0.5).is_none() {
                    self.report(rule::taper(section.span, from.name(), to.name()));
                    return None;
                }
                Some(to)
            }
        };
        Some(TaperedPart { length: length.as_constant()?, from, to })
    }

    /// How a beam is curved; straight by default.
    fn bend(&mut self, given: Option<&'a Spanned<Bend>>, sections: Option<usize>) -> Curvature {
        let Some(bend) = given.and_then(|given| given.value.as_ref()) else { return Curvature::default() };
        if let (Some(given), Some(0)) = (given, sections) {
            self.report(rule::bent_in_one_piece(given.span));
        }
        let angles = [(&bend.theta, "`theta`"), (&bend.psi, "`psi`")];
        Curvature(Some(
            angles.map(|(angle, subject)| angle.as_ref().map_or(Value::ZERO, |angle| self.number(angle, subject))),
        ))
    }

    /// Number of sections; 0 for a rigid beam.
    fn sections(&mut self, given: &Spanned<Sections>) -> Option<usize> {
        match given.value? {
            Sections::Rigid => Some(0),
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // an integer from 1 to 1000
            Sections::Count(count) if (1.0..=MOST_SECTIONS).contains(&count) && count.fract() == 0.0 => {
                Some(count as usize)
            }
            Sections::Count(count) => {
                self.report(rule::sections(given.span, count));
                None
            }
        }
    }

    /// Damping of a beam with equal sections.
    fn beam_damping(&mut self, given: Option<&Spanned<BeamDamping>>) -> Damping {
        let none = || [Value::ZERO; 3];
        match given.and_then(|beam_damping| beam_damping.value.as_ref()) {
            None => Damping::Coefficients(none()),
            Some(BeamDamping::Coefficients(each)) => Damping::Coefficients(self.directions(each, "the damping")),
            Some(BeamDamping::Beta(beta)) => Damping::Beta(match &beta.value {
                None => none(),
                Some(Either::Full(each)) => self.directions(each, "`beta`"),
                Some(Either::Short(number)) => {
                    let beta = Spanned { value: Some(number.clone()), span: beta.span };
                    let beta = self.number(&beta, "`beta`");
                    [beta.clone(), beta.clone(), beta]
                }
            }),
        }
    }

    /// One number per direction.
    pub(super) fn directions(&mut self, each: &Directions, subject: &str) -> [Value; 3] {
        [&each.psi, &each.theta, &each.phi].map(|number| self.number(number, subject))
    }
}

/// A beam divided into elements.
struct Divided {
    /// Outlines along the beam.
    outlines: Vec<(Value, Outline)>,
    elements: Vec<RigidElement>,
    /// Stiffness of the springs, N m/rad.
    stiffness: Vec<[Value; 3]>,
    /// What it consists of.
    distribution: Distribution,
}

/// The angles θ and ψ between the beginning and the end of a curved beam, rad.
#[derive(Default)]
struct Curvature(Option<[Value; 2]>);

impl Curvature {
    /// Rotation by half the angle of a section of length d, a share d/l of the whole: the rotation vector (0, θ/2, ψ/2) of that share.
    fn half_of(&self, length: &Value, d: &Value, sections: usize) -> Vec<Step> {
        let Some(angles) = &self.0 else { return Vec::new() };
        let equal = Value::from(sections.max(1) as f64);
        let [theta, psi] = angles.clone().map(|angle| {
            if *d == length.clone() / equal.clone() {
                angle / (2.0 * equal.clone())
            } else {
                0.5 * angle * d.clone() / length.clone()
            }
        });
        beam::rotation_across(theta, psi)
    }
}

/// Damping of a beam's springs.
enum Damping {
    /// Proportional to stiffness, s.
    Beta([Value; 3]),
    /// Given directly for equal sections, N m s/rad.
    Coefficients([Value; 3]),
}

impl Damping {
    /// Coefficients for springs of the given stiffness, `d = β s`; those given directly times how much shorter their section is than equal ones.
    fn coefficients(&self, stiffness: &[Value; 3], shorter: impl Fn() -> Value) -> [Value; 3] {
        match self {
            Damping::Coefficients(coefficients) => coefficients.clone().map(|given| given * shorter()),
            Damping::Beta(beta) => std::array::from_fn(|k| beta[k].clone() * stiffness[k].clone()),
        }
    }
}
