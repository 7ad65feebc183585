//! Mass matrix, bias and kinetic energy.

use super::inertia::Inertias;
use super::kinematics::Kinematics;
use super::model::Model;
use super::twist::Twist;
use super::vector::{SymmetricMatrix, Vec3};
use crate::symbolic::Expr;

/// `a_ij = tr(Ω_i W_max(i,j) Ω_jᵀ) = ω_i · L_j + υ_i · P_j`, i ≤ j [Urbaś 2016, Eq. (5), by composites].
///
/// P_j and L_j are the momenta of all that coordinate j moves, at unit rate.
pub fn mass_matrix<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, inertias: &Inertias<'g>) -> SymmetricMatrix<'g> {
    let mut matrix = SymmetricMatrix::zero(model.graph, model.size());
    for (j, moving) in kinematics.generators.iter().enumerate() {
        let composite = &inertias.composites[moving.body];
        let linear = composite.linear_momentum(moving.omega, moving.upsilon);
        let angular = composite.angular_momentum(moving.omega, moving.upsilon);
        for (i, before) in kinematics.generators[..=j].iter().enumerate() {
            matrix.add(i, j, before.omega.dot(angular) + before.upsilon.dot(linear));
        }
    }
    matrix
}

/// `e_i = −(h_i + g_i) = −tr(Ω_i Z_i)`, `Z_i = Σ T H B̄ᵀ` over the bodies that coordinate i moves, `B̄ = G T` their bias
/// acceleration less gravity [Urbaś 2016, Eqs. (5), (7), (9), by recursion].
///
/// Of Z_i only the resultant F and the moment N about the world's origin matter: `tr(Ω_i Z_i) = ω_i · N + υ_i · F`.
pub fn bias<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    inertias: &Inertias<'g>,
    twists: &[Twist<'g>],
) -> Vec<Expr<'g>> {
    let mut force = Vec3::zero(model.graph);
    let mut moment = force;
    let mut body = model.chain.bodies.len();
    let mut bias = model.zeros();
    for (i, generator) in kinematics.generators.iter().enumerate().rev() {
        while body > generator.body {
            body -= 1;
            let Some(inertia) = &inertias.bodies[body] else { continue };
            let Twist { omega, alpha, acceleration, .. } = twists[body];
            let first = inertia.first;
            force = force + alpha.cross(first) + omega.cross(omega.cross(first)) + inertia.mass * acceleration;
            moment = moment
                + inertia.tensor.apply(alpha)
                + omega.cross(inertia.tensor.apply(omega))
                + first.cross(acceleration);
            let name = &model.chain.bodies[body].name;
            force.named(&format!("force_from_{name}"));
            moment.named(&format!("moment_from_{name}"));
        }
        bias[i] = -(generator.omega.dot(moment) + generator.upsilon.dot(force));
    }
    bias
}

/// `E_k = ½ Σ tr(Ṫ H Ṫᵀ) = ½ Σ tr(V W Vᵀ)` [Urbaś 2016, Eq. (4)].
pub fn kinetic_energy<'g>(model: &Model<'g>, inertias: &Inertias<'g>, twists: &[Twist<'g>]) -> Expr<'g> {
    let mut twice = model.zero();
    for (inertia, twist) in inertias.bodies.iter().zip(twists) {
        if let Some(inertia) = inertia {
            twice = twice
                + twist.omega.dot(inertia.angular_momentum(twist.omega, twist.upsilon))
                + twist.upsilon.dot(inertia.linear_momentum(twist.omega, twist.upsilon));
        }
    }
    0.5 * twice
}
