//! Drives and their motions.

use super::{Angle, Constant, FixedAngle, Number, Spanned};
use crate::node::FromNode;

/// A drive: a spring and a damper between a joint and a prescribed motion, the motion itself, or a torque or a force.
#[derive(Clone, Debug, FromNode)]
pub struct Drive {
    /// The coordinate it drives, such as `boom_psi`.
    pub coordinate: Spanned<String>,
    /// Stiffness; required unless the drive is rigid or has an `effort`.
    #[key(unit = "N m/rad or N/m", limit = NotNegative, usual = 0.0..1e13)]
    pub stiffness: Option<Spanned<Number>>,
    /// Damping. Default 0.
    #[key(unit = "N m s/rad or N s/m", limit = NotNegative)]
    pub damping: Option<Spanned<Number>>,
    /// Whether the coordinate follows the motion exactly. Default false.
    pub rigid: Option<Spanned<bool>>,
    /// Torque or force besides that of spring and damper: a motion whose positions are efforts, a table, or an input. Default: none.
    #[key(unit = "N m or N")]
    pub effort: Option<Spanned<Motion>>,
    /// Maximum torque or force of the drive: that of spring, damper and `effort` together. Default: none.
    #[key(unit = "N m or N", limit = Positive)]
    pub max_effort: Option<Spanned<Number>>,
    /// Maximum rate at which it drives: its effort falls to zero over the last tenth. Needs `max_effort`. Default: none.
    #[key(unit = "rad/s or m/s", limit = Positive)]
    pub max_rate: Option<Spanned<Constant>>,
    /// Maximum power with which it drives. Needs `max_effort`. Default: none.
    #[key(unit = "W", limit = Positive)]
    pub max_power: Option<Spanned<Constant>>,
    /// Inertia of the drive's rotor, reflected to the joint by the square of the gear ratio. Default 0.
    #[key(unit = "kg m² or kg", limit = NotNegative)]
    pub armature: Option<Spanned<Number>>,
    /// Motion of the spring's far end, or of the joint of a rigid drive; required unless the drive has neither.
    #[key(unit = "rad or m")]
    pub motion: Option<Spanned<Motion>>,
    /// An emergency stop of the motion. Default: none.
    pub halt: Option<Spanned<Halt>>,
    /// The input that is added to the motion, rad or m. Default: none.
    pub offset: Option<Spanned<String>>,
}

/// An emergency stop: the motion slows down along its way and ends.
#[derive(Clone, Debug, FromNode)]
pub struct Halt {
    /// Time from which it slows down.
    #[key(unit = "s", limit = NotNegative)]
    pub at: Spanned<Number>,
    /// Time in which it comes to rest.
    #[key(unit = "s", limit = Positive)]
    pub within: Spanned<Number>,
}

/// Motion of a drive; before it begins and, unless it is a speed, after it ends, the drive holds its position.
#[derive(Clone, Debug, FromNode)]
pub enum Motion {
    /// Held at one position.
    #[key(unit = "…")]
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
    /// Position before.
    #[key(unit = "…")]
    pub from: Spanned<Angle>,
    /// Position after.
    #[key(unit = "…")]
    pub to: Spanned<Angle>,
    /// Time at which it begins. Default 0.
    #[key(unit = "s")]
    pub begin: Option<Spanned<Number>>,
    /// Duration.
    #[key(unit = "s", limit = Positive)]
    pub duration: Spanned<Number>,
}

/// A trapezoidal velocity.
#[derive(Clone, Debug, FromNode)]
pub struct Trapezoid {
    /// Position before.
    #[key(unit = "…")]
    pub from: Spanned<Angle>,
    /// Position after.
    #[key(unit = "…")]
    pub to: Spanned<Angle>,
    /// Time at which it begins. Default 0.
    #[key(unit = "s")]
    pub begin: Option<Spanned<Number>>,
    /// Duration.
    #[key(unit = "s", limit = Positive)]
    pub duration: Spanned<Number>,
    /// Fraction of the duration spent accelerating, and equally decelerating, above 0 and at most 0.5. Default 0.25.
    #[key(unit = "1")]
    pub blend: Option<Spanned<Constant>>,
}

/// A constant speed.
#[derive(Clone, Debug, FromNode)]
pub struct Speed {
    /// Speed.
    #[key(unit = "…/s")]
    pub rate: Spanned<Angle>,
    /// Position before. Default 0.
    #[key(unit = "…")]
    pub from: Option<Spanned<Angle>>,
    /// Time at which it begins. Default 0.
    #[key(unit = "s")]
    pub begin: Option<Spanned<Number>>,
    /// Time to reach the speed smoothly. Default: the speed jumps.
    #[key(unit = "s", limit = Positive)]
    pub ramp: Option<Spanned<Number>>,
}

/// Positions at given times, written here or in a CSV file.
#[derive(Clone, Debug, FromNode)]
pub struct Table {
    /// Times, strictly increasing.
    #[key(unit = "s")]
    pub times: Option<Spanned<Vec<Spanned<Constant>>>>,
    /// Values: positions, efforts, openings, or factors of a load.
    #[key(unit = "…")]
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
