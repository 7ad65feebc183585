//! Units in which people read numbers that are in SI for programs and in files: terminal, pages and cautions.

/// A unit in which people read numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayUnit {
    /// °, for rad.
    Degree,
    /// °/s, for rad/s.
    DegreePerSecond,
    /// Of pressures, for Pa.
    Bar,
    /// Of flows of oil, for m³/s.
    LitrePerMinute,
    /// For N.
    Kilonewton,
    /// For N m.
    KilonewtonMetre,
    /// For J.
    Kilojoule,
    /// For W.
    Kilowatt,
    /// For m.
    Millimetre,
    /// Of stresses, for Pa.
    Megapascal,
    /// Of a ratio.
    Percent,
}

impl DisplayUnit {
    /// All of them.
    pub const ALL: [Self; 11] = [
        DisplayUnit::Degree,
        DisplayUnit::DegreePerSecond,
        DisplayUnit::Bar,
        DisplayUnit::LitrePerMinute,
        DisplayUnit::Kilonewton,
        DisplayUnit::KilonewtonMetre,
        DisplayUnit::Kilojoule,
        DisplayUnit::Kilowatt,
        DisplayUnit::Millimetre,
        DisplayUnit::Megapascal,
        DisplayUnit::Percent,
    ];

    /// The unit of this name.
    #[must_use]
    pub fn find(unit: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.unit() == unit)
    }

    /// The unit for all numbers of a unit of SI; `None` for units that everybody reads.
    #[must_use]
    pub fn always(si: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|known| known.si() == si && matches!(known.sizes(), Some([least, _]) if least == 0.0))
    }

    /// The unit for a number of some size, in a unit of SI, where it stands alone or in a plot.
    #[must_use]
    pub fn for_size(si: &str, size: f64) -> Option<Self> {
        let fits = |known: &Self| matches!(known.sizes(), Some([least, below]) if (least..below).contains(&size));
        Self::ALL.into_iter().find(|known| known.si() == si && fits(known))
    }

    /// The sizes for which it is used, in SI: from the first to below the second; `None` where what is measured decides, as for stresses and pressures.
    #[must_use]
    pub const fn sizes(self) -> Option<[f64; 2]> {
        match self {
            DisplayUnit::Degree | DisplayUnit::DegreePerSecond | DisplayUnit::Bar | DisplayUnit::LitrePerMinute => {
                Some([0.0, f64::INFINITY])
            }
            DisplayUnit::Kilonewton | DisplayUnit::KilonewtonMetre | DisplayUnit::Kilojoule | DisplayUnit::Kilowatt => {
                Some([1e4, f64::INFINITY])
            }
            DisplayUnit::Millimetre => Some([f64::MIN_POSITIVE, 0.5]),
            DisplayUnit::Megapascal | DisplayUnit::Percent => None,
        }
    }

    /// Its name.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            DisplayUnit::Degree => "°",
            DisplayUnit::DegreePerSecond => "°/s",
            DisplayUnit::Bar => "bar",
            DisplayUnit::LitrePerMinute => "l/min",
            DisplayUnit::Kilonewton => "kN",
            DisplayUnit::KilonewtonMetre => "kN m",
            DisplayUnit::Kilojoule => "kJ",
            DisplayUnit::Kilowatt => "kW",
            DisplayUnit::Millimetre => "mm",
            DisplayUnit::Megapascal => "MPa",
            DisplayUnit::Percent => "%",
        }
    }

    /// The unit in SI.
    #[must_use]
    pub const fn si(self) -> &'static str {
        match self {
            DisplayUnit::Degree => "rad",
            DisplayUnit::DegreePerSecond => "rad/s",
            DisplayUnit::Bar | DisplayUnit::Megapascal => "Pa",
            DisplayUnit::LitrePerMinute => "m³/s",
            DisplayUnit::Kilonewton => "N",
            DisplayUnit::KilonewtonMetre => "N m",
            DisplayUnit::Kilojoule => "J",
            DisplayUnit::Kilowatt => "W",
            DisplayUnit::Millimetre => "m",
            DisplayUnit::Percent => "1",
        }
    }

    /// A number in SI as people read it. Divisions by powers of ten are exact where products with their inverse are not.
    #[must_use]
    pub const fn shown(self, number: f64) -> f64 {
        match self {
            DisplayUnit::Degree | DisplayUnit::DegreePerSecond => number.to_degrees(),
            DisplayUnit::Bar => number / 1e5,
            DisplayUnit::Megapascal => number / 1e6,
            DisplayUnit::LitrePerMinute => number * 6e4,
            DisplayUnit::Kilonewton | DisplayUnit::KilonewtonMetre | DisplayUnit::Kilojoule | DisplayUnit::Kilowatt => {
                number / 1e3
            }
            DisplayUnit::Millimetre => number * 1e3,
            DisplayUnit::Percent => number * 100.0,
        }
    }
}
