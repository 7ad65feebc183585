//! Tabulated dynamic factors: data with source, edition and unit, to compare with what is computed. They say nothing about whether a crane satisfies a standard.

use crane_page::tables::{Cell, Grid};

use crate::arguments::HoistingClass;

/// A factor of a class.
pub struct Tabulated {
    symbol: &'static str,
    /// What it multiplies.
    of: &'static str,
    /// The class as its source writes it, or the case.
    class: &'static str,
    /// Its least and greatest value; both the same where the source has one.
    values: [f64; 2],
    /// By how much it grows with the speed of hoisting, s/m.
    slope: f64,
    source: &'static str,
    edition: &'static str,
}

const HOISTED: &str = "load that is hoisted from the ground";
const EUROCODE: &str = "EN 1991-3, tables 2.4 and 2.5";
/// What is common and of no single source.
const PRACTICE: &str = "common practice";

/// All of them.
const TABLE: [Tabulated; 7] = [
    of_practice("φ₁", "weight of the crane while a load is lifted or let go", "", [0.9, 1.1]),
    of_hoisting("HC1", 1.05, 0.17),
    of_hoisting("HC2", 1.10, 0.34),
    of_hoisting("HC3", 1.15, 0.51),
    of_hoisting("HC4", 1.20, 0.68),
    of_practice("φ₅", "change of a drive's force", "smooth", [1.5, 1.5]),
    of_practice("φ₅", "change of a drive's force", "abrupt", [2.0, 2.0]),
];

const fn of_practice(symbol: &'static str, of: &'static str, class: &'static str, values: [f64; 2]) -> Tabulated {
    Tabulated { symbol, of, class, values, slope: 0.0, source: PRACTICE, edition: "" }
}

const fn of_hoisting(class: &'static str, least: f64, slope: f64) -> Tabulated {
    Tabulated { symbol: "φ₂", of: HOISTED, class, values: [least, least], slope, source: EUROCODE, edition: "2006" }
}

/// The factor of a class of hoisting at a speed, m/s: `φ₂ = φ₂min + β₂ v`.
pub fn of_class(class: HoistingClass, speed: f64) -> (&'static str, f64) {
    let name = match class {
        HoistingClass::Hc1 => "HC1",
        HoistingClass::Hc2 => "HC2",
        HoistingClass::Hc3 => "HC3",
        HoistingClass::Hc4 => "HC4",
    };
    let known = TABLE.iter().find(|factor| factor.class == name);
    (name, known.map_or(f64::NAN, |factor| factor.values[0] + factor.slope * speed))
}

/// The whole table.
pub fn table() -> Grid {
    let title =
        "Tabulated factors to compare with, and where they come from; φ₂ grows with the steady speed of hoisting";
    let headers = ["factor", "class", "least", "greatest", "per speed [s/m]", "multiplies", "source", "edition"];
    let mut grid = Grid::new("tabulated", title, &headers);
    for Tabulated { symbol, of, class, values: [least, greatest], slope, source, edition } in TABLE {
        let slope = if slope > 0.0 { slope.into() } else { Cell::Empty };
        grid.row([
            symbol.into(),
            class.into(),
            least.into(),
            greatest.into(),
            slope,
            of.into(),
            source.into(),
            edition.into(),
        ]);
    }
    grid
}
