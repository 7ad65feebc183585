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
    /// Columns of forces, N, beside which moments may be rounding.
    beside: Vec<String>,
}

impl Kind {
    fn new(names: Vec<String>, unit: &'static str, size: Size) -> Self {
        let measure = match size {
            Size::Peak => "peak",
            Size::Range => "range",
        };
        Self { names, unit, measure, size, beside: Vec::new() }
    }

    /// Size of a quantity.
    pub fn size(&self, extremes: &Extremes) -> f64 {
        match self.size {
            Size::Peak => extremes.size(),
            Size::Range => extremes.maximum - extremes.minimum,
        }
    }

    /// Below this a difference is rounding or a negligible motion: a micrometre on a crane of several metres, or the moment of a billionth of
    /// the largest force at an arm of 1 m.
    pub fn noise(&self, table: &Table, name: &str) -> f64 {
        /// Fraction of the largest value.
        const NOISE: f64 = 1e-6;
        /// The same for forces beside moments.
        const ROUNDING: f64 = 1e-9;
        match self.size {
            Size::Peak => {
                let forces = self.beside.iter().map(|name| Extremes::of(table, name).size());
                ROUNDING * forces.fold(0.0, f64::max)
            }
            Size::Range => NOISE * Extremes::of(table, name).size(),
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
        // Where nothing twists a telescope, the moments of its pads are zero up to rounding.
        Kind { beside: connectors("N"), ..Kind::new(connectors("N m"), "N m", Size::Peak) },
    ]
}
