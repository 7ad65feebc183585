//! Velocities of bodies.
//!
//! The world twist `V = Σ Ω_j q̇_j` of a body gives `Ṫ = V T`.

use super::kinematics::Kinematics;
use super::model::Model;
use super::vector::Vec3;
use crate::chain::BodyId;

/// Twist of a body in the world frame: a point at x has the velocity `ω × x + υ`.
#[derive(Clone, Copy, Debug)]
pub struct Twist<'g> {
    pub omega: Vec3<'g>,
    pub upsilon: Vec3<'g>,
}

/// Twists of all bodies.
pub fn twists<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Twist<'g>> {
    let zero = Vec3::zero(model.graph);
    let mut next = 0;
    let mut twists: Vec<Twist<'g>> = Vec::new();
    for (index, body) in model.chain.bodies.iter().enumerate() {
        let before = body.parent.map_or(Twist { omega: zero, upsilon: zero }, |BodyId(parent)| twists[parent]);
        let Twist { mut omega, mut upsilon } = before;
        while let Some(generator) = kinematics.generators.get(next).filter(|g| g.body == index) {
            let rate = model.v[next];
            let (w, u) = (rate * generator.omega, rate * generator.upsilon);
            omega = omega + w;
            upsilon = upsilon + u;
            next += 1;
        }
        omega.named(&format!("omega_{}", body.name));
        upsilon.named(&format!("upsilon_{}", body.name));
        twists.push(Twist { omega, upsilon });
    }
    twists
}
