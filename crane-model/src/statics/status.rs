//! Outcome of a static solution.

use std::fmt;

use crate::Text;

/// Outcome of a static solution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Status {
    /// A stable equilibrium: residual below the tolerance, tangent stiffness positive definite.
    Converged,
    /// An equilibrium that the crane leaves after any disturbance: the tangent stiffness has a negative direction.
    Unstable {
        /// Coordinates of the motion away from it.
        coordinates: Vec<Text>,
    },
    /// Nothing constrains the crane in some direction: the tangent stiffness is singular, at an equilibrium or where no step
    /// reduces the residual.
    Singular {
        /// Coordinates that move in that direction.
        coordinates: Vec<Text>,
    },
    /// A crane on feet that lift has no stable pose with its base upright.
    TipsOver {
        /// Feet at the ends of the line that it tips over, or those that still press on the ground; may be empty.
        feet: Vec<Text>,
    },
    /// Weight and loads pull a crane on feet that do not hold it down upwards.
    Floats,
    /// Every foot on the ground slides: what pulls the crane sideways exceeds their friction.
    Slides {
        /// These feet.
        feet: Vec<Text>,
    },
    /// Forces or stiffnesses at the guess are not finite numbers.
    Overflow,
    /// No equilibrium found within the allowed iterations, or no step reduced the residual.
    NotConverged,
}

impl Status {
    /// A word for it: `stable`, `tips over`, `floats`, `slides`, `unstable`, `singular`, `overflow` or `not converged`.
    pub fn name(&self) -> &'static str {
        match self {
            Status::Converged => "stable",
            Status::TipsOver { .. } => "tips over",
            Status::Floats => "floats",
            Status::Slides { .. } => "slides",
            Status::Unstable { .. } => "unstable",
            Status::Singular { .. } => "singular",
            Status::Overflow => "overflow",
            Status::NotConverged => "not converged",
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Status::Converged => f.write_str("converged to a stable equilibrium"),
            Status::Unstable { coordinates } => {
                write!(f, "unstable equilibrium in {}", coordinates.join(", "))
            }
            Status::Singular { coordinates } => {
                write!(f, "singular: nothing constrains {}", coordinates.join(", "))
            }
            Status::TipsOver { feet } if feet.is_empty() => f.write_str("tips over: no stable pose is left"),
            Status::TipsOver { feet } => write!(f, "tips over about {}: no stable pose is left", feet.join(" – ")),
            Status::Floats => f.write_str("floats: weight and loads do not press the crane onto its feet"),
            Status::Slides { feet } => {
                write!(f, "slides: what pulls it sideways exceeds the friction under {}", feet.join(", "))
            }
            Status::Overflow => f.write_str("forces overflow: a mass, a stiffness or a position is out of range"),
            Status::NotConverged => f.write_str("not converged: no equilibrium found from this guess"),
        }
    }
}
