//! The values that a live parameter may take: the rules of the spec language are checked whenever it is set.

use core::fmt;

use super::Text;

/// The smallest magnitude of a number other than 0 (rule E033).
const SMALLEST: f64 = 1e-30;
/// The largest magnitude of a number (rule E033).
const LARGEST: f64 = 1e18;

/// An end of the range of a live parameter. The compiler derives it from every place where the parameter is used.
#[derive(Clone, PartialEq)]
pub struct Bound {
    /// The end of the range.
    pub value: f64,
    /// Whether the parameter may be equal to it.
    pub allowed: bool,
    /// The message for a value beyond it.
    pub refusal: Refusal,
}

/// The compiler's message about a value that breaks a rule of the spec language.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Code of the rule, such as `E031`.
    pub code: Text,
    /// What is wrong; the value is appended.
    pub title: Text,
    /// What to write instead.
    pub help: Text,
}

const OUT_OF_RANGE: Refusal = Refusal {
    code: Text::Static("E033"),
    title: Text::Static("the number is outside the allowed range:"),
    help: Text::Static("write 0 or a magnitude from 1e-30 to 1e18, in SI units"),
};
const NOT_FINITE: Refusal = Refusal {
    code: Text::Static("E030"),
    title: Text::Static("not a finite number:"),
    help: Text::Static("write a finite number, in SI units"),
};

impl Bound {
    /// The smallest number of the spec language.
    pub const LOWEST: Bound = Bound { value: -LARGEST, allowed: true, refusal: OUT_OF_RANGE };
    /// The largest number of the spec language.
    pub const HIGHEST: Bound = Bound { value: LARGEST, allowed: true, refusal: OUT_OF_RANGE };
}

impl fmt::Debug for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value, allowed, refusal } = self;
        match self {
            _ if *self == Self::LOWEST => f.write_str("Bound::LOWEST"),
            _ if *self == Self::HIGHEST => f.write_str("Bound::HIGHEST"),
            _ => {
                let mut bound = f.debug_struct("Bound");
                bound.field("value", value).field("allowed", allowed).field("refusal", refusal).finish()
            }
        }
    }
}

/// A live parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterInfo {
    /// Name.
    pub name: Text,
    /// Unit.
    pub unit: Text,
    /// Description.
    pub about: Text,
    /// Default value.
    pub default: f64,
    /// The smallest value that every use of the parameter allows.
    pub lower_bound: Bound,
    /// The largest value that every use of the parameter allows.
    pub upper_bound: Bound,
}

impl ParameterInfo {
    /// Whether the parameter may have this value.
    ///
    /// # Errors
    /// The rule of the spec language that the value breaks.
    pub fn check(&self, value: f64) -> Result<(), ParameterError> {
        let refuse = |refusal: &Refusal| {
            Err(ParameterError { given: Some((self.name.clone(), value)), refusal: refusal.clone() })
        };
        let Self { lower_bound: lower, upper_bound: upper, .. } = self;
        if !value.is_finite() {
            refuse(&NOT_FINITE)
        } else if value < lower.value || (value == lower.value && !lower.allowed) {
            refuse(&lower.refusal)
        } else if value > upper.value || (value == upper.value && !upper.allowed) {
            refuse(&upper.refusal)
        } else if value != 0.0 && value.abs() < SMALLEST {
            refuse(&OUT_OF_RANGE)
        } else {
            Ok(())
        }
    }
}

/// Live parameters cannot have these values: they break a rule of the spec language.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterError {
    /// Name and value of the parameter; `None` for a rule about several parameters.
    pub given: Option<(Text, f64)>,
    /// The rule and its message.
    pub refusal: Refusal,
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Refusal { code, title, help } = &self.refusal;
        match &self.given {
            Some((parameter, value)) => write!(f, "parameter `{parameter}`: {title} {value} [{code}]; {help}"),
            None => write!(f, "{title} [{code}]; {help}"),
        }
    }
}

impl core::error::Error for ParameterError {}

#[cfg(test)]
mod tests {
    use super::*;

    const MASS: ParameterInfo = ParameterInfo {
        name: Text::Static("load"),
        unit: Text::Static("kg"),
        about: Text::Static(""),
        default: 1.0,
        lower_bound: Bound {
            value: 0.0,
            allowed: false,
            refusal: Refusal {
                code: Text::Static("E031"),
                title: Text::Static("the mass must be above zero, not"),
                help: Text::Static("write a number above 0"),
            },
        },
        upper_bound: Bound::HIGHEST,
    };

    #[test]
    fn values_outside_the_range_are_refused_with_their_rule() {
        let code = |info: &ParameterInfo, value| info.check(value).err().map(|error| error.refusal.code);
        let free = ParameterInfo { lower_bound: Bound::LOWEST, ..MASS };
        let zero_too = ParameterInfo { lower_bound: Bound { allowed: true, ..MASS.lower_bound }, ..MASS };
        for (value, mass, zero, any) in [
            (-10.0, Some("E031"), Some("E031"), None),
            (0.0, Some("E031"), None, None),
            (-0.0, Some("E031"), None, None),
            (1e-31, Some("E033"), Some("E033"), Some("E033")),
            (1e-30, None, None, None),
            (1e18, None, None, None),
            (1.1e18, Some("E033"), Some("E033"), Some("E033")),
            (f64::NAN, Some("E030"), Some("E030"), Some("E030")),
            (f64::INFINITY, Some("E030"), Some("E030"), Some("E030")),
        ] {
            assert_eq!(
                [code(&MASS, value), code(&zero_too, value), code(&free, value)],
                [mass, zero, any].map(|code| code.map(Text::Static)),
                "{value}"
            );
        }
    }

    #[cfg(feature = "std")]
    #[test]
    fn the_message_names_parameter_value_rule_and_remedy() {
        let message = MASS.check(-10.0).unwrap_err().to_string();
        assert_eq!(message, "parameter `load`: the mass must be above zero, not -10 [E031]; write a number above 0");
    }
}
