//! Numbers beyond the usual range of their keys: probably in another unit, or with a wrong exponent.

use super::{Plausibility, rounded};
use crate::chain::Value;
use crate::diagnostic::{Span, rule};
use crate::units::Unit;

/// Units in which numbers are often given, the likeliest of a dimension first.
const COMMON: [&str; 27] = [
    "mm",
    "cm",
    "bar",
    "MPa",
    "kPa",
    "GPa",
    "l/min",
    "l",
    "cm³",
    "ms",
    "%",
    "deg",
    "kN/mm",
    "kN/m",
    "kN",
    "MN",
    "kN s/m",
    "kN m/deg",
    "t",
    "g/m",
    "cm²",
    "mm²",
    "mm/s",
    "km/h",
    "mm/s²",
    "1/mm",
    "l/(min bar)",
];

/// A number with a usual range.
#[derive(Clone, Debug)]
pub(in crate::validate) struct Judged {
    /// Its location.
    pub span: Span,
    /// Its description in messages.
    pub subject: String,
    /// Its unit.
    pub unit: String,
    pub value: Value,
    /// The range of its magnitude, unless it is zero.
    pub usual: [f64; 2],
}

impl Plausibility<'_> {
    /// Warns of numbers beyond their usual range.
    pub(super) fn usual(&mut self, judged: &[Judged]) {
        for Judged { span, subject, unit, value, usual } in judged {
            let number = value.at(&self.values);
            let is_usual = |number: f64| number == 0.0 || (usual[0]..=usual[1]).contains(&number.abs());
            if number.is_nan() || is_usual(number) {
                continue;
            }
            let [from, to] = usual.map(shown);
            let range = match *usual {
                [0.0, _] => format!("at most {to}"),
                [_, f64::INFINITY] => format!("at least {from}"),
                _ => format!("{from} to {to}"),
            };
            let [unit_after, range] = [unit.clone(), format!("{range} {unit}")].map(|text| text.trim_end().to_owned());
            let help = match meant(number, unit).find(|(_, meant)| is_usual(*meant)) {
                Some((meant, _)) => format!("did you mean `{} {meant}`?", shown(number)),
                None => "check the unit and the exponent".to_owned(),
            };
            self.warn(rule::unusual(*span, subject, format!("{} {unit_after}", shown(number)).trim_end(), range, help));
        }
    }
}

/// The same number in the common units of a dimension, and what it would be in SI units.
fn meant(number: f64, unit: &str) -> impl Iterator<Item = (&'static str, f64)> {
    let known = Unit::parse(unit).ok();
    COMMON.iter().filter_map(move |common| {
        let meant =
            Unit::parse(common).ok().filter(|meant| Some(meant.dimension) == known.map(|known| known.dimension))?;
        let factor = 10f64.powi(meant.tens) * 60f64.powi(meant.sixties) * std::f64::consts::PI.powi(meant.degrees)
            / 180f64.powi(meant.degrees);
        Some((*common, number * factor))
    })
}

/// A number as a person would write it.
fn shown(number: f64) -> String {
    let number = rounded(number);
    if number == 0.0 || (1e-3..1e5).contains(&number.abs()) { number.to_string() } else { format!("{number:e}") }
}
