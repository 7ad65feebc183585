//! Units as products of symbols: `kN m/deg`.

use super::table::{NAMES, Symbol, TABLE};
use crate::diagnostic::{nearest, suggest};

/// Exponents of m, kg, s and rad.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dimension(pub [i32; 4]);

impl Dimension {
    /// Its SI unit; empty for numbers.
    #[must_use]
    pub fn si_unit(self) -> String {
        if self == Dimension::default() { String::new() } else { self.name_and_unit().1 }
    }

    /// Its name, with an article, and its SI unit.
    #[must_use]
    pub fn name_and_unit(self) -> (&'static str, String) {
        if let Some((_, name, unit)) = NAMES.iter().find(|(dimension, ..)| *dimension == self) {
            return (name, (*unit).to_owned());
        }
        let factor = |(symbol, power): (&str, i32)| match power {
            1 => symbol.to_owned(),
            power => format!("{symbol}^{power}"),
        };
        let powers = ["m", "kg", "s", "rad"].into_iter().zip(self.0).filter(|(_, power)| *power != 0);
        ("another quantity", powers.map(factor).collect::<Vec<_>>().join(" "))
    }
}

/// A unit: 10^`tens` · 60^`sixties` · (π/180)^`degrees` of the SI unit of its dimension.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unit {
    /// Exponents of m, kg, s and rad.
    pub dimension: Dimension,
    /// Exponent of ten.
    pub tens: i32,
    /// Exponent of 60.
    pub sixties: i32,
    /// Exponent of π/180.
    pub degrees: i32,
}

/// A symbol that is not a unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownUnit {
    /// The symbol.
    pub symbol: String,
    /// What to write instead.
    pub help: String,
}

impl Unit {
    /// Reads a unit such as `N m/rad`, `m/s2` or `m³/(s Pa)`: what follows a slash divides. Nothing is the unit of a number alone.
    ///
    /// # Errors
    /// A symbol is not in the table.
    pub fn parse(text: &str) -> Result<Unit, UnknownUnit> {
        let mut unit = Unit::default();
        for (index, part) in text.split('/').enumerate() {
            let sign = if index == 0 { 1 } else { -1 };
            let factors = part.split([' ', '·', '(', ')']).filter(|factor| !factor.is_empty());
            for factor in factors {
                let (symbol, power) = symbol_and_power(factor).ok_or_else(|| unknown(factor))?;
                unit.multiply(symbol, sign * power);
            }
        }
        Ok(unit)
    }

    /// Whether it is the SI unit of its dimension.
    #[must_use]
    pub fn is_si(&self) -> bool {
        [self.tens, self.sixties, self.degrees] == [0; 3]
    }

    fn multiply(&mut self, symbol: &Symbol, power: i32) {
        self.dimension.0.iter_mut().zip(symbol.dimension.0).for_each(|(sum, exponent)| *sum += power * exponent);
        self.tens += power * symbol.tens;
        self.sixties += power * symbol.sixties;
        self.degrees += power * symbol.degrees;
    }
}

/// A symbol, and the power to which it is raised: `m³`, `m3` or `m^3`.
fn symbol_and_power(factor: &str) -> Option<(&'static Symbol, i32)> {
    let named = |text: &str| TABLE.iter().find(|symbol| symbol.text == text);
    if let Some(symbol) = named(factor) {
        return Some((symbol, 1));
    }
    let powers = [(['²', '2'], 2), (['³', '3'], 3), (['⁴', '4'], 4)];
    let (symbol, power) = powers.into_iter().find_map(|(digits, power)| Some((factor.strip_suffix(digits)?, power)))?;
    Some((named(symbol.strip_suffix('^').unwrap_or(symbol))?, power))
}

fn unknown(symbol: &str) -> UnknownUnit {
    let known = || TABLE.iter().map(|symbol| symbol.text).filter(|text| *text != "1");
    // `Bar`, `KN` and `degrees` are nearer than their letters say.
    let same_letters = known().find(|text| text.to_lowercase() == symbol.to_lowercase());
    let spelt_out = [
        ("deg", "deg"),
        ("met", "m"),
        ("sec", "s"),
        ("lit", "l"),
        ("L", "l"),
        ("ton", "t"),
        ("Nm", "N m"),
        ("kNm", "kN m"),
    ];
    let spelt_out = spelt_out.into_iter().find(|(begin, _)| symbol.starts_with(begin)).map(|(_, unit)| unit);
    let help = match same_letters.or(spelt_out).or_else(|| nearest(symbol, known())) {
        Some(known) => format!("did you mean `{known}`?"),
        None => suggest(symbol, ["m", "mm", "kg", "t", "s", "N", "kN", "Pa", "bar", "l", "deg"]),
    };
    UnknownUnit { symbol: symbol.to_owned(), help }
}
