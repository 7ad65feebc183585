//! Joints that close loops.

use crane_quantities::ColumnKind;

use super::{AttachmentInfo, List, Text};

/// A joint that closes a loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopJointInfo {
    /// Name.
    pub name: Text,
    /// `ball`, `pin`, `rod`, `slide`, or `pad`: what holds a stage of a telescope exactly.
    pub kind: Text,
    /// Its points; the directions of its forces are in the axes of the first.
    pub ends: [AttachmentInfo; 2],
    /// The coordinates that move its points against each other: the first, and the one after the last.
    pub spanned: [usize; 2],
    /// Its equations.
    pub equations: List<LoopEquationInfo>,
}

impl LoopJointInfo {
    /// Whether it holds the distance of its points.
    pub fn is_rod(&self) -> bool {
        self.kind.as_str() == "rod"
    }

    /// Whether it is a pad on which a beam slides.
    pub fn is_pad(&self) -> bool {
        self.kind.as_str() == "pad"
    }
}

/// An equation of a joint that closes a loop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopEquationInfo {
    /// The direction of its force or moment; empty for a rod, whose force is along it.
    pub direction: Text,
    /// Whether it transmits a moment, N m, instead of a force, N.
    pub is_moment: bool,
}

impl LoopEquationInfo {
    /// Unit of its gap.
    pub const fn unit(&self) -> &'static str {
        if self.is_moment { "rad" } else { "m" }
    }

    /// Unit of the rate of its gap.
    pub const fn rate_unit(&self) -> &'static str {
        if self.is_moment { "rad/s" } else { "m/s" }
    }

    /// What the column with what it transmits shows.
    pub const fn effort(&self) -> ColumnKind {
        if self.is_moment { ColumnKind::LoopMoment } else { ColumnKind::LoopForce }
    }

    /// Unit of what it transmits.
    pub const fn force_unit(&self) -> &'static str {
        if self.is_moment { "N m" } else { "N" }
    }

    /// Name of the column of results with what it transmits, of a joint with a name.
    #[cfg(feature = "std")]
    pub fn column(&self, joint: &str) -> String {
        [joint, self.effort().ending_along(&self.direction)].concat()
    }
}
