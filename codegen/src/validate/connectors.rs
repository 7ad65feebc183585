//! Connectors: elements between two points, and couplings of coordinates.

use super::Check;
use super::numbers::Whose;
use crate::chain::{
    self, Attachment, Chain, CoordinateKind, Cylinder, Follower, Force, Group, Law, LinePart, Profile, RigidCoupling,
    Rope, RopeStiffness, Spring, Strain, StrainLine, Value,
};
use crate::diagnostic::{Span, rule};
use crate::spec::{self, Crane, Number, Spanned, entries};

impl<'a> Check<'a> {
    pub(super) fn connectors(&mut self, crane: &'a Crane, cylinders: &[Cylinder]) -> Vec<Force> {
        let given = crane.connectors.as_ref().and_then(|connectors| connectors.value.as_deref()).unwrap_or_default();
        let mut connectors = Vec::new();
        for connector in given.iter().filter_map(|connector| connector.value.as_ref()) {
            let name = self.name(&connector.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_connector(&name, connector.name.span, cylinders);
            }
            let line = self.line(connector, &name);
            let law = connector.law.value.as_ref().map(|law| self.connector_law(law, connector.law.span, &name));
            let (Some(line), Some(law)) = (line, law) else { continue };
            let is_rigid = |part: LinePart<'_>| {
                let [one, other] = part.ends.map(|end| self.coordinates_of(end.body));
                one == other
            };
            if line.parts().all(is_rigid) {
                self.report(rule::rigid_connector(connector.name.span, &name));
            }
            connectors.push(Force { group: Group::Connectors, name, strain: Strain::Line(line), law });
        }
        connectors
    }

    /// Points that the ground carries.
    pub(super) fn contacts(&mut self, crane: &'a Crane, cylinders: &[Cylinder]) -> Vec<Force> {
        let mut contacts = Vec::new();
        for contact in entries(crane.contacts.as_ref()) {
            let name = self.name(&contact.name).unwrap_or_default().to_owned();
            if !name.is_empty() {
                self.register_connector(&name, contact.name.span, cylinders);
            }
            let place = |what: &str| format!("the {what} of contact `{name}`");
            let at = self.vector_or_zero(contact.at.as_ref(), &place("point"));
            let height = self.number_or(contact.height.as_ref(), 0.0, &place("height"));
            let stiffness = self.number(&contact.stiffness, &place("stiffness"));
            let damping = self.number_or(contact.damping.as_ref(), 0.0, &place("damping"));
            let Some((body, position)) = self.attach(&contact.link, at) else { continue };
            if self.coordinates_of(Some(body)).is_empty() {
                self.report(rule::rigid_contact(contact.link.span, &name));
            }
            let point = Attachment { body: Some(body), position };
            let law = Law::Rope(Rope {
                stiffness: RopeStiffness::Whole(stiffness),
                damping,
                length: Profile::Hold(Value::ZERO),
                max_tension: None,
            });
            contacts.push(Force { group: Group::Connectors, name, strain: Strain::Depth { point, height }, law });
        }
        contacts
    }

    /// The line from one end of a connector over its sheaves to the other.
    fn line(&mut self, connector: &'a spec::Connector, name: &str) -> Option<StrainLine> {
        self.only_ropes_run(connector, name);
        let [from, to] =
            [&connector.from, &connector.to].map(|end| self.attachment(end, &format!("an end of connector `{name}`")));
        let sheaves = sheaves(connector);
        let over: Vec<_> =
            sheaves.iter().map(|sheave| self.attachment(sheave, &format!("a sheave of rope `{name}`"))).collect();
        let falls = connector.falls.as_ref().map_or(Some(1), |constant| {
            self.count(constant, &format!("the falls of rope `{name}`"), |count| {
                rule::falls(constant.span, name, count)
            })
        });
        let points: Option<Vec<Attachment>> = [from].into_iter().chain(over).chain([to]).collect();
        Some(StrainLine { points: points?, falls: falls? })
    }

    /// Reports sheaves and falls of other connectors than ropes, and lists without sheaves.
    fn only_ropes_run(&mut self, connector: &spec::Connector, name: &str) {
        let over = connector.over.as_ref();
        if let Some(over) = over.filter(|over| over.value.as_ref().is_some_and(Vec::is_empty)) {
            self.report(rule::no_sheaves(over.span, name));
        }
        let key = over.map(|over| ("over", over.span)).or(connector.falls.as_ref().map(|falls| ("falls", falls.span)));
        let is_rope = connector.law.value.as_ref().is_none_or(|law| matches!(law, spec::ConnectorLaw::Rope(_)));
        if let Some((key, span)) = key.filter(|_| !is_rope) {
            self.report(rule::sheaves_without_rope(span, name, key));
        }
    }

    /// Registers the name of a connector or a coupling: like cylinders, they have result columns for length and force.
    pub(super) fn register_connector(&mut self, name: &str, span: Span, cylinders: &[Cylinder]) {
        self.register_name("connectors", name, "an earlier connector".into(), span);
        if cylinders.iter().any(|cylinder| cylinder.name == name) {
            self.report(rule::duplicate_name(span, "elements", name, "a cylinder"));
        }
    }

    /// Couplings of two coordinates: those with springs, and those that hold exactly.
    pub(super) fn couplings(&mut self, crane: &'a Crane, cylinders: &[Cylinder]) -> (Vec<Force>, Vec<RigidCoupling>) {
        let (mut springs, mut exact) = (Vec::new(), Vec::new());
        for coupling in entries(crane.couplings.as_ref()) {
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
            let turns = [kind, self.kind_of(leader)].map(|kind| kind != Some(CoordinateKind::Translation));
            let unit = match turns {
                [false, true] => "m/rad",
                [true, false] => "rad/m",
                _ => "",
            };
            let ratio = self.number_of(&coupling.ratio, Whose::Own(Some(unit)), &place("ratio"));
            let offset = coupling.offset.as_ref();
            let offset = offset.map_or(Value::ZERO, |offset| self.number_of(offset, Whose::Joint(kind), "`offset`"));
            let spring = self.spring_of(coupling, &name, kind);
            let (Some(coordinate), Some(leader)) = (coordinate, leader) else { continue };
            if let Some([stiffness, damping]) = spring {
                let law = Law::Spring(Spring { stiffness, damping, length: offset });
                let strain = Strain::Coupling { coordinate, leader, ratio };
                springs.push(Force { group: Group::Connectors, name, strain, law });
            } else {
                let kind = self.coordinates[coordinate.0].kind;
                exact.push(RigidCoupling { name, follower: Follower { coordinate, leader, ratio, offset }, kind });
            }
        }
        (springs, exact)
    }

    /// Stiffness and damping of a coupling; `None` if it is rigid.
    fn spring_of(&mut self, coupling: &spec::Coupling, name: &str, kind: Option<CoordinateKind>) -> Option<[Value; 2]> {
        let keys = [("stiffness", coupling.stiffness.as_ref()), ("damping", coupling.damping.as_ref())];
        let numbers = keys.map(|(key, given)| {
            let place = format!("the {key} of coupling `{name}`");
            given.map(|given| self.number_of(given, Whose::Joint(kind), &place))
        });
        let subject = format!("coupling `{name}`");
        if coupling.rigid.as_ref().is_some_and(|rigid| rigid.value == Some(true)) {
            for (key, given) in keys {
                if let Some(given) = given {
                    let follows = "force follows from the motion";
                    self.report(rule::rigid_spring(given.span, subject.clone(), key, follows));
                }
            }
            return None;
        }
        let [stiffness, damping] = numbers;
        // An invalid value of `rigid` has been reported already.
        let unread = coupling.rigid.as_ref().is_some_and(|rigid| rigid.value.is_none());
        if stiffness.is_none() && !unread {
            self.report(rule::no_transmission(
                coupling.name.span,
                subject,
                "neither `stiffness` nor `rigid: true`",
                "or `rigid: true` if the coordinate follows exactly",
            ));
        }
        Some([stiffness.unwrap_or(f64::NAN.into()), damping.unwrap_or(Value::ZERO)])
    }

    /// Reports rigid couplings of coordinates that rigid drives prescribe.
    pub(super) fn couplings_move(&mut self, chain: &Chain, crane: &Crane) {
        for given in entries(crane.couplings.as_ref()) {
            let named = |coupling: &&RigidCoupling| Some(&coupling.name) == given.name.value.as_ref();
            let Some(RigidCoupling { name, follower, .. }) = chain.rigid_couplings.iter().find(named) else { continue };
            if follower.coordinates().into_iter().all(|coordinate| chain.is_prescribed(coordinate)) {
                self.report(rule::prescribed_loop(given.name.span, format!("coupling `{name}`"), "coupling"));
            }
        }
    }

    /// Reports connectors of which neighbouring points coincide at the guess.
    pub(super) fn connectors_apart(&mut self, chain: &Chain, crane: &Crane) {
        /// Distance below which two points coincide up to rounding, m.
        const NONE: f64 = 1e-9;
        let given = crane.connectors.as_ref().and_then(|connectors| connectors.value.as_deref()).unwrap_or_default();
        let given = given.iter().filter_map(|connector| connector.value.as_ref());
        for (connector, given) in chain.connectors().iter().zip(given) {
            let Some(line) = connector.strain.line() else { continue };
            let distances = chain.distances(line, &chain.guess, &self.defaults);
            let Some(part) = distances.iter().position(|distance| *distance < NONE) else { continue };
            let sheaves = sheaves(given);
            // The sheave at the beginning of a part, or at its end.
            let sheave = |at: usize| at.checked_sub(1).and_then(|index| sheaves.get(index));
            self.report(match sheave(part).or(sheave(part + 1)) {
                Some(sheave) => {
                    let name = |at: usize| match at {
                        0 => "`from`".to_owned(),
                        _ if at > sheaves.len() => "`to`".to_owned(),
                        _ => format!("sheave {at}"),
                    };
                    rule::meeting_sheaves(sheave.span, &connector.name, name(part), name(part + 1))
                }
                None => rule::meeting_points(given.name.span, &connector.name),
            });
        }
    }

    /// A point of an element; `what` names it in messages.
    pub(super) fn attachment(&mut self, given: &Spanned<spec::Attachment>, what: &str) -> Option<Attachment> {
        let end = given.value.as_ref()?;
        let at = self.vector(&end.at, what);
        let Some(link) = &end.link else { return Some(Attachment { body: None, position: at }) };
        let (body, position) = self.attach(link, at)?;
        Some(Attachment { body: Some(body), position })
    }

    fn rope_law(&mut self, rope: &spec::Rope, span: Span, name: &str) -> Law {
        let damping = self.point_number(rope.damping.as_ref(), (name, "damping"));
        let length = self.rope_length(rope, span, name);
        let place = format!("the largest tension of rope `{name}`");
        let max_tension = rope.max_tension.as_ref().map(|constant| self.constant(constant, &place));
        Law::Rope(Rope { stiffness: self.rope_stiffness(rope, span, name, &length), damping, length, max_tension })
    }

    /// A stiffness that stays the same, or EA of a rope whose length changes.
    fn rope_stiffness(&mut self, rope: &spec::Rope, span: Span, name: &str, length: &Profile) -> RopeStiffness {
        match (&rope.stiffness, &rope.axial_stiffness) {
            (Some(stiffness), None) => RopeStiffness::Whole(self.point_number(Some(stiffness), (name, "stiffness"))),
            (None, Some(axial)) => {
                if rope.motion.is_some() {
                    self.keep_rope(length, span, name);
                }
                let axial = self.point_number(Some(axial), (name, "axial stiffness"));
                match length {
                    Profile::Hold(length) => RopeStiffness::Whole(axial / length.clone()),
                    _ => RopeStiffness::Axial(axial),
                }
            }
            _ => {
                self.report(rule::rope_stiffness(span, name));
                RopeStiffness::Whole(f64::NAN.into())
            }
        }
    }

    /// The free length of a rope with EA is above zero wherever its motion says it in numbers.
    fn keep_rope(&mut self, length: &Profile, span: Span, name: &str) {
        let lengths = length.stations();
        if let Some(wound) = lengths.iter().map(|length| self.now(length)).find(|length| *length <= 0.0) {
            return self.report(rule::wound_up(span, name, wound));
        }
        for length in lengths {
            self.keep_positive(length, &rule::wound_up(span, name, ""));
        }
    }

    /// A number of a law; 0 if it is left out.
    fn point_number(&mut self, given: Option<&Spanned<Number>>, (name, key): (&str, &str)) -> Value {
        self.number_or(given, 0.0, &format!("the {key} of connector `{name}`"))
    }

    fn rope_length(&mut self, rope: &spec::Rope, span: Span, name: &str) -> Profile {
        let wrong = Profile::Hold(f64::NAN.into());
        match (&rope.length, &rope.motion) {
            (Some(length), None) => {
                let place = format!("the length of connector `{name}`");
                Profile::Hold(self.number(length, &place))
            }
            (None, Some(motion)) => {
                let profile = motion.value.as_ref().and_then(|value| self.motion(value, Whose::Key, motion.span));
                let profile = profile.map(|profile| self.halted(profile, rope.halt.as_ref(), name));
                profile.unwrap_or(wrong)
            }
            _ => {
                self.report(rule::rope_length(span, name));
                wrong
            }
        }
    }
}

/// The sheaves of a connector.
fn sheaves(connector: &spec::Connector) -> &[Spanned<spec::Attachment>] {
    connector.over.as_ref().and_then(|over| over.value.as_deref()).unwrap_or_default()
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
        $($(#[doc = $about:literal])* #[key(unit = $unit:literal, limit = $limit:ident)] $key:ident: $number:ty;)*
    })*) => {
        impl Check<'_> {
            fn connector_law(&mut self, law: &spec::ConnectorLaw, span: Span, name: &str) -> Law {
                match law {
                    $(spec::ConnectorLaw::$law(law) => Law::$law(chain::$law {
                        $($key: self.point_number(law.$key.given(), (name, stringify!($key))),)*
                    }),)*
                    spec::ConnectorLaw::Rope(rope) => self.rope_law(rope, span, name),
                }
            }
        }
    };
}

point_laws!(check_laws);
