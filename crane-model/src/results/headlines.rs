//! The most important columns of a run, by kind.

use crane_quantities::{ColumnKind, Size};

use super::{Column, Extremes, Table};

/// What is less than this part of the largest of its kind is rounding.
pub const ROUNDING: f64 = 1e-9;

/// Columns of one kind, whose sizes are comparable.
#[derive(Clone, Debug)]
pub struct Kind {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Their unit.
    pub unit: String,
    /// The measure of their size, in words.
    pub measure: &'static str,
    size: Size,
}

impl Kind {
    fn new(names: Vec<String>, unit: &str, size: Size) -> Self {
        let measure = match size {
            Size::Peak => "peak",
            Size::Range => "range",
        };
        Self { names, unit: unit.to_owned(), measure, size }
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
        match (self.size, self.unit.as_str()) {
            (Size::Peak, "N" | "N m") => ROUNDING * force,
            (Size::Peak, _) => 0.0,
            (Size::Range, _) => NOISE * Extremes::of_column(table, name).size(),
        }
    }
}

/// The most important columns of a run, those of similar kinds and one unit together, in the order in which they are shown: efforts of the drives,
/// paths of the points, vertical forces of the supports, pressures, forces of connectors, what joints that close loops transmit.
pub fn headlines(columns: &[Column]) -> Vec<Kind> {
    let mut kinds: Vec<(usize, Kind)> = Vec::new();
    for column in columns {
        let Some(size) = column.kind.headline() else { continue };
        let rank = rank(column.kind);
        let known = kinds.iter_mut().find(|(other, kind)| *other == rank && kind.unit == column.unit);
        match known {
            Some((_, kind)) => kind.names.push(column.name.clone()),
            None => kinds.push((rank, Kind::new(vec![column.name.clone()], &column.unit, size))),
        }
    }
    kinds.sort_by_key(|(rank, kind)| (*rank, kind.unit != "N m"));
    kinds.into_iter().map(|(_, kind)| kind).collect()
}

/// The place of a kind of columns among the headlines.
fn rank(kind: ColumnKind) -> usize {
    match kind {
        ColumnKind::DriveEffort => 0,
        ColumnKind::PointPosition => 1,
        ColumnKind::VerticalReaction => 2,
        ColumnKind::PistonPressure | ColumnKind::RodPressure | ColumnKind::PumpPressure => 3,
        ColumnKind::ConnectorEffort | ColumnKind::PinFriction => 4,
        _ => 5,
    }
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
            let value = Kind::new(vec![name.into()], unit, size).noise(&table, name, force);
            // Products of two numbers, each rounded.
            assert!((value - noise).abs() <= 1e-15 * noise, "{name}: {value}");
        }
    }
}
