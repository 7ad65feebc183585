//! Numbers and angles, as written.

use std::f64::consts::PI;

use super::Spanned;
use crate::node::{Content, Definition, Form, FromNode, Reader, Unread};

/// Three numbers along x, y, z.
pub type Vector = [Spanned<Number>; 3];

/// The forms of a number.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    /// A plain number, in SI units.
    Number(f64),
    /// An angle such as `90 deg` or `7/18 pi`, in rad.
    Angle(f64),
    /// Name of a parameter.
    Name(String),
}

impl Scalar {
    /// Reads a word: an angle or a name.
    fn from_word(word: &str) -> Option<Scalar> {
        if let Some(angle) = parse_angle(word) {
            return Some(Scalar::Angle(angle));
        }
        let named = word.starts_with(|c: char| c.is_alphabetic() || c == '_')
            && word.chars().all(|c| c.is_alphanumeric() || c == '_');
        named.then(|| Scalar::Name(word.to_owned()))
    }
}

/// Reads `[−][a[/b]] pi` or `a[/b] deg`, in rad. Rational multiples of π are evaluated as `(a π)/b`, so that
/// `1/2 pi` is the double nearest to π/2.
pub fn parse_angle(word: &str) -> Option<f64> {
    let word = word.trim();
    // The number of units in half a turn, and whether a factor of one may be omitted.
    let (ratio, half_turn, bare) = match word.strip_suffix("pi") {
        Some(ratio) => (ratio, 1.0, true),
        None => (word.strip_suffix("deg")?, 180.0, false),
    };
    let (numerator, denominator) = match ratio.split_once('/') {
        Some((a, b)) => (a, plain_number(b)?),
        None => (ratio, 1.0),
    };
    let numerator = match numerator.trim() {
        "" if bare => 1.0,
        "-" if bare => -1.0,
        number => plain_number(number)?,
    };
    Some(numerator * PI / (denominator * half_turn))
}

/// A decimal number; words that Rust reads as numbers, such as `nan`, are not accepted.
fn plain_number(text: &str) -> Option<f64> {
    let text = text.trim();
    let decimal = text.ends_with(|c: char| c.is_ascii_digit() || c == '.');
    text.parse().ok().filter(|_| decimal)
}

/// Reads a [`Scalar`] of permitted forms; `expected` are these in messages.
fn read_scalar(reader: Reader, angle: bool, name: bool, expected: &str) -> Result<Scalar, Unread> {
    let scalar = match reader.content()? {
        Content::Number(number) => Some(Scalar::Number(*number)),
        Content::Text(word) => Scalar::from_word(word),
        _ => None,
    };
    let permitted = scalar.filter(|scalar| match scalar {
        Scalar::Number(_) => true,
        Scalar::Angle(_) => angle,
        Scalar::Name(_) => name,
    });
    permitted.ok_or_else(|| Unread::Expected(expected.to_owned()))
}

/// Declares a kind of number: its forms, whether it may be an angle and a parameter, and the expectation in messages.
macro_rules! scalar {
    ($(#[doc = $about:literal])+ $name:ident, angle: $angle:literal, parameter: $parameter:literal,
     [$($form:expr),*], $expected:literal) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name(pub Scalar);

        impl FromNode for $name {
            const FORM: Form = Form::Defined {
                definition: &Definition {
                    name: stringify!($name),
                    about: concat!($($about),+),
                    form: Form::AnyOf { forms: &[Form::Number, $($form),*] },
                },
            };
            fn from_node(reader: Reader) -> Result<Self, Unread> {
                // An angle in place of a number gets a separate message from validation.
                read_scalar(reader, $angle || $parameter, $parameter, $expected).map($name)
            }
        }
    };
}

/// Angles as [`parse_angle`] reads them.
const ANGLE: Form = Form::Pattern {
    pattern: r"^\s*(-?([0-9.]+([eE][-+]?[0-9]+)?(\s*/\s*[0-9.]+)?)?\s*pi|-?[0-9.]+([eE][-+]?[0-9]+)?(\s*/\s*[0-9.]+)?\s*deg)\s*$",
};
/// Names of parameters.
const NAME: Form = Form::Pattern { pattern: "^[a-z][a-z0-9_]*$" };

scalar! {
    /// A number in SI units, or the name of a parameter.
    Number, angle: false, parameter: true, [NAME], "a number in SI units without its unit, or the name of a parameter"
}
scalar! {
    /// An angle in rad, or written `90 deg`, `7/18 pi`; or the name of a parameter. Where a length is allowed as
    /// well, as for a drive of a prismatic joint, a number in m.
    Angle, angle: true, parameter: true, [ANGLE, NAME], "a number, an angle such as `90 deg` or `7/18 pi`, or the name of a parameter"
}
scalar! {
    /// A number in SI units, fixed when the crane is compiled.
    Constant, angle: false, parameter: false, [], "a number, which cannot be a parameter here"
}
scalar! {
    /// An angle in rad, or written `90 deg`, `7/18 pi`, or another number in SI units; fixed when the crane is
    /// compiled.
    FixedAngle, angle: true, parameter: false, [ANGLE], "a number or an angle such as `90 deg`, which cannot be a parameter here"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_rational_multiples_of_pi() {
        for (word, angle) in [
            ("90 deg", PI / 2.0),
            ("-90deg", -PI / 2.0),
            ("7/18 pi", 7.0 * PI / 18.0),
            ("-pi", -PI),
            ("pi", PI),
            ("1.5 pi", 1.5 * PI),
            ("2pi", 2.0 * PI),
            ("3/2 pi", 1.5 * PI),
            ("45/2 deg", PI / 8.0),
            ("1e-3 deg", PI / 180_000.0),
        ] {
            // One rounding of the product, one of the quotient.
            let read = parse_angle(word).unwrap_or_else(|| panic!("{word} is an angle"));
            assert!((read - angle).abs() <= 2.0 * f64::EPSILON * angle.abs(), "{word}: {read} {angle}");
        }
    }

    #[test]
    fn other_words_are_no_angles() {
        for word in ["deg", "pie", "1/2", "nan pi", "inf deg", "1//2 pi", "90 degrees", "pi/2", "", "x pi", "- deg"] {
            assert_eq!(parse_angle(word), None, "{word}");
        }
        assert_eq!(Scalar::from_word("load_mass"), Some(Scalar::Name("load_mass".into())));
        assert_eq!(Scalar::from_word("5 kg"), None);
    }
}
