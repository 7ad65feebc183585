//! The most important columns of a run, by kind.

use super::{Extremes, Table, connector_force, cylinders, drive_effort};
use crate::Description;

/// The measure of a quantity's size, relative to which its error is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Size {
    /// The largest absolute value.
    Peak,
    /// The range from the minimum to the maximum.
    Range,
}

/// Columns of one kind, whose sizes are comparable.
#[derive(Clone, Debug)]
pub struct Kind {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Their unit.
    pub unit: &'static str,
    /// The measure of their size, in words.
    pub measure: &'static str,
    size: Size,
}

impl Kind {
    fn new(names: Vec<String>, unit: &'static str, size: Size) -> Self {
        let measure = match size {
            Size::Peak => "peak",
            Size::Range => "range",
        };
        Self { names, unit, measure, size }
    }

    /// Size of a quantity.
    pub fn size(&self, extremes: &Extremes) -> f64 {
        match self.size {
            Size::Peak => extremes.size(),
            Size::Range => extremes.maximum - extremes.minimum,
        }
    }

    /// Below this a difference is rounding or a negligible motion: a micrometre on a crane of several metres, or a billionth of the largest force
    /// of the run, `force` in N, or its moment at an arm of 1 m.
    pub fn noise(&self, table: &Table, name: &str, force: f64) -> f64 {
        /// Fraction of the largest value.
        const NOISE: f64 = 1e-6;
        /// The same for forces and moments.
        const ROUNDING: f64 = 1e-9;
        match (self.size, self.unit) {
            (Size::Peak, "N" | "N m") => ROUNDING * force,
            (Size::Peak, _) => 0.0,
            (Size::Range, _) => NOISE * Extremes::of(table, name).size(),
        }
    }
}

/// The most important columns of a run: efforts of the drives, paths of the points, vertical forces of the supports, pressures of
/// cylinders and pump, forces of connectors.
pub fn headlines(description: &Description) -> Vec<Kind> {
    let efforts = |unit: &str| -> Vec<String> {
        let coordinates = description.drives.iter().map(|drive| &description.coordinates[drive.coordinate]);
        let of_unit = coordinates.filter(|coordinate| coordinate.kind.force_unit() == unit);
        of_unit.map(|coordinate| drive_effort(&coordinate.name, coordinate.kind)).collect()
    };
    let each_axis =
        |name: String| ["x", "y", "z"].map(|axis| format!("{name}_{axis}")).into_iter().collect::<Vec<String>>();
    let points = description.points.iter().flat_map(|point| each_axis(point.to_string())).collect();
    let supports = description.supports.iter().map(|support| format!("{}_reaction_z", support.name));
    let connectors = |unit: &str| -> Vec<String> {
        let of_unit = description.connectors.iter().filter(|connector| connector.kind.force_unit() == unit);
        of_unit.map(connector_force).collect()
    };
    vec![
        Kind::new(efforts("N m"), "N m", Size::Peak),
        Kind::new(efforts("N"), "N", Size::Peak),
        Kind::new(points, "m", Size::Range),
        Kind::new(supports.collect(), "N", Size::Peak),
        Kind::new(cylinders::pressures(description), "Pa", Size::Peak),
        Kind::new(connectors("N"), "N", Size::Peak),
        Kind::new(connectors("N m"), "N m", Size::Peak),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_billionth_of_the_largest_force_is_rounding() {
        let mut table = Table::default();
        for (name, unit) in [("t", "s"), ("slew", "N m"), ("rope", "N"), ("oil", "Pa"), ("tip", "m")] {
            table.add(name, unit);
        }
        table.rows = vec![vec![0.0, 1e-22, 2e4, 1e7, 3.0], vec![9.0, -2e-22, -3e4, 2e7, 4.0]];
        let force = table.largest_force();
        assert!((force - 3e4).abs() < f64::EPSILON, "{force}");
        for (name, unit, size, noise) in [
            ("slew", "N m", Size::Peak, 3e-5),
            ("rope", "N", Size::Peak, 3e-5),
            ("oil", "Pa", Size::Peak, 0.0),
            ("tip", "m", Size::Range, 4e-6),
        ] {
            let found = Kind::new(vec![name.into()], unit, size).noise(&table, name, force);
            // Products of two numbers, each rounded.
            assert!((found - noise).abs() <= 1e-15 * noise, "{name}: {found}");
        }
    }
}
