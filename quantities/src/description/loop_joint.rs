//! Joints that close loops, and exact couplings.

use super::{AttachmentInfo, List, Text};
use crate::ColumnKind;

/// A joint that closes a loop, or a coupling that holds exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopJointInfo {
    /// Name.
    pub name: Text,
    /// `ball`, `pin`, `rod`, `slide`, `pad`, what holds a stage of a telescope exactly, or `coupling`.
    pub kind: Text,
    /// Its points; the directions of its forces are in the axes of the first. A coupling has none.
    pub ends: Option<[AttachmentInfo; 2]>,
    /// The coordinates that move its points against each other, or that it ties: the first, and the one after the last.
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

    /// Whether it ties two coordinates.
    pub fn is_coupling(&self) -> bool {
        self.ends.is_none()
    }

    /// Whether it holds something to the world.
    pub fn holds_to_world(&self) -> bool {
        self.ends.iter().flatten().any(|end| end.body.is_none())
    }

    /// What it is, for messages.
    #[cfg(feature = "std")]
    pub fn words(&self) -> String {
        format!("{} {}", if self.is_coupling() { "rigid coupling" } else { "loop joint" }, self.name)
    }

    /// What distinguishes the crane from an open chain, for messages.
    #[cfg(feature = "std")]
    pub fn closes(&self) -> String {
        if self.is_coupling() { self.words() } else { format!("the loop that {} closes", self.name) }
    }

    /// What else a user can do where an open chain is needed, for messages; empty where there is nothing.
    pub fn remedy(&self) -> &'static str {
        if self.is_coupling() { ", or give the coupling a `stiffness` instead of `rigid: true`" } else { "" }
    }
}

/// An equation of a joint that closes a loop, or of a coupling.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoopEquationInfo {
    /// The direction of its force or moment; empty for a rod, whose force is along it, and for a coupling.
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

    /// The word for what it transmits.
    pub fn what(&self) -> &'static str {
        match (self.is_moment, self.direction.as_str()) {
            (false, _) => "force",
            (true, "") => "torque",
            (true, _) => "moment",
        }
    }

    /// Name of the column of results with what it transmits, of a joint with a name.
    #[cfg(feature = "std")]
    pub fn column(&self, joint: &str) -> String {
        [joint, self.effort().ending_along(&self.direction)].concat()
    }
}
