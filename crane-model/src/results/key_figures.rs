//! Numbers that sum up what a crane carries.

/// What such a number is called, by commands, pages, sensitivities and charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyFigure {
    /// For programs.
    pub key: &'static str,
    /// For people.
    pub name: &'static str,
    /// Its unit in SI.
    pub unit: &'static str,
    /// The unit in which people read it; empty for ratios.
    pub shown: &'static str,
}

impl KeyFigure {
    /// Before the key of the greatest one of all sections.
    pub const GREATEST: &str = "greatest_";
    /// Equivalent stress over allowable stress.
    pub const UTILISATION: Self = Self { key: "utilisation", name: "utilisation", unit: "1", shown: "" };
    /// Von Mises' equivalent stress.
    pub const EQUIVALENT_STRESS: Self =
        Self { key: "equivalent_stress", name: "equivalent stress", unit: "Pa", shown: "MPa" };
    /// `1 − overturning / stabilising` about the governing line.
    pub const TIPPING_MARGIN: Self = Self { key: "tipping_margin", name: "tipping margin", unit: "1", shown: "" };

    /// The key of the greatest one of all sections.
    pub fn greatest(self) -> String {
        [Self::GREATEST, self.key].concat()
    }
}
