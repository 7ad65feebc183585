//! The table of units, and names of dimensions.

use super::Dimension;

/// A symbol of a unit: 10^`tens` · 60^`sixties` · (π/180)^`degrees` of the SI unit of its dimension.
#[derive(Clone, Copy, Debug)]
pub struct Symbol {
    /// As it is written.
    pub text: &'static str,
    /// Exponents of m, kg, s and rad.
    pub dimension: Dimension,
    /// Exponent of ten.
    pub tens: i32,
    /// Exponent of 60.
    pub sixties: i32,
    /// Exponent of π/180.
    pub degrees: i32,
}

const NONE: Dimension = Dimension([0, 0, 0, 0]);
const LENGTH: Dimension = Dimension([1, 0, 0, 0]);
const VOLUME: Dimension = Dimension([3, 0, 0, 0]);
const MASS: Dimension = Dimension([0, 1, 0, 0]);
const TIME: Dimension = Dimension([0, 0, 1, 0]);
const ANGLE: Dimension = Dimension([0, 0, 0, 1]);
const RATE: Dimension = Dimension([0, 0, -1, 1]);
const FREQUENCY: Dimension = Dimension([0, 0, -1, 0]);
const FORCE: Dimension = Dimension([1, 1, -2, 0]);
const PRESSURE: Dimension = Dimension([-1, 1, -2, 0]);
const ENERGY: Dimension = Dimension([2, 1, -2, 0]);
const POWER: Dimension = Dimension([2, 1, -3, 0]);

const fn decimal(text: &'static str, dimension: Dimension, tens: i32) -> Symbol {
    Symbol { text, dimension, tens, sixties: 0, degrees: 0 }
}

/// All symbols, by dimension; the first of a dimension is the SI unit. `docs/SPEC.md` has the same table.
pub const TABLE: &[Symbol] = &[
    decimal("1", NONE, 0),
    decimal("%", NONE, -2),
    decimal("m", LENGTH, 0),
    decimal("mm", LENGTH, -3),
    decimal("cm", LENGTH, -2),
    decimal("dm", LENGTH, -1),
    decimal("km", LENGTH, 3),
    decimal("l", VOLUME, -3),
    decimal("kg", MASS, 0),
    decimal("g", MASS, -3),
    decimal("t", MASS, 3),
    decimal("s", TIME, 0),
    decimal("ms", TIME, -3),
    Symbol { text: "min", dimension: TIME, tens: 0, sixties: 1, degrees: 0 },
    Symbol { text: "h", dimension: TIME, tens: 0, sixties: 2, degrees: 0 },
    decimal("rad", ANGLE, 0),
    decimal("mrad", ANGLE, -3),
    Symbol { text: "deg", dimension: ANGLE, tens: 0, sixties: 0, degrees: 1 },
    Symbol { text: "°", dimension: ANGLE, tens: 0, sixties: 0, degrees: 1 },
    // 360° in 60 s are 6 °/s.
    Symbol { text: "rpm", dimension: RATE, tens: -1, sixties: 1, degrees: 1 },
    decimal("Hz", FREQUENCY, 0),
    decimal("N", FORCE, 0),
    decimal("kN", FORCE, 3),
    decimal("MN", FORCE, 6),
    decimal("Pa", PRESSURE, 0),
    decimal("kPa", PRESSURE, 3),
    decimal("MPa", PRESSURE, 6),
    decimal("GPa", PRESSURE, 9),
    decimal("bar", PRESSURE, 5),
    decimal("J", ENERGY, 0),
    decimal("kJ", ENERGY, 3),
    decimal("W", POWER, 0),
    decimal("kW", POWER, 3),
];

/// Names of dimensions, and their SI units.
pub(super) const NAMES: &[(Dimension, &str, &str)] = &[
    (NONE, "a number", "no unit"),
    (LENGTH, "a length", "m"),
    (Dimension([2, 0, 0, 0]), "an area", "m²"),
    (VOLUME, "a volume", "m³"),
    (Dimension([4, 0, 0, 0]), "a second moment of area", "m⁴"),
    (MASS, "a mass", "kg"),
    (TIME, "a time", "s"),
    (ANGLE, "an angle", "rad"),
    (RATE, "an angular speed", "rad/s"),
    (FREQUENCY, "a frequency", "1/s"),
    (Dimension([1, 0, -1, 0]), "a speed", "m/s"),
    (Dimension([1, 0, -2, 0]), "an acceleration", "m/s²"),
    (FORCE, "a force", "N"),
    (ENERGY, "a moment", "N m"),
    (PRESSURE, "a pressure", "Pa"),
    (POWER, "a power", "W"),
    (Dimension([3, 0, -1, 0]), "a flow", "m³/s"),
    (Dimension([-3, 1, 0, 0]), "a density", "kg/m³"),
    (Dimension([-1, 1, 0, 0]), "a mass per length", "kg/m"),
    (Dimension([2, 1, 0, 0]), "a moment of inertia", "kg m²"),
    (Dimension([0, 1, -2, 0]), "a stiffness", "N/m"),
    (Dimension([2, 1, -2, -1]), "a rotational stiffness", "N m/rad"),
    (Dimension([0, 1, -1, 0]), "a damping", "N s/m"),
    (Dimension([2, 1, -1, -1]), "a rotational damping", "N m s/rad"),
];
