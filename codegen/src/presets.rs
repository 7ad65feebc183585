//! Tabulated factors: partial factors for combinations, and dynamic factors, as data with their source and edition.
//!
//! A row has the name of a standard and its edition only where its numbers were read there. They say nothing about whether a crane satisfies a standard.

/// What a factor multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Multiplied {
    /// The weight of the crane.
    Weight,
    /// The weight of the crane while a load is lifted or let go.
    WeightWhileLifting,
    /// The weight of what is hoisted.
    Hoisted,
    /// The load that is hoisted from the ground.
    HoistedFromGround,
    /// Wind.
    Wind,
    /// The change of a drive's force.
    Drive,
}

impl Multiplied {
    /// In words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Weight => "weight of the crane",
            Self::WeightWhileLifting => "weight of the crane while a load is lifted or let go",
            Self::Hoisted => "weight of what is hoisted",
            Self::HoistedFromGround => "load that is hoisted from the ground",
            Self::Wind => "wind",
            Self::Drive => "change of a drive's force",
        }
    }
}

/// A factor of a class or a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factor {
    /// γ for partial factors, φ₁ … φ₅ for dynamic ones.
    pub symbol: &'static str,
    /// What it multiplies.
    pub of: Multiplied,
    /// The preset, or the class as its source writes it.
    pub case: &'static str,
    /// Its least and greatest value, without a unit; both the same where the source has one.
    pub values: [f64; 2],
    /// By how much it grows with the speed of hoisting, s/m.
    pub slope: f64,
    /// Where the numbers are from.
    pub source: &'static str,
    /// The edition of the source; empty for what is of no single source.
    pub edition: &'static str,
}

const EUROCODE: &str = "EN 1991-3, tables 2.4 and 2.5";
const PRACTICE: &str = "common practice";

/// All of them.
pub const TABLE: [Factor; 18] = [
    partial("regular", Multiplied::Weight, 1.22),
    partial("regular", Multiplied::Hoisted, 1.34),
    partial("regular", Multiplied::Wind, 0.0),
    partial("with_wind", Multiplied::Weight, 1.16),
    partial("with_wind", Multiplied::Hoisted, 1.22),
    partial("with_wind", Multiplied::Wind, 1.22),
    partial("exceptional", Multiplied::Weight, 1.1),
    partial("exceptional", Multiplied::Hoisted, 1.1),
    partial("exceptional", Multiplied::Wind, 1.1),
    partial("test_load", Multiplied::Weight, 1.0),
    partial("test_load", Multiplied::Hoisted, 1.25),
    of_practice("φ₁", Multiplied::WeightWhileLifting, "", [0.9, 1.1]),
    of_hoisting("HC1", 1.05, 0.17),
    of_hoisting("HC2", 1.10, 0.34),
    of_hoisting("HC3", 1.15, 0.51),
    of_hoisting("HC4", 1.20, 0.68),
    of_practice("φ₅", Multiplied::Drive, "smooth", [1.5, 1.5]),
    of_practice("φ₅", Multiplied::Drive, "abrupt", [2.0, 2.0]),
];

const fn of_practice(symbol: &'static str, of: Multiplied, case: &'static str, values: [f64; 2]) -> Factor {
    Factor { symbol, of, case, values, slope: 0.0, source: PRACTICE, edition: "" }
}

const fn partial(case: &'static str, of: Multiplied, value: f64) -> Factor {
    of_practice("γ", of, case, [value; 2])
}

const fn of_hoisting(case: &'static str, least: f64, slope: f64) -> Factor {
    let of = Multiplied::HoistedFromGround;
    Factor { symbol: "φ₂", of, case, values: [least; 2], slope, source: EUROCODE, edition: "2006" }
}

/// The factor of a class of hoisting at a speed, m/s: `φ₂ = φ₂min + β₂ v`; NaN for a class that there is not.
#[must_use]
pub fn hoisting_factor(class: &str, speed: f64) -> f64 {
    let of_class = |factor: &&Factor| factor.of == Multiplied::HoistedFromGround && factor.case == class;
    TABLE.iter().find(of_class).map_or(f64::NAN, |factor| factor.values[0] + factor.slope * speed)
}

/// The partial factor of a preset; 1 where it has none.
#[must_use]
pub fn partial_factor(preset: &str, of: Multiplied) -> f64 {
    TABLE.iter().find(|factor| factor.of == of && factor.case == preset).map_or(1.0, |factor| factor.values[1])
}
