//! Combinations of weights and loads.

use super::{Constant, Entries, Spanned};
use crate::node::FromNode;

/// Partial factors of weights and loads, with which statics and strength are verified. What is not named is as written.
#[derive(Clone, Debug, FromNode)]
pub struct Combination {
    /// Name, a `snake_case` identifier.
    pub name: Spanned<String>,
    /// A preset of tabulated partial factors: of the weight of everything, of what is `hoisted`, and of `wind`. Default: none, all factors are 1.
    pub preset: Option<Spanned<Preset>>,
    /// Masses that are live parameters in kg, whose weight has the factor of hoisted loads of the preset, times that of `hoisting`.
    pub hoisted: Option<Spanned<Vec<Spanned<String>>>>,
    /// How the `hoisted` masses leave the ground: by a tabulated dynamic factor. Default: without.
    pub hoisting: Option<Spanned<Hoisting>>,
    /// Those of `loads` that have the preset's factor of wind.
    pub wind: Option<Spanned<Vec<Spanned<String>>>>,
    /// Factor of the weight of everything. Default: that of the preset.
    #[key(unit = "1", limit = Positive, usual = 0.1..10.0)]
    pub weight: Option<Spanned<Constant>>,
    /// Factors of the weight of masses that are live parameters in kg, such as a payload, in place of all others, by name.
    #[key(unit = "1", limit = Positive, usual = 0.1..10.0)]
    pub masses: Option<Spanned<Entries<Constant>>>,
    /// Factors of `loads`, by name; 0 leaves a load out. Default: that of the preset for `wind`, otherwise 1.
    #[key(unit = "1", usual = 0.01..10.0)]
    pub loads: Option<Spanned<Entries<Constant>>>,
}

/// A preset of partial factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum Preset {
    /// Regular work without wind.
    Regular,
    /// Regular work with wind.
    WithWind,
    /// Exceptional loads.
    Exceptional,
    /// A test load.
    TestLoad,
}

impl Preset {
    /// Its name in the [table](crate::presets::TABLE).
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Preset::Regular => "regular",
            Preset::WithWind => "with_wind",
            Preset::Exceptional => "exceptional",
            Preset::TestLoad => "test_load",
        }
    }
}

/// Hoisting from the ground, with its tabulated dynamic factor `φ₂ = φ₂min + β₂ v`.
#[derive(Clone, Debug, FromNode)]
pub struct Hoisting {
    /// The hoisting class.
    pub class: Spanned<HoistingClass>,
    /// The steady speed v.
    #[key(unit = "m/s", limit = NotNegative, usual = 1e-3..10.0)]
    pub speed: Spanned<Constant>,
}

/// A hoisting class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum HoistingClass {
    /// Gentle.
    Hc1,
    /// Moderate.
    Hc2,
    /// Hard.
    Hc3,
    /// Violent.
    Hc4,
}

impl HoistingClass {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Hc1, Self::Hc2, Self::Hc3, Self::Hc4];

    /// Its name in the [table](crate::presets::TABLE).
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            HoistingClass::Hc1 => "HC1",
            HoistingClass::Hc2 => "HC2",
            HoistingClass::Hc3 => "HC3",
            HoistingClass::Hc4 => "HC4",
        }
    }
}
