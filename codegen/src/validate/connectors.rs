//! Connectors: elements between two points, and couplings of coordinates.

use super::Check;
use super::drives::{Units, units};
use super::limits::Limit;
use crate::chain::{
    self, Attachment, Chain, CoordinateKind, Cylinder, Force, Group, Law, Profile, Rope, Spring, Strain, Value,
};
use crate::diagnostic::{Span, rule};
use crate::spec::{self, Crane, Number, Spanned};

impl<'a> Check<'a> {
    pub(super) fn connectors(&mut self, crane: &'a Crane, cylinders: &[Cylinder]) -> Vec<Force> {
        let given = crane.connectors.as_ref().and_then(|connectors| connectors.value.as_deref()).unwrap_or_default();
        let mut connectors = Vec::new();
        for connector in given.iter().filter_map(|connector| connector.value.as_ref()) {
            let name = self.name(&connector.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_connector(&name, connector.name.span, cylinders);
            }
            let [from, to] =
                [&connector.from, &connector.to].map(|end| self.attachment(end, &format!("connector `{name}`")));
            let law = connector.law.value.as_ref().map(|law| self.connector_law(law, connector.law.span, &name));
            let (Some(from), Some(to), Some(law)) = (from, to, law) else { continue };
            if self.coordinates_of(from.body) == self.coordinates_of(to.body) {
                self.report(rule::rigid_connector(connector.name.span, &name));
            }
            let strain = Strain::Distance([from, to]);
            connectors.push(Force { group: Group::Connectors, name, strain, law });
        }
        connectors.extend(self.couplings(crane, cylinders));
        connectors
    }

    /// Registers the name of a connector or a coupling: like cylinders, they have result columns for length and force.
    fn register_connector(&mut self, name: &str, span: Span, cylinders: &[Cylinder]) {
        self.register_name("connectors", name, "an earlier connector".into(), span);
        if cylinders.iter().any(|cylinder| cylinder.name == name) {
            self.report(rule::duplicate_name(span, "elements", name, "a cylinder"));
        }
    }

    /// Couplings of two coordinates.
    fn couplings(&mut self, crane: &'a Crane, cylinders: &[Cylinder]) -> Vec<Force> {
        let given = crane.couplings.as_ref().and_then(|couplings| couplings.value.as_deref()).unwrap_or_default();
        let mut couplings = Vec::new();
        for coupling in given.iter().filter_map(|coupling| coupling.value.as_ref()) {
            let name = self.name(&coupling.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_connector(&name, coupling.name.span, cylinders);
            }
            let coordinate = self.joint_of(&coupling.coordinate, "a coupling");
            let leader = self.joint_of(&coupling.follows, "a coupling");
            if coordinate.is_some() && coordinate == leader {
                self.report(rule::own_leader(coupling.follows.span, &name));
            }
            let kind = self.kind_of(coordinate);
            let place = |what: &str| format!("the {what} of coupling `{name}`");
            let Units { stiffness, damping, .. } = units(kind);
            let ratio = self.number(&coupling.ratio, &place("ratio"), "", Limit::Any);
            let offset = coupling.offset.as_ref();
            let law = Law::Spring(Spring {
                stiffness: self.number(&coupling.stiffness, &place("stiffness"), stiffness, Limit::NotNegative),
                damping: self.number_or(coupling.damping.as_ref(), 0.0, &place("damping"), damping, Limit::NotNegative),
                length: offset.map_or(Value::ZERO, |offset| self.position(offset, kind, "`offset`")),
            });
            if let (Some(coordinate), Some(leader)) = (coordinate, leader) {
                let strain = Strain::Coupling { coordinate, leader, ratio };
                couplings.push(Force { group: Group::Connectors, name, strain, law });
            }
        }
        couplings
    }

    /// Reports connectors whose points coincide at the guess.
    pub(super) fn connectors_apart(&mut self, chain: &Chain, crane: &Crane) {
        /// Distance below which two points coincide up to rounding, m.
        const NONE: f64 = 1e-9;
        let given = crane.connectors.as_ref().and_then(|connectors| connectors.value.as_deref()).unwrap_or_default();
        let given = given.iter().filter_map(|connector| connector.value.as_ref());
        for (connector, given) in chain.connectors().iter().zip(given) {
            let Some(ends) = connector.strain.ends() else { continue };
            if chain.distance(ends, &chain.guess, &self.defaults) < NONE {
                self.report(rule::meeting_points(given.name.span, &connector.name));
            }
        }
    }

    /// A point of an element, which `what` names.
    pub(super) fn attachment(&mut self, given: &Spanned<spec::Attachment>, what: &str) -> Option<Attachment> {
        let end = given.value.as_ref()?;
        let at = self.vector(&end.at, &format!("an end of {what}"), "m", Limit::Any);
        let Some(link) = &end.link else { return Some(Attachment { body: None, position: at }) };
        let (body, position) = self.attach(link, at)?;
        Some(Attachment { body: Some(body), position })
    }

    fn rope_law(&mut self, rope: &spec::Rope, span: Span, name: &str) -> Law {
        let stiffness = self.point_number(Some(&rope.stiffness), (name, "stiffness"), "N/m", Limit::Positive);
        let damping = self.point_number(rope.damping.as_ref(), (name, "damping"), "s/m", Limit::NotNegative);
        Law::Rope(Rope { stiffness, damping, length: self.rope_length(rope, span, name) })
    }

    /// A number of a law; 0 if it is left out.
    fn point_number(
        &mut self,
        given: Option<&Spanned<Number>>,
        (name, key): (&str, &str),
        unit: &'static str,
        limit: Limit,
    ) -> Value {
        let place = format!("the {key} of connector `{name}`");
        given.map_or(Value::ZERO, |given| self.number(given, &place, unit, limit))
    }

    fn rope_length(&mut self, rope: &spec::Rope, span: Span, name: &str) -> Profile {
        let wrong = Profile::Hold(f64::NAN.into());
        match (&rope.length, &rope.motion) {
            (Some(length), None) => {
                let place = format!("the length of connector `{name}`");
                Profile::Hold(self.number(length, &place, "m", Limit::Positive))
            }
            (None, Some(motion)) => {
                let way = Some(CoordinateKind::Translation);
                let profile = motion.value.as_ref().and_then(|value| self.motion(value, way, motion.span));
                profile.unwrap_or(wrong)
            }
            _ => {
                self.report(rule::rope_length(span, name));
                wrong
            }
        }
    }
}

/// A number that is given always or perhaps.
trait Given {
    fn given(&self) -> Option<&Spanned<Number>>;
}

impl Given for Spanned<Number> {
    fn given(&self) -> Option<&Spanned<Number>> {
        Some(self)
    }
}

impl Given for Option<Spanned<Number>> {
    fn given(&self) -> Option<&Spanned<Number>> {
        self.as_ref()
    }
}

macro_rules! check_laws {
    ($($(#[$doc:meta])* $law:ident as $written:ident: $expecting:literal {
        $($(#[$key_doc:meta])* $key:ident: $number:ty, $limit:ident $unit:literal;)*
    })*) => {
        impl Check<'_> {
            fn connector_law(&mut self, law: &spec::ConnectorLaw, span: Span, name: &str) -> Law {
                match law {
                    $(spec::ConnectorLaw::$law(law) => Law::$law(chain::$law {
                        $($key: self.point_number(law.$key.given(), (name, stringify!($key)), $unit, Limit::$limit),)*
                    }),)*
                    spec::ConnectorLaw::Rope(rope) => self.rope_law(rope, span, name),
                }
            }
        }
    };
}

point_laws!(check_laws);
