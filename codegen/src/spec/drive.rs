//! Drives and their motions.

use super::{Angle, Constant, FixedAngle, Number, Spanned};
use crate::node::FromNode;

/// A drive: a spring and a damper between a joint and a prescribed motion, the motion itself, or a torque or a force.
#[derive(Clone, Debug, FromNode)]
pub struct Drive {
    /// The coordinate it drives, such as `boom_psi`.
    pub coordinate: Spanned<String>,
    /// Stiffness, N m/rad or N/m; required unless the drive is rigid or has an `effort`.
    pub stiffness: Option<Spanned<Number>>,
    /// Damping, N m s/rad or N s/m. Default 0.
    pub damping: Option<Spanned<Number>>,
    /// Whether the coordinate follows the motion exactly. Default false.
    pub rigid: Option<Spanned<bool>>,
    /// Torque or force besides that of spring and damper, N m or N: a motion whose positions are efforts, a table, or an input. Default: none.
    pub effort: Option<Spanned<Motion>>,
    /// Maximum torque or force of the drive, N m or N: that of spring, damper and `effort` together. Default: none.
    pub max_effort: Option<Spanned<Number>>,
    /// Maximum rate at which it drives, rad/s or m/s: its effort falls to zero over the last tenth. Needs `max_effort`. Default: none.
    pub max_rate: Option<Spanned<Constant>>,
    /// Maximum power with which it drives, W. Needs `max_effort`. Default: none.
    pub max_power: Option<Spanned<Constant>>,
    /// Inertia of the drive's rotor, reflected to the joint by the square of the gear ratio, kg m² or kg. Default 0.
    pub armature: Option<Spanned<Number>>,
    /// Motion of the spring's far end, or of the joint of a rigid drive; required unless the drive has neither.
    pub motion: Option<Spanned<Motion>>,
    /// An emergency stop of the motion. Default: none.
    pub halt: Option<Spanned<Halt>>,
    /// The input that is added to the motion, rad or m. Default: none.
    pub offset: Option<Spanned<String>>,
}

/// An emergency stop: the motion slows down along its way and ends.
#[derive(Clone, Debug, FromNode)]
pub struct Halt {
    /// Time from which it slows down, s.
    pub at: Spanned<Number>,
    /// Time in which it comes to rest, s.
    pub within: Spanned<Number>,
}

/// Motion of a drive; before it begins and, unless it is a speed, after it ends, the drive holds its position.
#[derive(Clone, Debug, FromNode)]
pub enum Motion {
    /// Held at one position, rad or m.
    Hold(Spanned<Angle>),
    /// `10τ³ − 15τ⁴ + 6τ⁵`: at rest without acceleration at both ends.
    Quintic(Ramp),
    /// `3τ² − 2τ³`: at rest at both ends.
    Cubic(Ramp),
    /// `τ − sin(2πτ)/2π`: smooth acceleration.
    Cycloid(Ramp),
    /// Constant acceleration, constant velocity, constant deceleration.
    Trapezoid(Trapezoid),
    /// Constant speed, which never ends.
    Speed(Speed),
    /// Curve through given positions.
    Table(Table),
    /// An input, by its name.
    Input(Spanned<String>),
}

/// Start, end and time of a motion.
#[derive(Clone, Debug, FromNode)]
pub struct Ramp {
    /// Position before, rad or m.
    pub from: Spanned<Angle>,
    /// Position after, rad or m.
    pub to: Spanned<Angle>,
    /// Time at which it begins, s. Default 0.
    pub begin: Option<Spanned<Number>>,
    /// Duration, s.
    pub duration: Spanned<Number>,
}

/// A trapezoidal velocity.
#[derive(Clone, Debug, FromNode)]
pub struct Trapezoid {
    /// Position before, rad or m.
    pub from: Spanned<Angle>,
    /// Position after, rad or m.
    pub to: Spanned<Angle>,
    /// Time at which it begins, s. Default 0.
    pub begin: Option<Spanned<Number>>,
    /// Duration, s.
    pub duration: Spanned<Number>,
    /// Fraction of the duration spent accelerating, and equally decelerating, above 0 and at most 0.5. Default 0.25.
    pub blend: Option<Spanned<Constant>>,
}

/// A constant speed.
#[derive(Clone, Debug, FromNode)]
pub struct Speed {
    /// Speed, rad/s or m/s.
    pub rate: Spanned<Angle>,
    /// Position before, rad or m. Default 0.
    pub from: Option<Spanned<Angle>>,
    /// Time at which it begins, s. Default 0.
    pub begin: Option<Spanned<Number>>,
    /// Time to reach the speed smoothly, s. Default: the speed jumps.
    pub ramp: Option<Spanned<Number>>,
}

/// Positions at given times, written here or in a CSV file.
#[derive(Clone, Debug, FromNode)]
pub struct Table {
    /// Times, strictly increasing, s.
    pub times: Option<Spanned<Vec<Spanned<Constant>>>>,
    /// Values: positions in rad or m, openings, or factors of a load.
    pub values: Option<Spanned<Vec<Spanned<FixedAngle>>>>,
    /// A CSV file instead of `times` and `values`, relative to this one. Its first column has the times, s.
    pub file: Option<Spanned<String>>,
    /// Name of the column with the values. Default: the second column.
    pub column: Option<Spanned<String>>,
    /// How the curve runs between its points. Default: `monotone` where they are written, `spline` from a file.
    pub shape: Option<Spanned<Curve>>,
}

/// How a curve runs between the points of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum Curve {
    /// Never beyond the points around it.
    Monotone,
    /// Without jumps of the acceleration; it may leave the range of its points.
    Spline,
    /// Straight.
    Linear,
}
