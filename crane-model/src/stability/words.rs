//! Descriptions of modes in plain words.

use crate::{CoordinateRole, Description, modes::DampedMode};

/// What moves in a mode and how fast: `torsion of boom elements 3, 2; 22,900 rad/s`.
///
/// The frequency is |λ|, which for a mode that does not oscillate is its decay rate.
pub fn cause(description: &Description, mode: &DampedMode) -> String {
    let mut parts: Vec<(String, Vec<&str>)> = Vec::new();
    for &coordinate in &mode.dominating {
        let (what, element) = moving(description, coordinate);
        let index = parts.iter().position(|(known, _)| *known == what).unwrap_or_else(|| {
            parts.push((what, Vec::new()));
            parts.len() - 1
        });
        parts[index].1.extend(element);
    }
    let spoken = parts.iter().map(|(what, elements)| match elements.as_slice() {
        [] => what.clone(),
        [element] => format!("{what} element {element}"),
        several => format!("{what} elements {}", several.join(", ")),
    });
    let spoken: Vec<String> = spoken.collect();
    let rate = grouped(mode.eigenvalue.norm());
    if spoken.is_empty() { format!("{rate} rad/s") } else { format!("{}; {rate} rad/s", spoken.join(" and ")) }
}

/// What a coordinate does, and the number of its element if it belongs to a flexible link.
fn moving(description: &Description, coordinate: usize) -> (String, Option<&str>) {
    let name = &description.coordinates[coordinate].name;
    match description.coordinates[coordinate].role {
        CoordinateRole::Base => (format!("base ({name})"), None),
        CoordinateRole::Driven | CoordinateRole::Prescribed => {
            let mut cylinders = description.cylinders.iter().filter(|cylinder| cylinder.valve.is_some());
            match cylinders.find(|cylinder| description.drives[cylinder.drive].coordinate == coordinate) {
                Some(cylinder) => (format!("oil of {}", cylinder.name), None),
                None => (format!("drive of {name}"), None),
            }
        }
        CoordinateRole::Passive => (format!("joint {name}"), None),
        CoordinateRole::Element | CoordinateRole::ElementVector => {
            // The rotations of an element are consecutive; the first body that a coordinate moves carries it.
            let body = description.first_moved(coordinate);
            let (link, body) = body.map_or(("", name.as_str()), |body| (&body.link, &body.name));
            let what = match name.rsplit('_').next() {
                Some("psi") => "bending in x-y",
                Some("theta") => "bending in x-z",
                _ => "torsion",
            };
            (format!("{what} of {link}"), body.rsplit('_').next())
        }
    }
}

/// Three significant digits, with thousands separators: 22,900.
pub fn grouped(number: f64) -> String {
    /// Significant digits.
    const DIGITS: usize = 3;
    // 2.29e4: the rounded digits, and the power of ten of the first one.
    let text = format!("{:.*e}", DIGITS - 1, number.abs());
    let Some((digits, Ok(power))) = text.split_once('e').map(|(digits, power)| (digits, power.parse::<usize>())) else {
        return format!("{number:.DIGITS$}");
    };
    let digits: String = digits.chars().filter(char::is_ascii_digit).collect();
    let mut out = if number < 0.0 { "-".to_owned() } else { String::new() };
    for digit in 0..=power.max(digits.len() - 1) {
        if digit == power + 1 {
            out.push('.');
        } else if digit > 0 && digit <= power && (power + 1 - digit).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digits.chars().nth(digit).unwrap_or('0'));
    }
    out
}
