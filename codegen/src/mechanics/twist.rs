//! Velocities of bodies and their accelerations at q̈ = 0.
//!
//! The world twist `V = Σ Ω_j q̇_j` of a body gives `Ṫ = V T`. With gravity taken as an upward acceleration of the base,
//! the bias acceleration is `T̈ − γ = G T`, `G = V̇ + V²`, at q̈ = 0. Along the chain
//! `V̇_j = V̇_{j−1} + q̇_j (V_{j−1} Ω_j − Ω_j V_{j−1})`.

use super::kinematics::Kinematics;
use super::model::Model;
use super::vector::Vec3;

/// Twist and bias acceleration of a body in the world frame: a point at x has the velocity `ω × x + υ`, and, at q̈ = 0,
/// the acceleration `α × x + ω × (ω × x) + g` less that of gravity.
#[derive(Clone, Copy, Debug)]
pub struct Twist<'g> {
    pub omega: Vec3<'g>,
    pub upsilon: Vec3<'g>,
    /// α, the rotational part of V̇.
    pub alpha: Vec3<'g>,
    /// Last column of G, with gravity.
    pub acceleration: Vec3<'g>,
}

/// Twists of all bodies.
pub fn twists<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Twist<'g>> {
    let mut omega = Vec3::zero(model.graph);
    let mut upsilon = omega;
    let mut alpha = omega;
    let mut alpha_upsilon = -model.vector(&model.chain.gravity);
    let mut next = 0;
    let mut twists = Vec::new();
    for (index, body) in model.chain.bodies.iter().enumerate() {
        while let Some(generator) = kinematics.generators.get(next).filter(|g| g.body == index) {
            let rate = model.v[next];
            let (w, u) = (rate * generator.omega, rate * generator.upsilon);
            // V̇ uses the twist before this motion; Ω_j commutes with itself.
            alpha_upsilon = alpha_upsilon + omega.cross(u) - w.cross(upsilon);
            alpha = alpha + omega.cross(w);
            omega = omega + w;
            upsilon = upsilon + u;
            next += 1;
        }
        omega.named(&format!("omega_{}", body.name));
        upsilon.named(&format!("upsilon_{}", body.name));
        alpha.named(&format!("alpha_{}", body.name));
        twists.push(Twist { omega, upsilon, alpha, acceleration: alpha_upsilon + omega.cross(upsilon) });
    }
    twists
}
