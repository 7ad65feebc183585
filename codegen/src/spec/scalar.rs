//! Numbers, with and without units, as written.

use super::Spanned;
use crate::diagnostic::rule;
use crate::node::{Content, Definition, Form, FromNode, Measure, Reader, Unread};
use crate::units::{Quantity, UnknownUnit};

/// Three numbers along x, y, z.
pub type Vector = [Spanned<Number>; 3];

/// The forms of a number.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// A plain number, in SI units.
    Number(f64),
    /// A number with a unit, such as `3600 mm`, `90 deg` or `7/18 pi`.
    Quantity(Box<Quantity>),
    /// Name of a parameter.
    Name(String),
}

impl Scalar {
    /// The number that is written, in SI units; `None` for the name of a parameter.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Scalar::Number(number) => Some(*number),
            Scalar::Quantity(quantity) => Some(quantity.value),
            Scalar::Name(_) => None,
        }
    }
}

/// A number as written, and what it measures.
pub(crate) trait Written {
    fn scalar(&self) -> &Scalar;
    fn measure(&self) -> &'static Measure;
}

/// Reads a [`Scalar`], a name only where it is permitted; `expected` is what is permitted, in messages.
fn read_scalar(reader: Reader, name: bool, expected: &str) -> Result<Scalar, Unread> {
    let unread = || Unread::Expected(expected.to_owned());
    match reader.content()? {
        Content::Number(number) => Ok(Scalar::Number(*number)),
        Content::Text(word) => match Quantity::parse(word) {
            Some(Ok(quantity)) => Ok(Scalar::Quantity(Box::new(quantity))),
            Some(Err(UnknownUnit { symbol, help })) => {
                Err(reader.report(rule::unknown_unit(reader.span, reader.subject, word, symbol, help)))
            }
            None if name && is_name(word) => Ok(Scalar::Name(word.clone())),
            None => Err(unread()),
        },
        _ => Err(unread()),
    }
}

/// Whether a word can be the name of a parameter.
fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_') && word.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Declares a kind of number: its forms, whether it may be a parameter, and the expectation in messages.
macro_rules! scalar {
    ($(#[doc = $about:literal])+ $name:ident, parameter: $parameter:literal,
     [$($form:expr),*], $expected:literal) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name(pub Scalar, pub(crate) &'static Measure);

        impl Written for $name {
            fn scalar(&self) -> &Scalar {
                &self.0
            }
            fn measure(&self) -> &'static Measure {
                self.1
            }
        }

        impl FromNode for $name {
            const FORM: Form = Form::Defined {
                definition: &Definition {
                    name: stringify!($name),
                    about: concat!($($about),+),
                    form: Form::AnyOf { forms: &[Form::Number, $($form),*] },
                },
            };
            fn from_node(reader: Reader) -> Result<Self, Unread> {
                // Whether its unit is the right one is a question of validation.
                read_scalar(reader, $parameter, $expected).map(|scalar| $name(scalar, reader.measure))
            }
        }
    };
}

/// Numbers with units, as [`Quantity`] reads them.
const QUANTITY: Form = Form::Pattern {
    pattern: r"^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*[A-Za-z%°1][A-Za-z%°1234²³⁴^/·() ]*$",
};
/// Multiples of π, and fractions of degrees.
const ANGLE: Form = Form::Pattern {
    pattern: r"^\s*(-?([0-9.]+([eE][-+]?[0-9]+)?(\s*/\s*[0-9.]+)?)?\s*pi|-?[0-9.]+([eE][-+]?[0-9]+)?(\s*/\s*[0-9.]+)?\s*deg)\s*$",
};
/// Names of parameters.
const NAME: Form = Form::Pattern { pattern: "^[a-z][a-z0-9_]*$" };

scalar! {
    /// A number in SI units, or with its unit, such as `3600 mm`; or the name of a parameter.
    Number, parameter: true, [QUANTITY, NAME], "a number in SI units, one with its unit such as `3600 mm`, or the name of a parameter"
}
scalar! {
    /// An angle in rad, or written `90 deg`, `45°`, `7/18 pi`; or the name of a parameter. Where a length is allowed as
    /// well, as for a drive of a prismatic joint, a number in m, or with its unit.
    Angle, parameter: true, [QUANTITY, ANGLE, NAME], "a number, an angle such as `90 deg` or `7/18 pi`, or the name of a parameter"
}
scalar! {
    /// A number in SI units, or with its unit, such as `80 l/min`; fixed when the crane is compiled.
    Constant, parameter: false, [QUANTITY], "a number, which cannot be a parameter here"
}
scalar! {
    /// An angle in rad, or written `90 deg`, `45°`, `7/18 pi`, or another number in SI units or with its unit; fixed when the crane
    /// is compiled.
    FixedAngle, parameter: false, [QUANTITY, ANGLE], "a number or an angle such as `90 deg`, which cannot be a parameter here"
}

#[cfg(test)]
mod tests {
    use super::is_name;

    #[test]
    fn names_are_words() {
        assert!(is_name("load_mass"));
        for word in ["5 kg", "1/2", "", "-pi"] {
            assert!(!is_name(word), "{word}");
        }
    }
}
