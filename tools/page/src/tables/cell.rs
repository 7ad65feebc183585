//! Fields of tables: what people read, and what programs do.

use serde_json::Value;

/// A unit in which people read numbers that are in SI for programs and in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// °, for rad.
    Degree,
    /// Of pressures, for Pa.
    Bar,
    /// Of stresses, for Pa.
    Megapascal,
    /// For m.
    Millimetre,
    /// Of a ratio.
    Percent,
}

impl Scale {
    const ALL: [Scale; 5] = [Scale::Degree, Scale::Bar, Scale::Megapascal, Scale::Millimetre, Scale::Percent];

    /// The scale of a unit; `None` for units that everybody reads.
    #[must_use]
    pub fn of(unit: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scale| scale.unit() == unit)
    }

    /// Its unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Scale::Degree => "°",
            Scale::Bar => "bar",
            Scale::Megapascal => "MPa",
            Scale::Millimetre => "mm",
            Scale::Percent => "%",
        }
    }

    /// The unit in SI.
    #[must_use]
    pub fn si(self) -> &'static str {
        match self {
            Scale::Degree => "rad",
            Scale::Bar | Scale::Megapascal => "Pa",
            Scale::Millimetre => "m",
            Scale::Percent => "1",
        }
    }

    /// A number in SI as people read it.
    fn shown(self, number: f64) -> f64 {
        match self {
            Scale::Degree => number.to_degrees(),
            Scale::Bar => number / 1e5,
            Scale::Megapascal => number / 1e6,
            Scale::Millimetre => number * 1e3,
            Scale::Percent => number * 100.0,
        }
    }
}

/// The unit of a column in SI.
pub(super) fn si(unit: &str) -> &str {
    match Scale::of(unit) {
        Some(scale) => scale.si(),
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
    /// An angle, rad: in degrees for people.
    Angle(f64),
    /// The unit of angles in its row, rad: degrees for people.
    AngleUnit,
    /// A number in SI that people read in another unit.
    Shown(f64, Scale),
    /// The unit of such numbers in its row.
    ShownUnit(Scale),
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
        Scale::of(unit).map_or(Cell::Number(number), |scale| Cell::Shown(number, scale))
    }

    /// Its number as people read it.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Cell::Number(number) | Cell::Error(number) | Cell::Uncertainty(number) => Some(*number),
            Cell::Angle(radians) => Some(radians.to_degrees()),
            Cell::Shown(number, scale) => Some(scale.shown(*number)),
            Cell::Change(change) => Some(100.0 * change),
            Cell::Text(_) | Cell::AngleUnit | Cell::ShownUnit(_) | Cell::Names(_) | Cell::Count(_) | Cell::Empty => {
                None
            }
        }
    }

    /// What people read: four digits, degrees.
    pub(super) fn text(&self) -> String {
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
            Cell::Angle(radians) => with_digits(radians.to_degrees(), digits),
            Cell::AngleUnit => "°".to_owned(),
            Cell::Shown(number, scale) => with_digits(scale.shown(*number), digits),
            Cell::ShownUnit(scale) => scale.unit().to_owned(),
            Cell::Error(error) => format!("{error:.1e}"),
            Cell::Uncertainty(error) => uncertain(*error),
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
            | Cell::Angle(number)
            | Cell::Shown(number, _)
            | Cell::Change(number) => (*number).into(),
            Cell::ShownUnit(scale) => scale.si().into(),
            Cell::Names(names) => names.as_slice().into(),
            Cell::AngleUnit => "rad".into(),
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
    use super::*;

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
        let angle = Cell::Angle(std::f64::consts::FRAC_PI_3);
        assert_eq!((angle.text().as_str(), angle.json()), ("60.00", std::f64::consts::FRAC_PI_3.into()));
        let pressure = Cell::shown(2.35e7, "bar");
        assert_eq!((pressure.text().as_str(), pressure.json()), ("235", Value::from(2.35e7)));
        let unit = Cell::ShownUnit(Scale::Bar);
        assert_eq!((unit.text().as_str(), unit.json()), ("bar", Value::from("Pa")));
        let change = Cell::Change(0.0123);
        assert_eq!((change.text().as_str(), change.json()), ("+1.23", Value::from(0.0123)));
        assert_eq!(Cell::shown(2.5, "Hz").json(), Value::from(2.5));
        assert_eq!(Cell::Number(14270.44).with_digits(DIGITS_OF_DOCUMENTS), "14270.4");
    }
}
