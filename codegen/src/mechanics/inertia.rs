//! Pseudo-inertias in the world frame.
//!
//! `W(p) = T H Tᵀ` of a body, and the composite `W_j = Σ W(p)` over the bodies that coordinate j moves. The ten
//! numbers of W are stored as the mass, the first moments `s = ∫ x dm` and, for the second moments `Σ = ∫ x xᵀ dm`, the inertia
//! tensor `I = tr(Σ) 1 − Σ`, all about the world's origin.

use crate::chain::{BodyId, Inertia};

use super::kinematics::{Kinematics, Pose};
use super::model::Model;
use super::vector::{Symmetric3, Vec3};
use crate::symbolic::Expr;

/// A pseudo-inertia about the world's origin.
#[derive(Clone, Copy, Debug)]
pub struct WorldInertia<'g> {
    pub mass: Expr<'g>,
    /// s = ∫ x dm, kg m.
    pub first: Vec3<'g>,
    /// I = ∫ (xᵀx 1 − x xᵀ) dm, kg m².
    pub tensor: Symmetric3<'g>,
}

impl<'g> WorldInertia<'g> {
    /// Linear momentum `∫ Ωx dm` of the motion `Ωx = ω × x + υ`.
    pub fn linear_momentum(&self, omega: Vec3<'g>, upsilon: Vec3<'g>) -> Vec3<'g> {
        omega.cross(self.first) + self.mass * upsilon
    }

    /// Angular momentum `∫ x × Ωx dm` about the world's origin.
    pub fn angular_momentum(&self, omega: Vec3<'g>, upsilon: Vec3<'g>) -> Vec3<'g> {
        self.tensor.apply(omega) + self.first.cross(upsilon)
    }

    fn plus(self, other: Self) -> Self {
        WorldInertia {
            mass: self.mass + other.mass,
            first: self.first + other.first,
            tensor: self.tensor + other.tensor,
        }
    }
}

/// World pseudo-inertias of the bodies (`None` for massless frames), and the composites of each body and everything beyond it.
pub struct Inertias<'g> {
    pub bodies: Vec<Option<WorldInertia<'g>>>,
    pub composites: Vec<WorldInertia<'g>>,
}

impl<'g> Inertias<'g> {
    pub fn new(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Self {
        let bodies: Vec<_> = model
            .chain
            .bodies
            .iter()
            .zip(&kinematics.poses)
            .map(|(body, pose)| Some(world_inertia(model, body.inertia.as_ref()?, pose, &body.name)))
            .collect();
        let zero = model.zero();
        let nothing = WorldInertia { mass: zero, first: Vec3([zero; 3]), tensor: Symmetric3([zero; 6]) };
        // What is beyond each body, while its children are added.
        let mut composites: Vec<Option<WorldInertia<'g>>> = vec![None; bodies.len()];
        for (index, (inertia, body)) in bodies.iter().zip(&model.chain.bodies).enumerate().rev() {
            let mut sum = composites[index].unwrap_or(nothing);
            if let Some(inertia) = inertia {
                sum = sum.plus(*inertia);
                sum.first.named(&format!("first_from_{}", body.name));
                sum.tensor.named(&format!("inertia_from_{}", body.name));
            }
            composites[index] = Some(sum);
            if let Some(BodyId(parent)) = body.parent {
                composites[parent] = Some(composites[parent].map_or(sum, |others| others.plus(sum)));
            }
        }
        Inertias { bodies, composites: composites.into_iter().map(|composite| composite.unwrap_or(nothing)).collect() }
    }
}

/// `W = T H Tᵀ`: `s = R s_H + m r`, `Σ = R Σ_H Rᵀ + u rᵀ + r uᵀ` with `u = R s_H + ½ m r`.
fn world_inertia<'g>(model: &Model<'g>, inertia: &Inertia, pose: &Pose<'g>, name: &str) -> WorldInertia<'g> {
    let mass = model.number(&inertia.mass);
    let first = pose.rotation.apply(model.vector(&inertia.first));
    let second = model.second_moments(inertia);
    let lever = (0.5 * mass) * pose.origin;
    let second = second.rotated(pose.rotation) + Symmetric3::outer(first + lever, pose.origin);
    let tensor = second.tensor().named(&format!("inertia_{name}"));
    WorldInertia { mass, first: (first + mass * pose.origin).named(&format!("first_{name}")), tensor }
}
