//! Beams given element by element.

use super::Check;
use crate::chain::{Division, Value};
use crate::diagnostic::rule;
use crate::expand::beam::{DividedBeam, Joint, RigidElement};
use crate::spec::{Beam, Directions, Element, Spanned, Spring};

/// The lengths of elements or parts may differ in sum from that of their beam by this fraction, because lengths are decimal numbers.
pub(super) const WRITTEN: f64 = 1e-9;

impl<'a> Check<'a> {
    /// A beam of elements and springs given one by one.
    pub(super) fn one_by_one(
        &mut self,
        beam: &'a Beam,
        length: &Value,
        elements: &Spanned<Vec<Spanned<Element>>>,
    ) -> Option<DividedBeam> {
        let beside = [
            ("sections", beam.sections.as_ref().map(|given| given.span)),
            ("material", beam.material.as_ref().map(|given| given.span)),
            ("section", beam.section.as_ref().map(|given| given.span)),
            ("parts", beam.parts.as_ref().map(|given| given.span)),
            ("bend", beam.bend.as_ref().map(|given| given.span)),
            ("extra_mass", beam.extra_mass.as_ref().map(|given| given.span)),
            ("safety_factor", beam.safety_factor.as_ref().map(|given| given.span)),
            ("damping", beam.damping.as_ref().map(|beam_damping| beam_damping.span)),
        ];
        for (key, span) in beside {
            if let Some(span) = span {
                self.report(rule::two_beams(span, key));
            }
        }
        if beam.springs.is_none() {
            self.report(rule::missing_key(elements.span, "springs", "a beam with `elements`"));
        }
        let (rigid, joints) = (elements.value.as_ref()?, beam.springs.as_ref()?.value.as_ref()?);
        if rigid.len() != joints.len() + 1 || joints.is_empty() {
            self.report(rule::springs(elements.span, rigid.len(), joints.len()));
        }
        let rigid: Vec<_> = rigid.iter().map(|element| self.element(element.value.as_ref()?)).collect();
        let joints: Vec<_> = joints.iter().map(|spring| Some(self.spring(spring.value.as_ref()?))).collect();
        let (elements_read, joints) =
            (rigid.into_iter().collect::<Option<Vec<_>>>()?, joints.into_iter().collect::<Option<Vec<_>>>()?);
        let sum: f64 = elements_read.iter().map(|element| self.now(&element.length)).sum();
        let whole = self.now(length);
        if (sum - whole).abs() > WRITTEN * whole {
            self.report(rule::beam_length(elements.span, sum, whole));
        }
        let sum = elements_read.iter().fold(Value::ZERO, |sum, element| sum + element.length.clone());
        let broken = rule::beam_length(elements.span, whole, whole);
        self.keep_below(&sum, &((1.0 + WRITTEN) * length.clone()), &broken);
        self.keep_below(&((1.0 - WRITTEN) * length.clone()), &sum, &broken);
        (elements_read.len() == joints.len() + 1).then_some(DividedBeam {
            elements: elements_read,
            joints,
            division: Division::default(),
        })
    }

    /// A rigid element as given.
    fn element(&mut self, element: &Element) -> Option<RigidElement> {
        let length = self.number(&element.length, "`length`");
        let lump = self.inertia(&element.mass, Some(&element.com), Some(&element.inertia), "the element")?;
        lump.judgement.into_iter().for_each(|judgement| self.accept(judgement));
        Some(RigidElement { length, inertia: lump.inertia })
    }

    /// A spring as given.
    fn spring(&mut self, spring: &Spring) -> Joint {
        let mut each = |given: Option<&Spanned<Directions>>, subject| match given.map(|given| given.value.as_ref()) {
            Some(Some(each)) => self.directions(each, subject),
            _ => [Value::ZERO; 3],
        };
        Joint {
            stiffness: each(Some(&spring.stiffness), "the stiffness"),
            damping: each(spring.damping.as_ref(), "the damping"),
            half_bend: Vec::new(),
        }
    }
}
