//! The first sweep of every recursion along the chain: from the base to the tips, in local frames.
//!
//! Notation
//! : `ω` angular velocity of the frame reached, `a` acceleration of its origin, `α` its angular acceleration, all in
//!   components of that frame. Accelerations are the classical ones of points, so that no linear velocity is needed.
//!
//! Output
//! : ω after every factor, and the part of the accelerations that depends only on velocities:
//!   `α = Rᵀ α₋ + e q̈ + ω × e q̇` at a rotation, `a = a₋ + α × d + ω × (ω × d)` at a translation by d, and
//!   `e q̈ + 2 ω × e q̇` in addition where d changes.

use super::axis_rotation::AxisRotation;
use super::factors::{Factor, Reached};
use super::model::Model;
use super::vector::Vec3;
use crate::symbolic::Expr;

/// The velocity-dependent terms at one factor.
#[derive(Clone, Copy, Debug)]
pub enum Velocities<'g> {
    /// Angular velocity after a rotation, and `ω × e q̇`.
    Revolute { gyration: Vec3<'g> },
    /// `ω × e q̇` at each of three rotations, each in its own frame.
    Ball { gyrations: [Vec3<'g>; 3] },
    /// Rates of a rotation vector, the relative angular velocity w after it, and `ω × w`.
    RotationVector { rates: Vec3<'g>, gyration: Vec3<'g> },
    /// The displacement d of a translation, and `ω × (ω × d)` with the Coriolis acceleration.
    Translation { by: Vec3<'g>, acceleration: Vec3<'g> },
    /// A constant rotation changes only components.
    Rotation,
    /// The frame of a body, with its angular velocity.
    Body { omega: Vec3<'g> },
    /// The beginning of a branch.
    Branch,
}

/// Sweeps outward along `factors` with the velocities `v`, the base at rest.
pub fn velocities<'g>(model: &Model<'g>, factors: &[Factor<'g>], v: &[Expr<'g>]) -> Vec<Velocities<'g>> {
    let mut omega = Vec3::zero(model.graph);
    let mut reached = Reached::new();
    let sweep = model.graph.sweep();
    factors
        .iter()
        .map(|factor| {
            let velocities = along(model, &mut omega, factor, v);
            reached.follow(factor, &mut omega);
            if let Factor::Body(index) = factor {
                sweep.leave(&model.chain.bodies[*index].name);
            }
            velocities
        })
        .collect()
}

/// Transforms ω across one factor; at a branch, it stays.
pub fn along<'g>(model: &Model<'g>, omega: &mut Vec3<'g>, factor: &Factor<'g>, v: &[Expr<'g>]) -> Velocities<'g> {
    let mut rotate = |rotation: &AxisRotation<'g>, rate: Expr<'g>| {
        let spin = Vec3::along(rotation.axis, rate);
        *omega = rotation.to_inner(*omega) + spin;
        omega.cross(spin)
    };
    match factor {
        Factor::Translate(by) => Velocities::Translation { by: *by, acceleration: centripetal(*omega, *by) },
        Factor::Rotation(rotation) => {
            *omega = rotation.to_inner(*omega);
            Velocities::Rotation
        }
        Factor::Revolute { j, rotation } => Velocities::Revolute { gyration: rotate(rotation, v[*j]) },
        Factor::Prismatic { j, axis } => {
            let by = Vec3::along(*axis, model.q[*j]);
            let coriolis = omega.cross(Vec3::along(*axis, 2.0 * v[*j]));
            Velocities::Translation { by, acceleration: centripetal(*omega, by) + coriolis }
        }
        Factor::Ball { j, rotations } => {
            let mut gyration = |k: usize| rotate(&rotations[k], v[j + k]);
            Velocities::Ball { gyrations: [gyration(0), gyration(1), gyration(2)] }
        }
        Factor::RotationVector { j, vector } => {
            let rates = Vec3(vector.along_axes([v[*j], v[j + 1], v[j + 2]]));
            let spin = vector.spin(rates);
            *omega = vector.rotation().apply_transposed(*omega) + spin;
            Velocities::RotationVector { rates, gyration: omega.cross(spin) }
        }
        Factor::Body(index) => {
            omega.named(&format!("omega_{}", model.chain.bodies[*index].name));
            Velocities::Body { omega: *omega }
        }
        Factor::Branch(_) => Velocities::Branch,
    }
}

/// `ω × (ω × d)`
fn centripetal<'g>(omega: Vec3<'g>, d: Vec3<'g>) -> Vec3<'g> {
    omega.cross(omega.cross(d))
}
