//! Kinetic energy.

use super::inertia::Inertias;
use super::model::Model;
use super::rotors;
use super::twist::Twist;
use crate::symbolic::Expr;

/// `E_k = ½ Σ tr(Ṫ H Ṫᵀ) = ½ Σ tr(V W Vᵀ)` [Urbaś 2016, Eq. (4)], and `½ Σ I q̇²` of rotors.
pub fn kinetic_energy<'g>(model: &Model<'g>, inertias: &Inertias<'g>, twists: &[Twist<'g>]) -> Expr<'g> {
    let mut twice = model.zero();
    for (inertia, twist) in inertias.bodies.iter().zip(twists) {
        if let Some(inertia) = inertia {
            twice = twice
                + twist.omega.dot(inertia.angular_momentum(twist.omega, twist.upsilon))
                + twist.upsilon.dot(inertia.linear_momentum(twist.omega, twist.upsilon));
        }
    }
    0.5 * rotors::twice_the_energy(model, twice)
}
