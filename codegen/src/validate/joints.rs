//! End stops and friction of joints.

use super::Check;
use super::numbers::Whose;
use crate::chain::{
    Bristle, CoordinateId, CoordinateKind, Drive, End, Force, Friction, Group, Law, Stop, Transmission, Value,
};
use crate::diagnostic::rule;
use crate::spec::{self, Crane, Number, Spanned};

/// Default rate at which friction reaches three quarters of its full value, rad/s or m/s: a hundredth of the rates of crane
/// drives.
pub(super) const WIDTH: f64 = 1e-3;
/// Default rate of the Stribeck decline, rad/s or m/s.
const STRIBECK: f64 = 1e-2;

impl<'a> Check<'a> {
    /// The force elements of all joints: stops, then friction.
    pub(super) fn joint_forces(&mut self, crane: &'a Crane, drives: &[Drive]) -> Vec<Force> {
        let mut forces = Vec::new();
        for (name, stops) in crane.stops.iter().filter_map(|given| given.value.as_ref()).flat_map(|given| &given.0) {
            let coordinate = self.joint_of(name, "stops");
            if let Some(written) = &stops.value {
                let laws = self.stops(written, stops, name.value.as_deref().unwrap_or_default(), coordinate);
                let force = |id, stop| Force::on(&self.coordinates, Group::Stops, id, Law::Stop(stop));
                forces.extend(
                    coordinate.into_iter().flat_map(|id| laws.clone().into_iter().map(move |stop| force(id, stop))),
                );
            }
        }
        for (name, given) in crane.friction.iter().filter_map(|given| given.value.as_ref()).flat_map(|given| &given.0) {
            let coordinate = self.joint_of(name, "friction");
            if let Some(written) = &given.value {
                let kind = self.kind_of(coordinate);
                let friction = self.friction(written, name.value.as_deref().unwrap_or_default(), kind);
                let rigid = drives
                    .iter()
                    .find(|drive| Some(drive.coordinate) == coordinate && drive.transmission == Transmission::Rigid);
                if let (Some(bristle), Some(_)) = (&written.bristle, rigid) {
                    self.report(rule::prescribed_bristles(bristle.span, name.value.as_deref().unwrap_or_default()));
                }
                let force = |id| Force::on(&self.coordinates, Group::Friction, id, Law::Friction(friction));
                forces.extend(coordinate.map(force));
            }
        }
        forces
    }

    /// The coordinate of a joint by its name.
    pub(super) fn joint_of(&mut self, name: &Spanned<String>, what: &str) -> Option<CoordinateId> {
        let id = self.joint_coordinate(name)?;
        if let Some(owner) = self.not_a_joint(id) {
            let coordinate = self.coordinates[id.0].name.clone();
            self.report(rule::not_a_joint(name.span, coordinate, what, owner));
        }
        Some(id)
    }

    fn stops(
        &mut self,
        written: &spec::Stops,
        given: &Spanned<spec::Stops>,
        name: &str,
        coordinate: Option<CoordinateId>,
    ) -> Vec<Stop> {
        let of = Whose::Joint(self.kind_of(coordinate));
        let subject = |what: &str| format!("the {what} of the stops of `{name}`");
        let stiffness = self.number_of(&written.stiffness, of, &subject("stiffness"));
        let damping = written.damping.as_ref();
        let damping = damping.map_or(Value::ZERO, |given| self.number_of(given, of, &subject("damping")));
        let mut stops = Vec::new();
        for (end, at, key) in [(End::Lower, &written.min, "`min`"), (End::Upper, &written.max, "`max`")] {
            if let Some(at) = at {
                let at = self.number_of(at, of, key);
                stops.push(Stop { at, end, stiffness: stiffness.clone(), damping: damping.clone() });
            }
        }
        match (stops.as_slice(), &written.max) {
            ([], _) => self.report(rule::no_stop(given.span, name)),
            ([lower, upper], Some(max)) => {
                let (low, high) = (self.now(&lower.at), self.now(&upper.at));
                let broken = rule::stops_crossed(max.span, name, low, high);
                if low >= high {
                    self.report(broken.clone());
                }
                self.keep_below(&lower.at, &upper.at, &broken);
            }
            _ => {}
        }
        stops
    }

    pub(super) fn friction(&mut self, written: &spec::Friction, name: &str, kind: Option<CoordinateKind>) -> Friction {
        let of = Whose::Joint(kind);
        let or = |check: &mut Self, given: &Option<Spanned<Number>>, default: f64, subject: &str| {
            given.as_ref().map_or(default.into(), |given| check.number_of(given, of, subject))
        };
        let subject = |what: &str| format!("the {what} friction of `{name}`");
        let coulomb = self.number_of(&written.coulomb, of, &subject("Coulomb"));
        let stribeck = or(self, &written.stribeck, STRIBECK, "`stribeck`");
        let breakaway = written.breakaway.as_ref().map(|given| {
            let breakaway = self.number_of(given, of, &subject("breakaway"));
            let (less, more) = (self.now(&coulomb), self.now(&breakaway));
            let broken = rule::breakaway(given.span, name, less, more);
            if more < less {
                self.report(broken.clone());
            }
            // A live breakaway friction may be equal to the Coulomb friction, but not smaller.
            let margin = breakaway.clone() - coulomb.clone() + Value::Constant(f64::MIN_POSITIVE);
            self.keep_positive(margin, &broken);
            (breakaway, stribeck.clone())
        });
        if let (Some(given), None) = (&written.stribeck, &written.breakaway) {
            self.report(rule::stribeck_alone(given.span, name));
        }
        let bristle = written
            .bristle
            .as_ref()
            .and_then(|given| self.bristle(given, written, (name, of), (&coulomb, breakaway.as_ref()), &stribeck));
        Friction {
            bristle,
            coulomb,
            breakaway,
            width: or(self, &written.width, WIDTH, "`width`"),
            viscous: or(self, &written.viscous, 0.0, &subject("viscous")),
        }
    }

    /// The bristles of a joint that sticks.
    fn bristle(
        &mut self,
        given: &Spanned<spec::Bristle>,
        friction: &spec::Friction,
        (name, of): (&str, Whose<'_>),
        (coulomb, breakaway): (&Value, Option<&(Value, Value)>),
        stribeck: &Value,
    ) -> Option<Bristle> {
        if let Some(width) = &friction.width {
            self.report(rule::width_of_bristles(width.span, name));
        }
        let written = given.value.as_ref()?;
        let [stiffness, damping] = [(&written.stiffness, "stiffness"), (&written.damping, "damping")]
            .map(|(number, what)| self.fixed(number, of, &format!("the {what} of the bristles of `{name}`")));
        let breakaway = breakaway.map_or(coulomb, |(breakaway, _)| breakaway);
        let [Some(coulomb), Some(breakaway), Some(stribeck)] = [coulomb, breakaway, stribeck].map(Value::as_constant)
        else {
            self.report(rule::live_bristles(given.span, name));
            return None;
        };
        if coulomb == 0.0 {
            self.report(rule::bristles_of_nothing(given.span, name));
        }
        Some(Bristle { coulomb, breakaway, stribeck, stiffness, damping })
    }

    /// The kind of a coordinate.
    pub(super) fn kind_of(&self, coordinate: Option<CoordinateId>) -> Option<CoordinateKind> {
        coordinate.map(|CoordinateId(index)| self.coordinates[index].kind)
    }
}
