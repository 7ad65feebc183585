//! Joints that close loops, equations between two attachments, φ(q) = 0; and exact couplings, equations between two coordinates.

use super::{Attachment, Axis, Chain, CoordinateId, CoordinateKind, Follower, PadDirection, Sliding, Value, Vector};

/// A joint between two attachments that are already connected through other joints.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopJoint {
    /// Unique name.
    pub name: String,
    /// Its points; directions are in the axes of the first. Of a pad: itself, and the beginning of the beam that slides on it.
    pub ends: [Attachment; 2],
    /// What it holds together.
    pub kind: LoopJointKind,
}

/// What a joint that closes a loop holds together.
#[derive(Clone, Debug, PartialEq)]
pub enum LoopJointKind {
    /// The points.
    Ball,
    /// The points, and a direction of both bodies.
    Pin {
        /// Directions normal to it in the axes of the first body.
        across: Across,
        /// Unit vector along it in the axes of the second body.
        to_axis: Vector,
    },
    /// The points at a distance.
    Rod {
        /// Length, m.
        length: Value,
    },
    /// The second point on a line of the first body.
    Slide {
        /// Directions normal to the line, in the axes of the first body.
        across: Across,
    },
    /// The axis of a beam on a pad of the first body.
    Pad {
        /// The beam, once for each direction in which the pad holds it.
        held: Vec<Sliding>,
    },
}

/// A coupling that holds exactly: `q_j − r q_i − c = 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidCoupling {
    /// Unique name.
    pub name: String,
    /// The coordinate and the one that it follows.
    pub follower: Follower,
    /// Whether it transmits a torque to the coordinate instead of a force.
    pub kind: CoordinateKind,
}

/// Two unit vectors u, w normal to an axis a, with `u × w = a`, and their names.
#[derive(Clone, Debug, PartialEq)]
pub struct Across {
    /// u and w.
    pub directions: [Vector; 2],
    /// `x`, `y` or `z` if they are axes of the body, otherwise `u` and `w`.
    pub names: [&'static str; 2],
    /// a.
    pub axis: Vector,
}

/// One of the equations of a joint or a coupling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoopEquation {
    /// The direction of its force or moment; empty for a rod and a coupling.
    pub direction: &'static str,
    /// Whether it transmits a moment, N m, instead of a force, N.
    pub is_moment: bool,
}

impl LoopJointKind {
    /// The word for it in a spec.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            LoopJointKind::Ball => "ball",
            LoopJointKind::Pin { .. } => "pin",
            LoopJointKind::Rod { .. } => "rod",
            LoopJointKind::Slide { .. } => "slide",
            LoopJointKind::Pad { .. } => "pad",
        }
    }

    /// Its equations, in order.
    #[must_use]
    pub fn equations(&self) -> Vec<LoopEquation> {
        let forces = |directions: &[&'static str]| -> Vec<LoopEquation> {
            directions.iter().map(|&direction| LoopEquation { direction, is_moment: false }).collect()
        };
        match self {
            LoopJointKind::Ball => forces(&["x", "y", "z"]),
            LoopJointKind::Pin { across, .. } => {
                let moments = across.names.map(|direction| LoopEquation { direction, is_moment: true });
                [forces(&["x", "y", "z"]), moments.to_vec()].concat()
            }
            LoopJointKind::Rod { .. } => forces(&[""]),
            LoopJointKind::Slide { across } => forces(&across.names),
            LoopJointKind::Pad { held } => held.iter().map(|sliding| at_pad(sliding.direction)).collect(),
        }
    }

    /// The beam that slides, of a pad.
    #[must_use]
    pub fn slides(&self) -> Option<&Sliding> {
        match self {
            LoopJointKind::Pad { held } => held.first(),
            LoopJointKind::Ball
            | LoopJointKind::Pin { .. }
            | LoopJointKind::Rod { .. }
            | LoopJointKind::Slide { .. } => None,
        }
    }
}

impl RigidCoupling {
    /// The word for it.
    pub const KIND: &str = "coupling";

    /// Its equation.
    #[must_use]
    pub fn equation(&self) -> LoopEquation {
        LoopEquation { direction: "", is_moment: self.kind == CoordinateKind::Rotation }
    }
}

impl LoopEquation {
    /// The word for what it transmits.
    fn what(self) -> &'static str {
        match self {
            Self { is_moment: false, .. } => "force",
            Self { direction: "", .. } => "torque",
            Self { .. } => "moment",
        }
    }
}

/// The equation of a direction in which a pad holds a beam.
fn at_pad(direction: PadDirection) -> LoopEquation {
    match direction {
        PadDirection::Along(Axis::X) | PadDirection::Twist => LoopEquation { direction: "x", is_moment: true },
        PadDirection::Along(Axis::Y) => LoopEquation { direction: "y", is_moment: false },
        PadDirection::Along(Axis::Z) => LoopEquation { direction: "z", is_moment: false },
    }
}

impl Across {
    /// Directions normal to an axis of any length above zero: the axes of the body if it is one of them.
    #[must_use]
    pub fn to(axis: Vector) -> Self {
        const UNITS: [Vector; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        const NAMES: [&str; 3] = ["x", "y", "z"];
        let a = normalised(axis);
        if let Some(along) = (0..3).find(|&i| a[i].abs() >= 1.0) {
            let [u, w] = [1, 2].map(|next| (along + next) % 3);
            return Self { directions: [UNITS[u], UNITS[w]], names: [NAMES[u], NAMES[w]], axis: UNITS[along] };
        }
        let least = (0..3).min_by(|&i, &j| a[i].abs().total_cmp(&a[j].abs())).unwrap_or(0);
        let u = normalised([0, 1, 2].map(|i| UNITS[least][i] - a[least] * a[i]));
        let w = [a[1] * u[2] - a[2] * u[1], a[2] * u[0] - a[0] * u[2], a[0] * u[1] - a[1] * u[0]];
        Self { directions: [u, w], names: ["u", "w"], axis: a }
    }
}

/// A vector over its length.
#[must_use]
pub fn normalised(vector: Vector) -> Vector {
    let length = libm::sqrt(vector.iter().map(|x| x * x).sum());
    vector.map(|x| x / length)
}

impl Chain {
    /// Names of all equations of loop joints and exact couplings, in order: `<joint> force <direction>` or `<joint> moment <direction>`, and
    /// `<coupling> force` or `<coupling> torque`.
    pub fn loop_equations(&self) -> impl Iterator<Item = String> + '_ {
        let name = |name: &str, equation: LoopEquation| {
            format!("{name} {} {}", equation.what(), equation.direction).trim_end().to_owned()
        };
        let of_joints = self
            .loop_joints
            .iter()
            .flat_map(move |joint| joint.kind.equations().into_iter().map(move |equation| name(&joint.name, equation)));
        of_joints.chain(self.rigid_couplings.iter().map(move |coupling| name(&coupling.name, coupling.equation())))
    }

    /// Whether some equations tie coordinates to each other.
    #[must_use]
    pub fn has_loops(&self) -> bool {
        !self.loop_joints.is_empty() || !self.rigid_couplings.is_empty()
    }

    /// The coordinates that move the ends of a joint against each other, in the order of q.
    #[must_use]
    pub fn closed_by(&self, joint: &LoopJoint) -> Vec<CoordinateId> {
        match joint.kind.slides() {
            Some(sliding) => self.changing_at(sliding),
            None => self.between(&joint.ends.each_ref().map(|end| self.reach(end))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_across_an_axis_complete_a_frame() {
        for axis in [[0.0, 0.0, -2.0], [3.0, 0.0, 0.0], [1.0, -2.0, 0.5]] {
            let Across { directions: [u, w], axis, .. } = Across::to(axis);
            let dot = |a: Vector, b: Vector| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
            // A few rounding errors of numbers up to 1.
            for (a, b, expected) in
                [(u, u, 1.0), (w, w, 1.0), (axis, axis, 1.0), (u, w, 0.0), (u, axis, 0.0), (w, axis, 0.0)]
            {
                assert!((dot(a, b) - expected).abs() < 1e-15);
            }
            let triple = u[0] * (w[1] * axis[2] - w[2] * axis[1])
                + u[1] * (w[2] * axis[0] - w[0] * axis[2])
                + u[2] * (w[0] * axis[1] - w[1] * axis[0]);
            assert!((triple - 1.0).abs() < 1e-15);
        }
    }
}
