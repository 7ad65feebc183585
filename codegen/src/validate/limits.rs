//! Limits of numbers: constants are checked here, live parameters get bounds that are checked whenever they are set.

use super::Check;
use crate::chain::{Bound, Chain, ParameterId, Refusal, Relation, Value};
use crate::diagnostic::{Mistake, Span, rule};
use crate::node::Limit;

/// The message of a rule up to the number that breaks it, or without a number.
fn refusal(mistake: &Mistake) -> Refusal {
    let (title, help) = (mistake.title.trim_end().to_owned().into(), mistake.help.clone().into());
    Refusal { code: mistake.code.into(), title, help }
}

/// The rule that a margin is above zero, if it is live.
pub(super) fn positive_margin(margin: Value, broken: &Mistake) -> Option<Relation> {
    margin.as_constant().is_none().then(|| Relation { margin, refusal: refusal(broken) })
}

impl Check<'_> {
    /// The number, or NaN after reporting that it is beyond its limit; for a live parameter, records the limit as a bound.
    pub(super) fn within(&mut self, value: Value, span: Span, (subject, unit, limit): (&str, &str, Limit)) -> Value {
        let live = match &value {
            Value::Parameter(id) => Some(*id),
            _ => None,
        };
        let number = self.now(&value);
        let [of_unit, in_unit] = [" ", ", in "].map(|before| match unit {
            "" => String::new(),
            unit => format!("{before}{unit}"),
        });
        let not_positive = |given: String| rule::not_positive(span, subject, given, &of_unit, &in_unit);
        let negative = |given: String| rule::negative(span, subject, given, &of_unit, &in_unit);
        match (limit, live) {
            (Limit::Positive, _) | (Limit::Mass, None) if number <= 0.0 => {
                self.report(not_positive(number.to_string()));
                return f64::NAN.into();
            }
            (Limit::MassOfMoments, None) if number < 0.0 => {
                self.report(not_positive(number.to_string()));
                return f64::NAN.into();
            }
            (Limit::NotNegative, _) | (Limit::Mass | Limit::MassOfMoments, Some(_)) if number < 0.0 => {
                self.report(negative(number.to_string()));
                return f64::NAN.into();
            }
            _ => {}
        }
        let Some(id) = live else { return value };
        let above = Bound { value: 0.0, allowed: false, refusal: refusal(&not_positive(String::new())) };
        let not_below = Bound { value: 0.0, allowed: true, refusal: refusal(&negative(String::new())) };
        match limit {
            Limit::Any | Limit::Whole(_) => {}
            Limit::Positive => self.parameters[id.0].raise(above),
            Limit::NotNegative => self.parameters[id.0].raise(not_below),
            Limit::Mass | Limit::MassOfMoments => {
                self.parameters[id.0].raise(not_below);
                self.live_masses.push((id, above));
            }
        }
        value
    }

    /// Records the rule that `smaller` is below `larger`. Default values are checked elsewhere; with live numbers, the rule must
    /// hold whenever they are set.
    pub(super) fn keep_below(&mut self, smaller: &Value, larger: &Value, broken: &Mistake) {
        self.keep_positive(larger.clone() - smaller.clone(), broken);
    }

    /// Records the rule that `margin` is above zero. Default values are checked elsewhere.
    pub(super) fn keep_positive(&mut self, margin: Value, broken: &Mistake) {
        self.relations.extend(positive_margin(margin, broken));
    }

    /// A live mass cannot be zero if a joint would move nothing without it.
    pub(super) fn keep_masses(&mut self, chain: &mut Chain) {
        for (ParameterId(index), above) in std::mem::take(&mut self.live_masses) {
            let mut without = self.defaults.clone();
            without[index] = 0.0;
            if !self.idle_coordinates(chain, &without).is_empty() {
                chain.parameters[index].raise(above);
            }
        }
    }
}
