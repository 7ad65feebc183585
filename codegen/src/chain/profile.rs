//! Prescribed motions of drives, `q_dr(t)`.

use super::Value;

/// A prescribed motion: constant before it begins and, unless it has a speed, after it ends; once continuously
/// differentiable throughout, unless it jumps to its speed.
///
/// With `τ = clamp((t − begin)/duration, 0, 1)` the normalised profiles move from `from` to `to` as
/// `q_dr = from + (to − from) s(τ)`.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// Held at one position, m or rad.
    Hold(Value),
    /// `s = 10τ³ − 15τ⁴ + 6τ⁵`: at rest with zero acceleration at both ends.
    Quintic(Ramp),
    /// `s = 3τ² − 2τ³`: at rest at both ends.
    Cubic(Ramp),
    /// `s = τ − sin(2πτ)/2π`: smooth acceleration.
    Cycloid(Ramp),
    /// Trapezoid of velocity: constant acceleration over the first and last `blend` of the duration, 0 < blend ≤ ½.
    /// The acceleration jumps at the ends of the ramps.
    Trapezoid {
        /// From where to where, and when.
        ramp: Ramp,
        /// Share of the duration spent accelerating.
        blend: f64,
    },
    /// Constant speed from `begin` on, without end.
    Speed {
        /// Position before, m or rad.
        from: Value,
        /// Speed, m/s or rad/s.
        rate: Value,
        /// When it begins, s.
        begin: Value,
        /// How long it takes to reach the speed, s: `q̇_dr = rate (3τ² − 2τ³)`. Without, the speed jumps.
        ramp: Option<Value>,
    },
    /// Cubic spline through given positions, at rest at both ends.
    Table {
        /// Position before the first segment, m or rad.
        from: f64,
        /// The spline's pieces in order of time, each starting where the one before ends.
        segments: Vec<Segment>,
    },
}

/// Start, end and time of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    /// Position before, m or rad.
    pub from: Value,
    /// Position after, m or rad.
    pub to: Value,
    /// When it begins, s.
    pub begin: Value,
    /// How long it takes, s.
    pub duration: Value,
}

/// A cubic piece of a spline over `u = clamp(t − begin, 0, duration)`: adds `c₁u + c₂u² + c₃u³`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// When it begins, s.
    pub begin: f64,
    /// How long it lasts, s.
    pub duration: f64,
    /// `c₁, c₂, c₃`.
    pub coefficients: [f64; 3],
}
