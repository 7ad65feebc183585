//! Potential energy of gravity and its derivatives; γ is the acceleration of gravity.

use super::inertia::Inertias;
use super::kinematics::Kinematics;
use super::model::Model;
use super::tangent::Tangent;
use super::vector::Vec3;
use crate::chain::BodyId;
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

/// Adds `∂²E_g/∂q_i∂q_j = −γ · Ω_i Ω_j s_j`, i ≤ j on the path of j, and the contribution of curvatures.
pub fn add_stiffness<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    inertias: &Inertias<'g>,
    tangent: &mut Tangent<'_, 'g>,
) {
    let (gravity, zero) = (model.vector(&model.chain.gravity), Vec3::zero(model.graph));
    for (j, moving) in kinematics.generators.iter().enumerate() {
        let composite = &inertias.composites[moving.body];
        // −γ · (ω_i × u) = −ω_i · (u × γ)
        let torque = composite.linear_momentum(moving.omega, moving.upsilon).cross(gravity);
        tangent.add(j, [Some(BodyId(moving.body)), None], [zero, -torque]);
    }
    for curvature in &kinematics.curvatures {
        let composite = &inertias.composites[curvature.body];
        // −γ · (e × s) = −e · (s × γ), s about the joint's point.
        let torque = (composite.first - composite.mass * curvature.pose.origin).cross(gravity);
        curvature.add_works(-torque, &mut tangent.matrix);
    }
}
