//! Ranges and limits, as arguments name them.

use std::f64::consts::PI;

use crane_codegen::units::split;
use crane_model::{
    CoordinateKind, Description,
    envelope::{Axes, Axis, Varied},
};

use crate::problem::{Outcome, Problem, nearest};
use crate::quantity::{is_bare, number};

/// Maximum number of values of a range.
const MOST: usize = 100_000;

/// What `--range NAME=FROM:TO:COUNT` and `--range NAME=VALUE` ask for.
pub fn read_ranges(ranges: &[String], description: &Description) -> Outcome<Axes> {
    let mut axes: Vec<Axis> = Vec::new();
    for range in ranges {
        let (name, values) = range.split_once('=').ok_or_else(|| {
            Problem::usage(
                format!("`--range {range}` has no values"),
                "write `--range boom_psi=0:60deg:13`, from, to and how many, or one value, `--range telescope_z=1.5`",
            )
        })?;
        let varied = varied(name.trim(), description)?;
        if axes.iter().any(|axis| axis.varied == varied) {
            return Err(Problem::usage(format!("`{name}` has two ranges"), "give each drive and parameter one range"));
        }
        let axis = Axis { varied, values: values_of(name, unit_of(varied, description), values)? };
        if let Some(angle) = axis.implausible_angle(description).filter(|_| values.split(':').all(is_bare)) {
            return Err(Problem::usage(
                format!("`--range {range}` goes to {angle} rad, {:.0}°", angle.to_degrees()),
                format!("write degrees with their unit, `--range {name}={}`", in_degrees(values)),
            ));
        }
        axes.push(axis);
    }
    Ok(Axes(axes))
}

/// Whether a live parameter is on an axis.
pub fn varies(axes: &Axes, parameter: usize) -> bool {
    axes.0.iter().any(|axis| axis.varied == Varied::Parameter(parameter))
}

/// A drive by its coordinate, or by its link if that has only one drive, or a live parameter.
pub fn varied(name: &str, description: &Description) -> Outcome<Varied> {
    if let Some(varied) = Varied::named(name, description) {
        return Ok(varied);
    }
    let driven = super::drives(description);
    let parameters = description.parameters.iter().map(|parameter| parameter.name.as_str());
    if description.coordinates.iter().any(|coordinate| coordinate.name == name) {
        return Err(Problem::usage(
            format!("{name} has no drive: its position follows from equilibrium"),
            format!("driven are {}", driven.join(", ")),
        ));
    }
    let known: Vec<&str> = driven.iter().copied().chain(parameters).collect();
    let guess = nearest(name, known.iter().copied());
    let guess = guess.map_or_else(String::new, |guess| format!("did you mean `{guess}`? "));
    let title = format!("{} has no drive and no live parameter `{name}`", description.name);
    Err(Problem::usage(title, format!("{guess}drives and parameters: {}", known.join(", "))))
}

/// The values of `FROM:TO:COUNT` or of `VALUE`, in a unit.
fn values_of(name: &str, unit: &str, text: &str) -> Outcome<Vec<f64>> {
    let wrong = |what: &str| {
        Problem::usage(
            format!("`--range {name}={text}`: {what}"),
            "write numbers in SI units or with their units, such as `60deg`: `FROM:TO:COUNT` or one value",
        )
    };
    let number = |text: &str| number(unit, text, name);
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    match parts[..] {
        [value] => Ok(vec![number(value)?]),
        [from, to, count] => {
            // A unit after the second number applies to both.
            let unit = match split(to) {
                _ if to.ends_with("deg") => "deg",
                Some((_, unit)) if unit != "pi" && !unit.starts_with('/') => unit,
                _ => "",
            };
            let from_with_unit = if is_bare(from) { format!("{from}{unit}") } else { from.to_owned() };
            let [from, to] = [number(&from_with_unit)?, number(to)?];
            let count: usize = count.parse().map_err(|_| wrong(&format!("`{count}` is not a count")))?;
            if !(2..=MOST).contains(&count) {
                return Err(wrong(&format!("a count must be from 2 to {MOST}")));
            }
            let steps = (count - 1) as f64;
            Ok((0..count).map(|index| from + (to - from) * (index as f64 / steps)).collect())
        }
        _ => Err(wrong("it does not have one or three parts")),
    }
}

/// A range of numbers as one of degrees.
fn in_degrees(values: &str) -> String {
    let parts: Vec<&str> = values.split(':').map(str::trim).collect();
    match parts[..] {
        [from, to, count] => format!("{from}:{to}deg:{count}"),
        _ => format!("{}deg", values.trim()),
    }
}

/// Unit of a drive's position or of a live parameter.
pub fn unit_of(varied: Varied, description: &Description) -> &str {
    match varied {
        Varied::Drive(drive) => description.coordinates[description.drives[drive].coordinate].kind.unit(),
        Varied::Parameter(parameter) => &description.parameters[parameter].unit,
    }
}

/// Limits `NAME=VALUE` of drives or points, infinite where none is given.
pub fn limits(given: &[String], option: &str, what: &str, names: &[&str]) -> Outcome<Vec<f64>> {
    let mut limits = vec![f64::INFINITY; names.len()];
    for limit in given {
        let read = limit.split_once('=').and_then(|(name, value)| Some((name.trim(), value.parse::<f64>().ok()?)));
        let (name, value) = read.filter(|(_, value)| value.is_finite() && *value > 0.0).ok_or_else(|| {
            Problem::usage(
                format!("`--{option} {limit}` is not a limit"),
                format!("write `--{option} NAME=VALUE` with the name of a {what} and a number above zero, in SI units"),
            )
        })?;
        let index = names.iter().position(|known| *known == name).ok_or_else(|| {
            let guess = nearest(name, names.iter().copied());
            let guess = guess.map_or_else(String::new, |guess| format!("did you mean `{guess}`? "));
            Problem::usage(format!("there is no {what} `{name}`"), format!("{guess}{what}s: {}", names.join(", ")))
        })?;
        limits[index] = value;
    }
    Ok(limits)
}

/// Name and unit of what an axis varies, for people (angles in degrees), and the factor for its values.
pub fn shown(axis: &Axis, description: &Description) -> (String, String, f64) {
    match axis.varied {
        Varied::Drive(drive) => {
            let coordinate = &description.coordinates[description.drives[drive].coordinate];
            match coordinate.kind {
                CoordinateKind::Rotation => (coordinate.name.to_string(), "°".to_owned(), 180.0 / PI),
                CoordinateKind::Translation => (coordinate.name.to_string(), "m".to_owned(), 1.0),
            }
        }
        Varied::Parameter(index) => {
            let parameter = &description.parameters[index];
            match parameter.unit.as_str() {
                "rad" => (parameter.name.to_string(), "°".to_owned(), 180.0 / PI),
                unit => (parameter.name.to_string(), unit.to_owned(), 1.0),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_has_its_ends_and_its_unit() {
        let values = values_of("boom", "rad", "-30:60deg:4").unwrap();
        let degrees: Vec<f64> = values.iter().map(|value| value.to_degrees().round()).collect();
        assert_eq!(degrees, [-30.0, 0.0, 30.0, 60.0]);
        assert_eq!(values_of("telescope", "m", "0.5:2:4").unwrap(), [0.5, 1.0, 1.5, 2.0]);
        assert_eq!(values_of("boom", "rad", "1/2 pi").unwrap(), [PI / 2.0]);
        assert_eq!(values_of("boom", "rad", "0:1/2 pi:2").unwrap(), [0.0, PI / 2.0]);
        for wrong in ["", "1:2", "a", "0:1:1", "0:1:2.5", "0:nan:3", "0:1:999999999"] {
            assert!(values_of("boom", "rad", wrong).is_err(), "{wrong}");
        }
    }
}
