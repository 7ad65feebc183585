//! Potential energy of gravity and its derivatives; γ is the acceleration of gravity.

use super::inertia::Inertias;
use super::kinematics::{Curvature, Kinematics};
use super::model::Model;
use super::vector::SymmetricMatrix;
use crate::chain::{BodyId, CoordinateId};
use crate::symbolic::Expr;

/// `E_g = −Σ γ · ∫ x dm` [Urbaś 2016, Eq. (6), with `T r_C`].
pub fn energy<'g>(model: &Model<'g>, inertias: &Inertias<'g>) -> Expr<'g> {
    let gravity = model.vector(&model.chain.gravity);
    inertias.composites.first().map_or(model.zero(), |all| -gravity.dot(all.first))
}

/// `g_i = ∂E_g/∂q_i = −γ · Ω_i s_i`, s_i the composite first moments [Urbaś 2016, Eq. (7)].
pub fn gradient<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, inertias: &Inertias<'g>) -> Vec<Expr<'g>> {
    let gravity = model.vector(&model.chain.gravity);
    kinematics
        .generators
        .iter()
        .map(|generator| {
            let composite = &inertias.composites[generator.body];
            -gravity.dot(composite.linear_momentum(generator.omega, generator.upsilon))
        })
        .collect()
}

/// `∂²E_g/∂q_i∂q_j = −γ · Ω_i Ω_j s_j`, i ≤ j on the path of j, and the contribution of curvatures.
pub fn stiffness<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    inertias: &Inertias<'g>,
    matrix: &mut SymmetricMatrix<'g>,
) {
    let gravity = model.vector(&model.chain.gravity);
    for (j, moving) in kinematics.generators.iter().enumerate() {
        let composite = &inertias.composites[moving.body];
        // γ · (ω_i × u) = ω_i · (u × γ)
        let torque = composite.linear_momentum(moving.omega, moving.upsilon).cross(gravity);
        for CoordinateId(i) in model.chain.coordinates_of(BodyId(moving.body)).into_iter().filter(|i| i.0 <= j) {
            matrix.add(i, j, -kinematics.generators[i].omega.dot(torque));
        }
    }
    for curvature in &kinematics.curvatures {
        let composite = &inertias.composites[curvature.body];
        // −γ · (e × s) = −e · (s × γ), s about the joint's point.
        let torque = (composite.first - composite.mass * curvature.pose.origin).cross(gravity);
        for ((m, n), work) in Curvature::PAIRS.into_iter().zip(curvature.works(torque)) {
            matrix.add(curvature.first + m, curvature.first + n, -work);
        }
    }
}
