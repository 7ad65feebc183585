//! Numbers as arguments: what is allowed, and what to write instead.

use std::num::NonZeroUsize;

use crane_codegen::units::number_in;

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// A length of time.
///
/// # Errors
/// It is not a number; the message says what to write instead.
pub fn seconds(text: &str) -> Result<f64, String> {
    finite(text).ok_or_else(|| "write a number of seconds, such as 0.5".to_owned())
}

/// A time of at least zero.
pub fn duration(text: &str) -> Result<f64, String> {
    let number = finite(text).filter(|number| *number >= 0.0);
    number.ok_or_else(|| "write a number of seconds of at least 0, such as 0.065".to_owned())
}

/// Two durations, separated by a comma.
pub fn two_durations(text: &str) -> Result<[f64; 2], String> {
    let two = text.split_once(',').map(|(one, other)| (duration(one.trim()), duration(other.trim())));
    match two {
        Some((Ok(one), Ok(other))) => Ok([one, other]),
        _ => Err("write two numbers of seconds, such as 0.3,0.03".to_owned()),
    }
}

/// Any finite number.
pub fn finite_number(text: &str) -> Result<f64, String> {
    finite(text).ok_or_else(|| "write a number, such as 1.3".to_owned())
}

/// An angle.
pub fn angle(text: &str) -> Result<f64, String> {
    number_in("rad", text, "the angle").map_err(|_| "write an angle, such as 45deg, or radians".to_owned())
}

/// An error tolerance.
pub fn tolerance(text: &str) -> Result<f64, String> {
    finite(text).ok_or_else(|| "write a number, such as 1e-4".to_owned())
}

/// A tipping margin.
pub fn margin(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    number
        .filter(|margin| (0.0..1.0).contains(margin))
        .ok_or_else(|| "write a number from 0 to below 1, such as 0.25".to_owned())
}

/// A number above zero.
pub fn above_zero(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    number
        .filter(|number| *number > 0.0 && number.is_finite())
        .ok_or_else(|| "write a number above 0, such as 0.8".to_owned())
}

/// A part of something, as a number or in per cent.
pub fn part(text: &str) -> Result<f64, String> {
    let (number, scale) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 100.0));
    finite(number.trim())
        .map(|number| number / scale)
        .filter(|part| *part != 0.0 && part.abs() <= 1.0)
        .ok_or_else(|| "write a part other than 0, at most 1, such as 10% or -0.05".to_owned())
}

/// A number of things, at least one.
pub fn count(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| "write a whole number of 1 or more, such as 4".to_owned())
}
