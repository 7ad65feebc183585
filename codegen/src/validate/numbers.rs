//! Numbers: finite, in range, resolved to constants or live parameters.

use super::Check;
use super::plausibility::Judged;
use crate::chain::{CoordinateKind, Parameter, ParameterId, Value};
use crate::diagnostic::{Mistake, Span, rule, suggest};
use crate::node::{Limit, Measure};
use crate::spec::{Constant, Crane, Direction, FixedAngle, Number, Scalar, Spanned, Vector, Written};
use crate::units::{Quantity, Unit};

/// Magnitudes outside this range, except zero, come from a slip in an exponent. Within it, no product or quotient in the
/// expansion leaves the range of a double.
const SMALLEST: f64 = 1e-30;
const LARGEST: f64 = 1e18;

/// Whose a number is, where its unit depends on that.
#[derive(Clone, Copy)]
pub(super) enum Whose<'u> {
    /// Of a key with one unit.
    Key,
    /// Of a joint; in any unit if that is unknown.
    Joint(Option<CoordinateKind>),
    /// In this unit; in any if that is unknown.
    Own(Option<&'u str>),
}

impl<'u> Whose<'u> {
    /// The unit of the number; `None` if it is not known.
    pub(super) fn unit(self, measure: &'static Measure) -> Option<&'u str> {
        let turning_or_sliding = measure.unit.split_once(" or ").unwrap_or((measure.unit, measure.unit));
        match self {
            Whose::Own(unit) => unit,
            Whose::Key => Some(if measure.unit == "1" { "" } else { measure.unit }),
            Whose::Joint(kind) => kind.map(|kind| match kind {
                CoordinateKind::Rotation => turning_or_sliding.0,
                CoordinateKind::Translation => turning_or_sliding.1,
            }),
        }
    }
}

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
                Some(FixedAngle(Scalar::Quantity(quantity), _)) => Some((**quantity).clone()),
                // Words of its own give no dimension.
                _ => unit.as_deref().and_then(|unit| Quantity::labelled(default, unit)),
            };
            let is_quantity = parameter
                .value
                .as_ref()
                .is_some_and(|parameter| matches!(parameter.value.value, Some(FixedAngle(Scalar::Quantity(_), _))));
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

    /// A number in the unit and within the limit of its key; NaN if the mistake has been reported.
    pub(super) fn number(&mut self, given: &Spanned<impl Written>, subject: &str) -> Value {
        self.number_of(given, Whose::Key, subject)
    }

    /// The same, of something on which its unit depends.
    pub(super) fn number_of(&mut self, given: &Spanned<impl Written>, of: Whose<'_>, subject: &str) -> Value {
        let Some(number) = &given.value else { return f64::NAN.into() };
        let measure = number.measure();
        self.measured(number.scalar(), given.span, (subject, of.unit(measure), *measure))
    }

    /// The same, within a limit that is stricter than that of its key.
    pub(super) fn number_within(&mut self, given: &Spanned<Number>, limit: Limit, subject: &str) -> Value {
        let Some(Number(number, measure)) = &given.value else { return f64::NAN.into() };
        self.measured(number, given.span, (subject, Whose::Key.unit(measure), Measure { limit, ..**measure }))
    }

    fn measured(
        &mut self,
        number: &Scalar,
        span: Span,
        (subject, unit, Measure { limit, usual, .. }): (&str, Option<&str>, Measure),
    ) -> Value {
        let value = self.resolve(number, span, subject, unit);
        let unit = unit.unwrap_or_default();
        if usual != Measure::ALL {
            let (subject, unit) = (subject.to_owned(), unit.to_owned());
            self.judged.push(Judged { span, subject, unit, value: value.clone(), usual });
        }
        self.within(value, span, (subject, unit, limit))
    }

    /// An optional number.
    pub(super) fn number_or(&mut self, given: Option<&Spanned<Number>>, default: f64, subject: &str) -> Value {
        given.map_or(Value::Constant(default), |given| self.number(given, subject))
    }

    /// A number that cannot be a parameter.
    pub(super) fn constant(&mut self, given: &Spanned<impl Written>, subject: &str) -> f64 {
        self.fixed(given, Whose::Key, subject)
    }

    /// The same, of something on which its unit depends.
    pub(super) fn fixed(&mut self, given: &Spanned<impl Written>, of: Whose<'_>, subject: &str) -> f64 {
        self.number_of(given, of, subject).as_constant().unwrap_or(f64::NAN)
    }

    /// A whole number within the limit of its key; `None` after a mistake, of which this is the one about other numbers.
    pub(super) fn count(
        &mut self,
        constant: &Spanned<Constant>,
        subject: &str,
        broken: impl FnOnce(f64) -> Mistake,
    ) -> Option<u32> {
        let number = self.constant(constant, subject);
        let Limit::Whole(most) = constant.value.as_ref()?.measure().limit else { return None };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // an integer from 1 to `most`
        if (1.0..=f64::from(most)).contains(&number) && number.fract() == 0.0 {
            return Some(number as u32);
        }
        // A number that could not be read has been reported.
        if !number.is_nan() {
            self.report(broken(number));
        }
        None
    }

    /// Three numbers along x, y, z.
    pub(super) fn vector(&mut self, given: &Spanned<Vector>, subject: &str) -> [Value; 3] {
        match &given.value {
            Some(vector) => vector.each_ref().map(|number| self.number(number, subject)),
            None => [f64::NAN; 3].map(Value::from),
        }
    }

    /// A direction, its largest number ±1; `None` if it has none.
    pub(super) fn direction(&mut self, given: &Spanned<Direction>, subject: &str) -> Option<crate::chain::Vector> {
        let direction = given.value.as_ref()?.each_ref().map(|number| self.constant(number, subject));
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

    /// Three optional numbers, zero by default.
    pub(super) fn vector_or_zero(&mut self, given: Option<&Spanned<Vector>>, subject: &str) -> [Value; 3] {
        given.map_or([Value::ZERO; 3], |given| self.vector(given, subject))
    }

    /// The value of a parameter or an input, which has the unit that the spec gives it, if any: words of its own admit numbers alone.
    pub(super) fn in_own_unit(&mut self, given: &Spanned<FixedAngle>, subject: &str, unit: Option<&str>) -> f64 {
        let known = unit.and_then(|unit| Some((unit, Unit::parse(unit).ok()?)));
        let in_si = match (&given.value, &known) {
            (_, Some((_, known))) if known.is_si() => None,
            (Some(FixedAngle(Scalar::Quantity(quantity), _)), _) => Some(quantity.dimension.si_unit()),
            (Some(_), Some((_, known))) => Some(known.dimension.si_unit()),
            _ => None,
        };
        if let (Some(si), Some(unit)) = (in_si, unit) {
            self.report(rule::not_si(given.span, subject, unit, si));
            return f64::NAN;
        }
        self.fixed(given, Whose::Own(known.map(|(unit, _)| unit)), subject)
    }

    /// Constant or parameter; NaN if the mistake has been reported.
    fn resolve(&mut self, scalar: &Scalar, span: Span, subject: &str, unit: Option<&str>) -> Value {
        if let Some(unit) = unit {
            self.units.push((span, unit.to_owned()));
        }
        let reported = Value::Constant(f64::NAN);
        let number = match scalar {
            Scalar::Name(name) => {
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
            Scalar::Number(number) => *number,
            Scalar::Quantity(quantity) => {
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
