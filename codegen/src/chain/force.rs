//! Force elements on single coordinates with nonlinear laws.

use super::{CoordinateId, Value};

/// A force element: a law that acts on one coordinate of a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceElement {
    /// The coordinate.
    pub coordinate: CoordinateId,
    /// Its law.
    pub law: Law,
}

/// The law of a force element.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// An end stop.
    Stop(Stop),
    /// Friction of a joint.
    Friction(Friction),
}

/// An end stop, which pushes when the coordinate is beyond it and never pulls: with the penetration `δ`,
/// `F = k δ max(0, 1 + a δ̇)`.
///
/// K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 (1975) 440, with a linear spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// Its position, rad or m.
    pub at: Value,
    /// Which end of the joint's range it is.
    pub end: End,
    /// k, N m/rad or N/m.
    pub stiffness: Value,
    /// a, s/rad or s/m.
    pub damping: Value,
}

/// An end of a joint's range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The minimum of the coordinate.
    Lower,
    /// The maximum.
    Upper,
}

/// Friction of a joint, `F = (F_c + (F_b − F_c) exp(−(q̇/v_s)²)) tanh(q̇/v₀) + b q̇`: Coulomb friction with a Stribeck decline,
/// smooth where the motion reverses.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// `F_c`, N m or N.
    pub coulomb: Value,
    /// `F_b`, N m or N, and `v_s`, rad/s or m/s, if the breakaway friction is larger.
    pub breakaway: Option<(Value, Value)>,
    /// v₀, rad/s or m/s: at this rate friction reaches three quarters of its full value.
    pub width: Value,
    /// b, N m s/rad or N s/m.
    pub viscous: Value,
    /// Bristles, if the joint sticks.
    pub bristle: Option<Bristle>,
}

/// Bristle friction, with the deflection as a state of the motion; the force element then contains only the viscous friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bristle {
    /// `F_c`, N m or N.
    pub coulomb: f64,
    /// `F_b`, N m or N.
    pub breakaway: f64,
    /// `v_s`, rad/s or m/s.
    pub stribeck: f64,
    /// σ₀, N m/rad or N/m.
    pub stiffness: f64,
    /// σ₁, N m s/rad or N s/m.
    pub damping: f64,
}
