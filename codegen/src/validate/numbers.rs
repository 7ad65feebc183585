//! Numbers: finite, in range, resolved to constants or live parameters.

use super::Check;
use super::limits::Limit;
use crate::chain::{Parameter, ParameterId, Value};
use crate::diagnostic::{Span, rule, suggest};
use crate::spec::{Angle, Constant, Crane, Direction, FixedAngle, Number, Scalar, Spanned, Vector};
use crate::units::{Quantity, Unit};

/// Magnitudes outside this range, except zero, come from a slip in an exponent. Within it, no product or quotient in the
/// expansion leaves the range of a double.
const SMALLEST: f64 = 1e-30;
const LARGEST: f64 = 1e18;

impl<'a> Check<'a> {
    pub(super) fn take_parameters(&mut self, crane: &'a Crane) {
        let Some(parameters) = &crane.parameters else { return };
        let Some(entries) = &parameters.value else {
            self.unknown.parameters = true;
            return;
        };
        for (name, parameter) in &entries.0 {
            let Some(name) = self.name(name) else {
                self.unknown.parameters = true;
                continue;
            };
            let (default, unit, about) = match &parameter.value {
                Some(parameter) => {
                    let unit = self.text(parameter.unit.as_ref(), &format!("the unit of parameter `{name}`"));
                    let default = self.in_own_unit(&parameter.value, &format!("parameter `{name}`"), unit.as_deref());
                    let about = self.text(parameter.about.as_ref(), &format!("`about` of parameter `{name}`"));
                    (default, unit, about)
                }
                None => (f64::NAN, None, None),
            };
            let written = match parameter.value.as_ref().and_then(|parameter| parameter.value.value.as_ref()) {
                Some(FixedAngle(Scalar::Quantity(quantity))) => Some((**quantity).clone()),
                // Words of its own give no dimension.
                _ => unit.as_deref().and_then(|unit| Quantity::labelled(default, unit)),
            };
            let is_quantity = parameter
                .value
                .as_ref()
                .is_some_and(|parameter| matches!(parameter.value.value, Some(FixedAngle(Scalar::Quantity(_)))));
            self.labelled.push(!is_quantity);
            let of_value = written.as_ref().map(|quantity| quantity.dimension.si_unit());
            self.written.push(written);
            self.parameters.push(Parameter {
                name: name.to_owned(),
                unit: unit.or(of_value).unwrap_or_default(),
                about: about.unwrap_or_default(),
                default,
                lower_bound: None,
            });
            self.defaults.push(default);
            self.used.push(false);
        }
    }

    pub(super) fn every_parameter_used(&mut self, crane: &Crane) {
        // A number that could not be read may refer to it.
        if !self.mistakes.is_empty() {
            return;
        }
        let Some(entries) = crane.parameters.as_ref().and_then(|parameters| parameters.value.as_ref()) else { return };
        for ((name, _), used) in entries.0.iter().zip(std::mem::take(&mut self.used)) {
            if let (false, Some(text)) = (used, &name.value) {
                self.report(rule::unused_parameter(name.span, text));
            }
        }
    }

    /// The number at the default values of the parameters.
    pub(super) fn now(&self, value: &Value) -> f64 {
        value.at(&self.defaults)
    }

    /// A number, checked against its limit; NaN if the mistake has been reported.
    pub(super) fn number(&mut self, given: &Spanned<Number>, subject: &str, unit: &str, limit: Limit) -> Value {
        let value = self.resolve(given.value.as_ref().map(|number| &number.0), given.span, subject, Some(unit));
        self.within(value, given.span, (subject, unit, limit))
    }

    /// An optional number.
    pub(super) fn number_or(
        &mut self,
        given: Option<&Spanned<Number>>,
        default: f64,
        subject: &str,
        unit: &str,
        limit: Limit,
    ) -> Value {
        given.map_or(Value::Constant(default), |given| self.number(given, subject, unit, limit))
    }

    /// Three numbers along x, y, z.
    pub(super) fn vector(&mut self, given: &Spanned<Vector>, subject: &str, unit: &str, limit: Limit) -> [Value; 3] {
        match &given.value {
            Some(vector) => vector.each_ref().map(|number| self.number(number, subject, unit, limit)),
            None => [f64::NAN; 3].map(Value::from),
        }
    }

    /// A direction, its largest number ±1; `None` if it has none.
    pub(super) fn direction(&mut self, given: &Spanned<Direction>, subject: &str) -> Option<crate::chain::Vector> {
        let direction = given.value.as_ref()?.each_ref().map(|number| self.constant(number, subject, "", Limit::Any));
        if direction.iter().any(|x| x.is_nan()) {
            return None;
        }
        let size = direction.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        if size == 0.0 {
            self.report(rule::no_direction(given.span, subject));
        }
        // The size of very large or small numbers would overflow when squared.
        (size > 0.0).then(|| direction.map(|x| x / size))
    }

    /// Three optional numbers, zero by default, of two directions and a turn.
    pub(super) fn two_and_turn(
        &mut self,
        given: Option<&Spanned<Vector>>,
        subject: &str,
        [along, turn]: [&str; 2],
        limit: Limit,
    ) -> [Value; 3] {
        match given.map(|given| &given.value) {
            Some(Some([y, z, twist])) => {
                [(y, along), (z, along), (twist, turn)].map(|(number, unit)| self.number(number, subject, unit, limit))
            }
            Some(None) => [f64::NAN; 3].map(Value::from),
            None => [Value::ZERO; 3],
        }
    }

    /// Three optional numbers, zero by default.
    pub(super) fn vector_or_zero(
        &mut self,
        given: Option<&Spanned<Vector>>,
        subject: &str,
        unit: &str,
        limit: Limit,
    ) -> [Value; 3] {
        given.map_or([Value::ZERO; 3], |given| self.vector(given, subject, unit, limit))
    }

    /// An angle, rad.
    pub(super) fn angle(&mut self, given: &Spanned<Angle>, subject: &str) -> Value {
        self.resolve(given.value.as_ref().map(|angle| &angle.0), given.span, subject, Some("rad"))
    }

    /// A position, a force or whatever else a motion moves, in this unit; in any if that is unknown.
    pub(super) fn position(&mut self, given: &Spanned<Angle>, unit: Option<&str>, subject: &str) -> Value {
        self.resolve(given.value.as_ref().map(|angle| &angle.0), given.span, subject, unit)
    }

    /// The same, where it cannot be a parameter.
    pub(super) fn fixed(&mut self, given: &Spanned<FixedAngle>, subject: &str, unit: Option<&str>) -> f64 {
        let value = self.resolve(given.value.as_ref().map(|angle| &angle.0), given.span, subject, unit);
        value.as_constant().unwrap_or(f64::NAN)
    }

    /// The value of a parameter or an input, which has the unit that the spec gives it, if any: words of its own admit numbers alone.
    pub(super) fn in_own_unit(&mut self, given: &Spanned<FixedAngle>, subject: &str, unit: Option<&str>) -> f64 {
        let known = unit.and_then(|unit| Some((unit, Unit::parse(unit).ok()?)));
        let in_si = match (&given.value, &known) {
            (_, Some((_, known))) if known.is_si() => None,
            (Some(FixedAngle(Scalar::Quantity(quantity))), _) => Some(quantity.dimension.si_unit()),
            (Some(_), Some((_, known))) => Some(known.dimension.si_unit()),
            _ => None,
        };
        if let (Some(si), Some(unit)) = (in_si, unit) {
            self.report(rule::not_si(given.span, subject, unit, si));
            return f64::NAN;
        }
        self.fixed(given, subject, known.map(|(unit, _)| unit))
    }

    /// A number that cannot be a parameter.
    pub(super) fn constant(&mut self, given: &Spanned<Constant>, subject: &str, unit: &str, limit: Limit) -> f64 {
        let value = self.resolve(given.value.as_ref().map(|constant| &constant.0), given.span, subject, Some(unit));
        self.within(value, given.span, (subject, unit, limit)).as_constant().unwrap_or(f64::NAN)
    }

    /// Constant or parameter; NaN if the mistake has been reported.
    fn resolve(&mut self, scalar: Option<&Scalar>, span: Span, subject: &str, unit: Option<&str>) -> Value {
        if let Some(unit) = unit {
            self.units.push((span, unit.to_owned()));
        }
        let reported = Value::Constant(f64::NAN);
        let number = match scalar {
            None => return reported,
            Some(Scalar::Name(name)) => {
                let Some(id) = self.parameter(name, span) else { return reported };
                // A factor of a load with unit numbers may be a force: only the unit of a plain number says so.
                let is_factor = self.labelled[id.0] && matches!(unit, Some("" | "1"));
                let written = self.written[id.0].clone().filter(|_| !is_factor);
                return if self.has_dimension(written.as_ref(), span, subject, unit) {
                    Value::Parameter(id)
                } else {
                    reported
                };
            }
            Some(Scalar::Number(number)) => *number,
            Some(Scalar::Quantity(quantity)) => {
                if !self.has_dimension(Some(quantity), span, subject, unit) {
                    return reported;
                }
                quantity.value
            }
        };
        if !number.is_finite() {
            self.report(rule::not_finite(span, subject, number));
            return reported;
        }
        if number != 0.0 && !(SMALLEST..=LARGEST).contains(&number.abs()) {
            self.report(rule::out_of_range(span, subject, format!("{number:e}")));
            return reported;
        }
        // The sign of zero has no meaning here, and would appear in the generated code.
        Value::Constant(number + 0.0)
    }

    /// Whether a number with a unit, if it has one, has the dimension of a unit; reported otherwise.
    fn has_dimension(&mut self, written: Option<&Quantity>, span: Span, subject: &str, unit: Option<&str>) -> bool {
        let wrong = written.zip(unit).and_then(|(quantity, unit)| quantity.wrong_for(unit));
        if let Some(wrong) = &wrong {
            self.report(rule::wrong_dimension(span, subject, &wrong.problem, &wrong.help));
        }
        wrong.is_none()
    }

    pub(super) fn parameter(&mut self, name: &str, span: Span) -> Option<ParameterId> {
        if let Some(index) = self.parameters.iter().position(|parameter| parameter.name == name) {
            self.used[index] = true;
            return Some(ParameterId(index));
        }
        if !self.unknown.parameters {
            let help = suggest(name, self.parameters.iter().map(|parameter| parameter.name.as_str()));
            self.report(rule::unknown_parameter(span, name, help));
        }
        None
    }
}
