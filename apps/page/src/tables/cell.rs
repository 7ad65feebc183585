//! Fields of tables: what people read, and what programs do.

use crane_model::DisplayUnit;
use serde_json::Value;

/// The unit of a column in SI.
pub(super) fn si(unit: &str) -> &str {
    match DisplayUnit::find(unit) {
        Some(unit) => unit.si(),
        None => unit,
    }
}

/// One field of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// A name or a sentence.
    Text(String),
    /// A number.
    Number(f64),
    /// A relative error: its size is what matters.
    Error(f64),
    /// An absolute error, in the unit of its row: two digits are enough.
    Uncertainty(f64),
    /// An absolute error in SI that people read in another unit.
    ShownUncertainty(f64, DisplayUnit),
    /// A number in SI that people read in another unit.
    Shown(f64, DisplayUnit),
    /// The unit of such numbers in its row.
    ShownUnit(DisplayUnit),
    /// A relative change, with its sign; % for people.
    Change(f64),
    /// Several names.
    Names(Vec<String>),
    /// A count.
    Count(usize),
    /// Nothing to say.
    Empty,
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Cell::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Cell::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Cell::Number(number)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Cell::Count(count)
    }
}

impl From<Option<f64>> for Cell {
    fn from(number: Option<f64>) -> Self {
        number.map_or(Cell::Empty, Cell::Number)
    }
}

impl Cell {
    /// A number in SI that people read in a unit; `unit` may be one of SI.
    #[must_use]
    pub fn shown(number: f64, unit: &str) -> Self {
        DisplayUnit::find(unit).map_or(Cell::Number(number), |unit| Cell::Shown(number, unit))
    }

    /// A number in a unit of SI, as people read all numbers of that unit: pressures in bar, angles in degrees.
    #[must_use]
    pub fn of_unit(number: f64, si: &str) -> Self {
        DisplayUnit::always(si).map_or(Cell::Number(number), |unit| Cell::Shown(number, unit))
    }

    /// An absolute error in that unit.
    #[must_use]
    pub fn error_of_unit(error: f64, si: &str) -> Self {
        DisplayUnit::always(si).map_or(Cell::Uncertainty(error), |unit| Cell::ShownUncertainty(error, unit))
    }

    /// A time of a result, s, without the rounding of its sum: 2.28 instead of 2.2800000000000002.
    #[must_use]
    pub fn instant(time: f64) -> Self {
        format!("{time:.9}").parse().unwrap_or(time).into()
    }

    /// That unit.
    #[must_use]
    pub fn unit_of(si: &str) -> Self {
        DisplayUnit::always(si).map_or_else(|| si.into(), Cell::ShownUnit)
    }

    /// Its number as people read it.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Cell::Number(number) | Cell::Error(number) | Cell::Uncertainty(number) => Some(*number),
            Cell::Shown(number, unit) | Cell::ShownUncertainty(number, unit) => Some(unit.shown(*number)),
            Cell::Change(change) => Some(100.0 * change),
            Cell::Text(_) | Cell::ShownUnit(_) | Cell::Names(_) | Cell::Count(_) | Cell::Empty => None,
        }
    }

    /// What people read: four digits, degrees.
    pub(crate) fn text(&self) -> String {
        self.with_digits(DIGITS)
    }

    /// The same on a screen, where lists of names are cut off.
    #[must_use]
    pub fn short(&self) -> String {
        /// Names that a line has room for.
        const MOST: usize = 3;
        match self {
            Cell::Names(names) if names.len() > MOST => format!("{}, …", names[..MOST].join(", ")),
            _ => self.text(),
        }
    }

    pub(super) fn with_digits(&self, digits: i32) -> String {
        match self {
            Cell::Text(text) => text.clone(),
            Cell::Number(number) => with_digits(*number, digits),
            Cell::Shown(number, unit) => with_digits(unit.shown(*number), digits),
            Cell::ShownUnit(unit) => unit.unit().to_owned(),
            Cell::Error(error) => format!("{error:.1e}"),
            Cell::Uncertainty(error) => uncertain(*error),
            Cell::ShownUncertainty(error, unit) => uncertain(unit.shown(*error)),
            Cell::Change(change) => format!("{:+.2}", 100.0 * change),
            Cell::Names(names) => names.join(", "),
            Cell::Count(count) => count.to_string(),
            Cell::Empty => "–".to_owned(),
        }
    }

    /// All digits, angles in degrees as on the screen, all names; empty where the text has everything already.
    pub(super) fn exact(&self) -> String {
        match self {
            Cell::Names(_) => self.text(),
            other => other.number().map_or_else(String::new, number_text),
        }
    }

    pub(super) fn json(&self) -> Value {
        match self {
            Cell::Text(text) => text.as_str().into(),
            Cell::Number(number)
            | Cell::Error(number)
            | Cell::Uncertainty(number)
            | Cell::Shown(number, _)
            | Cell::ShownUncertainty(number, _)
            | Cell::Change(number) => (*number).into(),
            Cell::ShownUnit(unit) => unit.si().into(),
            Cell::Names(names) => names.as_slice().into(),
            Cell::Count(count) => (*count).into(),
            Cell::Empty => Value::Null,
        }
    }
}

/// The shortest text that reads back as the same number.
pub fn number_text(number: f64) -> String {
    format!("{number:?}")
}

/// A number with two significant digits, in powers of ten where it is very large or small.
pub(crate) fn uncertain(number: f64) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    let short = format!("{number:.1e}");
    match short.parse::<f64>() {
        Ok(rounded) if (1e-3..1e6).contains(&rounded) => rounded.to_string(),
        _ => short,
    }
}

/// Significant digits on the screen; files have all.
const DIGITS: i32 = 4;
/// Significant digits in documents.
pub(super) const DIGITS_OF_DOCUMENTS: i32 = 6;

/// A number for readers: four digits.
pub(crate) fn readable(number: f64) -> String {
    with_digits(number, DIGITS)
}

/// A number with some significant digits, in powers of ten where it is very large or small; digits before the point are never
/// dropped. Anything below 1e-10 of a unit counts as a rounded zero.
fn with_digits(number: f64, digits: i32) -> String {
    let size = number.abs();
    let plain = number.to_string();
    let short = usize::try_from(digits).unwrap_or(0) + 1;
    if size < 1e-10 {
        "0".to_owned()
    } else if plain.len() <= short {
        plain
    } else if (1e-3..1e7).contains(&size) {
        // Digits before the point; 1e-3 counts as -2.
        let before = (-2..=7).find(|&digits| size < 10_f64.powi(digits)).unwrap_or(7);
        let places = usize::try_from(digits - before).unwrap_or(0);
        format!("{number:.places$}")
    } else {
        let places = usize::try_from(digits - 1).unwrap_or(0);
        format!("{number:.places$e}")
    }
}

#[cfg(test)]
mod tests {
    use crane_codegen::units::Unit;

    use super::*;

    /// Units for people are those that specs may have, too: the same factors, up to their rounding.
    #[test]
    fn units_for_people_are_those_of_specs() {
        for unit in DisplayUnit::ALL {
            let [shown, si] = [unit.unit(), unit.si()].map(|unit| Unit::parse(unit).expect("a unit"));
            assert_eq!((shown.dimension, si.is_si()), (si.dimension, true), "{unit:?}");
            let factor = 10_f64.powi(shown.tens) * 60_f64.powi(shown.sixties) * 1_f64.to_radians().powi(shown.degrees);
            assert!((unit.shown(factor) - 1.0).abs() < 1e-15, "{unit:?}");
        }
    }

    #[test]
    fn people_read_four_digits_and_degrees() {
        for (number, text) in [
            (14270.4, "14270"),
            (3.999_89, "4.000"),
            (0.471_501, "0.4715"),
            (0.02, "0.02"),
            (-6509.11, "-6509"),
            (1.234_56e9, "1.235e9"),
            (1e-12, "0"),
        ] {
            assert_eq!(Cell::Number(number).text(), text);
        }
        let angle = Cell::of_unit(std::f64::consts::FRAC_PI_3, "rad");
        assert_eq!((angle.text().as_str(), angle.json()), ("60.00", std::f64::consts::FRAC_PI_3.into()));
        let pressure = Cell::shown(2.35e7, "bar");
        assert_eq!((pressure.text().as_str(), pressure.json()), ("235", Value::from(2.35e7)));
        let unit = Cell::ShownUnit(DisplayUnit::Bar);
        assert_eq!((unit.text().as_str(), unit.json()), ("bar", Value::from("Pa")));
        let change = Cell::Change(0.0123);
        assert_eq!((change.text().as_str(), change.json()), ("+1.23", Value::from(0.0123)));
        assert_eq!(Cell::shown(2.5, "Hz").json(), Value::from(2.5));
        assert_eq!(Cell::Number(14270.44).with_digits(DIGITS_OF_DOCUMENTS), "14270.4");
    }
}
