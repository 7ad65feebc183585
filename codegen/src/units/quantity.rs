//! Numbers with units.

use std::f64::consts::PI;

use super::{Dimension, Unit, UnknownUnit};

/// A number with a unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// The number, in the SI unit of its dimension.
    pub value: f64,
    /// Its dimension.
    pub dimension: Dimension,
    /// As it was written.
    pub written: String,
}

/// Why a text is not a number of a unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongQuantity {
    /// What is wrong; it follows the name of what is set.
    pub problem: String,
    /// What to write instead.
    pub help: String,
}

impl Quantity {
    /// Reads `320 bar`, `45°` or `7/18 pi`; `None` if the text is not a number and something that could be a unit.
    ///
    /// # Errors
    /// It has an unknown unit.
    pub fn parse(text: &str) -> Option<Result<Quantity, UnknownUnit>> {
        let text = text.trim();
        if let Some(value) = parse_angle(text) {
            let dimension = Dimension([0, 0, 0, 1]);
            return Some(Ok(Quantity { value, dimension, written: text.to_owned() }));
        }
        let (number, unit) = text.split_at(length_of_number(text)?);
        let unit = unit.trim_start();
        let begins = |c: char| c.is_alphabetic() || c == '%' || c == '°' || c == '1';
        let continues = |c: char| begins(c) || "²³⁴234^/·() ".contains(c);
        if !unit.starts_with(begins) || !unit.chars().all(continues) {
            return None;
        }
        Some(Unit::parse(unit).map(|unit| {
            let value = scaled(number, &unit);
            Quantity { value, dimension: unit.dimension, written: text.to_owned() }
        }))
    }

    /// A plain number and the unit that stands beside it; `None` if there is none in the table.
    #[must_use]
    pub fn labelled(value: f64, unit: &str) -> Option<Quantity> {
        let dimension = Unit::parse(unit).ok().filter(|_| !unit.trim().is_empty())?.dimension;
        Some(Quantity { value, dimension, written: format!("{value} {unit}") })
    }

    /// What is wrong with it where a number in an SI unit must stand, and what to write instead.
    #[must_use]
    pub fn wrong_for(&self, unit: &str) -> Option<WrongQuantity> {
        let wanted = Unit::parse(unit).ok()?.dimension;
        if wanted == self.dimension {
            return None;
        }
        let ((name, own), written) = (self.dimension.name_and_unit(), &self.written);
        Some(match unit {
            "" | "1" => WrongQuantity {
                problem: format!("has no unit, and `{written}` is {name} ({own})"),
                help: "write a number without a unit, or with `%`".to_owned(),
            },
            unit => WrongQuantity {
                problem: format!("is in {unit}, and `{written}` is {name} ({own})"),
                help: if unit
                    .strip_suffix("/s")
                    .and_then(|way| Unit::parse(way).ok())
                    .is_some_and(|way| way.dimension == self.dimension)
                {
                    format!("did you mean `{written}/s`? Else write a number in {unit}")
                } else {
                    format!("write a number in {unit}, or one with a unit of the same dimension")
                },
            },
        })
    }
}

/// The name and the unit of a column of a table, which its heading gives in brackets: `load [t]`.
#[must_use]
pub fn name_and_unit(heading: &str) -> (&str, Option<&str>) {
    let bracketed = heading.trim().strip_suffix(']').and_then(|rest| rest.split_once('['));
    bracketed.map_or((heading.trim(), None), |(name, unit)| (name.trim_end(), Some(unit.trim())))
}

/// Reads a number in an SI unit, or one with a unit of the same dimension: arguments of commands. `unit` may be any text; what is not in the table
/// admits numbers alone. `subject` is what is set.
///
/// # Errors
/// It is neither; the error says what to write instead.
pub fn number_in(unit: &str, text: &str, subject: &str) -> Result<f64, WrongQuantity> {
    let text = text.trim();
    let known = Unit::parse(unit).ok().filter(Unit::is_si);
    let invalid = || {
        let in_unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
        let example = if unit.is_empty() || known.is_none() { String::new() } else { example(unit) };
        WrongQuantity {
            problem: format!("`{text}` is not a valid value for {subject}"),
            help: format!("write a finite number{in_unit}{example}"),
        }
    };
    let quantity = match (text.parse::<f64>(), Quantity::parse(text)) {
        (Ok(number), _) => return if number.is_finite() { Ok(number) } else { Err(invalid()) },
        (_, None) => return Err(invalid()),
        (_, Some(Err(UnknownUnit { symbol, help }))) => {
            let problem = format!("`{text}` is not a valid value for {subject}: there is no unit `{symbol}`");
            return Err(WrongQuantity { problem, help });
        }
        (_, Some(Ok(quantity))) => quantity,
    };
    if known.is_none() {
        // Its numbers are in a unit of the spec's own, in which nothing can be converted.
        return Err(WrongQuantity {
            problem: format!("{subject} is in {unit}, which is not an SI unit, so `{text}` cannot be converted"),
            help: format!("write a number in {unit} without its unit"),
        });
    }
    match quantity.wrong_for(unit) {
        Some(wrong) => Err(WrongQuantity { problem: format!("{subject} {}", wrong.problem), ..wrong }),
        None if quantity.value.is_finite() => Ok(quantity.value),
        None => Err(invalid()),
    }
}

/// The number and the unit of a text, `60` and `deg` of `60deg`, as they are written; `None` if it does not begin with a number.
#[must_use]
pub fn split(text: &str) -> Option<(&str, &str)> {
    let (number, unit) = text.trim().split_at(length_of_number(text.trim())?);
    Some((number, unit.trim_start()))
}

/// A number with a unit of the same dimension, as an example.
fn example(unit: &str) -> String {
    let example = match unit {
        "rad" => return ", or an angle such as `30deg`".to_owned(),
        "m" => "3600mm",
        "kg" => "1.2t",
        "N" => "4kN",
        "N m" => "30kN m",
        "Pa" => "320bar",
        "m³/s" => "80l/min",
        _ => return String::new(),
    };
    format!(", or one with its unit, such as `{example}`")
}

/// Length of the decimal number with which a text begins.
fn length_of_number(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let sign = usize::from(bytes.first().is_some_and(|byte| b"+-".contains(byte)));
    let whole = digits(sign);
    let mut end = sign + whole;
    if bytes.get(end) == Some(&b'.') {
        let part = digits(end + 1);
        if whole + part == 0 {
            return None;
        }
        end += 1 + part;
    } else if whole == 0 {
        return None;
    }
    if bytes.get(end).is_some_and(|byte| b"eE".contains(byte)) {
        let sign = usize::from(bytes.get(end + 1).is_some_and(|byte| b"+-".contains(byte)));
        let power = if end + 1 + sign <= bytes.len() { digits(end + 1 + sign) } else { 0 };
        if power > 0 {
            end += 1 + sign + power;
        }
    }
    Some(end)
}

/// A decimal number times a unit, in SI: powers of ten move its exponent, so that `3600 mm` is the double nearest to 3.6.
fn scaled(number: &str, unit: &Unit) -> f64 {
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let Ok(exponent) = exponent.parse::<i32>() else { return number.parse().unwrap_or(f64::NAN) };
    let exponent = exponent.saturating_add(unit.tens);
    let decimal = match unit.sixties {
        0 => format!("{mantissa}e{exponent}"),
        sixties => times_sixties(mantissa, exponent, sixties),
    };
    let value: f64 = decimal.parse().unwrap_or(f64::NAN);
    match unit.degrees {
        0 => value,
        degrees if degrees > 0 => (0..degrees).fold(value, |value, _| value * PI / 180.0),
        degrees => (degrees..0).fold(value, |value, _| value * 180.0 / PI),
    }
}

/// A decimal number times a power of 60, as a decimal number: exact for products; quotients have 40 digits more and one that shows whether
/// anything remains, which decides how a double is rounded.
fn times_sixties(mantissa: &str, mut exponent: i32, sixties: i32) -> String {
    const MORE: usize = 40;
    let sign = if mantissa.starts_with('-') { "-" } else { "" };
    let (whole, part) = mantissa.trim_start_matches(['-', '+']).split_once('.').unwrap_or((mantissa, ""));
    let mut digits: Vec<u64> =
        whole.bytes().chain(part.bytes()).filter(u8::is_ascii_digit).map(|byte| u64::from(byte - b'0')).collect();
    exponent = exponent.saturating_sub(i32::try_from(part.len()).unwrap_or(i32::MAX)).saturating_add(sixties);
    // Powers of ten of the 60 are in the exponent.
    for _ in 0..sixties {
        let mut carry = 0;
        for digit in digits.iter_mut().rev() {
            carry += *digit * 6;
            *digit = carry % 10;
            carry /= 10;
        }
        digits.insert(0, carry);
    }
    for _ in sixties..0 {
        digits.extend([0; MORE]);
        let mut rest = 0;
        for digit in &mut digits {
            rest = rest * 10 + *digit;
            *digit = rest / 6;
            rest %= 6;
        }
        digits.push(u64::from(rest > 0));
        exponent = exponent.saturating_sub(i32::try_from(MORE + 1).unwrap_or(0));
    }
    let digits: String = digits.iter().map(u64::to_string).collect();
    format!("{sign}{digits}e{exponent}")
}

/// Reads `[−][a[/b]] pi` or `a[/b] deg`, in rad. Rational multiples of π are evaluated as `(a π)/b`, so that
/// `1/2 pi` is the double nearest to π/2.
fn parse_angle(word: &str) -> Option<f64> {
    // The number of units in half a turn, and whether a factor of one may be omitted.
    let (ratio, half_turn, bare) = match word.strip_suffix("pi") {
        Some(ratio) => (ratio, 1.0, true),
        None => (word.strip_suffix("deg").or_else(|| word.strip_suffix('°'))?, 180.0, false),
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

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let read = Quantity::parse(text).unwrap_or_else(|| panic!("{text} is a number with a unit"));
        read.unwrap_or_else(|unknown| panic!("{text}: {unknown:?}")).value
    }

    /// Decimal units: the double nearest to the number in SI, to the bit. Of quotients by 60, the division of whole numbers, which rounds once.
    #[test]
    fn conversion_rounds_once() {
        for (text, si) in [
            ("3600 mm", 3.6),
            ("0.1 mm", 1e-4),
            ("1234.5678e-2 mm", 0.012_345_678),
            ("320 bar", 32e6),
            ("4 kN/mm", 4e6),
            ("1.2 t", 1200.0),
            ("30 kN m", 30e3),
            ("0.5 m/s", 0.5),
            ("7.85 t/m³", 7850.0),
            ("7.85 t/m^3", 7850.0),
            ("7.85 kg/dm3", 7850.0),
            ("210 GPa", 210e9),
            ("235 N/mm²", 235e6),
            ("3 %", 0.03),
            ("3%", 0.03),
            ("33.3 cm4", 33.3e-8),
            ("-2 l", -0.002),
            ("80 l/min", 80.0 / 60_000.0),
            ("7.3 l/min", 73.0 / 600_000.0),
            ("-7 m/min", -7.0 / 60.0),
            ("36 km/h", 10.0),
            ("1.7 h", 6120.0),
            ("3 min", 180.0),
            ("2e-11 m³/(s Pa)", 2e-11),
            ("5e3 N", 5000.0),
        ] {
            assert_eq!(value(text).to_bits(), f64::to_bits(si), "{text}: {} {si}", value(text));
        }
        // All millimetres: no product with 0.001 would do (1 of 3 would differ).
        for whole in 0..20_000_u32 {
            assert_eq!(value(&format!("{whole} mm")), f64::from(whole) / 1000.0);
            assert_eq!(value(&format!("{whole} l/min")), f64::from(whole) / 60_000.0);
        }
    }

    #[test]
    fn angles_are_rational_multiples_of_pi() {
        for (word, angle) in [
            ("90 deg", PI / 2.0),
            ("-90deg", -PI / 2.0),
            ("45°", PI / 4.0),
            ("7/18 pi", 7.0 * PI / 18.0),
            ("-pi", -PI),
            ("pi", PI),
            ("1.5 pi", 1.5 * PI),
            ("2pi", 2.0 * PI),
            ("3/2 pi", 1.5 * PI),
            ("45/2 deg", PI / 8.0),
            ("1e-3 deg", PI / 180_000.0),
            ("6 deg/s", PI / 30.0),
            ("10 rpm", PI / 3.0),
            ("0.5 rad", 0.5),
            ("12 mrad", 0.012),
        ] {
            // One rounding of the product, one of the quotient.
            assert!((value(word) - angle).abs() <= 2.0 * f64::EPSILON * angle.abs(), "{word}: {} {angle}", value(word));
        }
        assert!((value("3 kN m/deg") * PI / 180.0 - 3000.0).abs() <= 1e-12 * 3000.0);
    }

    #[test]
    fn other_words_are_no_quantities() {
        for word in [
            "deg", "pie", "1/2", "nan pi", "inf deg", "1//2 pi", "pi/2", "", "x pi", "- deg", "mm", "5", "-", ".",
            "1,200 mm", "1 2 m", "5e",
        ] {
            let read = Quantity::parse(word);
            assert!(!matches!(read, Some(Ok(_))), "{word}: {read:?}");
        }
        for (word, help) in [
            ("90 degrees", "did you mean `deg`?"),
            ("5 kgs", "did you mean `kg`?"),
            ("5 Bar", "did you mean `bar`?"),
            ("3 KN", "did you mean `kN`?"),
            ("3 kNm", "did you mean `kN m`?"),
        ] {
            assert_eq!(Quantity::parse(word).and_then(Result::err).expect(word).help, help, "{word}");
        }
    }

    #[test]
    fn a_wrong_dimension_names_both_units() {
        let quantity = Quantity::parse("320 bar").expect("a quantity").expect("a unit");
        assert_eq!(quantity.wrong_for("m").expect("no length").problem, "is in m, and `320 bar` is a pressure (Pa)");
        assert_eq!(quantity.wrong_for("").expect("no number").problem, "has no unit, and `320 bar` is a pressure (Pa)");
        assert_eq!(quantity.wrong_for("Pa"), None);
        assert_eq!(number_in("kg", "1.5t", "load"), Ok(1500.0));
        assert_eq!(number_in("turns", "2", "load"), Ok(2.0));
        for (unit, text, problem) in [
            ("turns", "2 m", "load is in turns, which is not an SI unit, so `2 m` cannot be converted"),
            ("t", "2 kg", "load is in t, which is not an SI unit, so `2 kg` cannot be converted"),
            ("m", "1e999 mm", "`1e999 mm` is not a valid value for load"),
            ("kg", "nan", "`nan` is not a valid value for load"),
            ("kg", "2 kgs", "`2 kgs` is not a valid value for load: there is no unit `kgs`"),
            ("kg", "2 m", "load is in kg, and `2 m` is a length (m)"),
        ] {
            assert_eq!(number_in(unit, text, "load").expect_err(text).problem, problem);
        }
    }
}
