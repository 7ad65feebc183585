//! Rotors: inertia I of a joint's own, reflected from the motor by the square of the gear ratio.
//!
//! It adds `I` to the diagonal of A and `½ I q̇²` to the kinetic energy. Freeing the joint, it is a resistance: `τ − I q̈` acts on
//! what the joint carries ([`super::articulated`]).

use super::model::Model;
use crate::symbolic::Expr;

/// Coordinates with a rotor, and its inertia, kg m² or kg.
pub fn by_coordinate<'a, 'g>(model: &'a Model<'g>) -> impl Iterator<Item = (usize, Expr<'g>)> + 'a {
    model.chain.rotors.iter().map(|rotor| (rotor.coordinate.0, model.number(&rotor.armature)))
}

/// The inertia of every coordinate's rotor; zero where there is none.
pub fn armatures<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let mut armatures = model.zeros();
    for (j, armature) in by_coordinate(model) {
        armatures[j] = armature;
    }
    armatures
}

/// `twice + Σ I q̇²`
pub fn twice_the_energy<'g>(model: &Model<'g>, twice: Expr<'g>) -> Expr<'g> {
    by_coordinate(model).fold(twice, |sum, (j, armature)| sum + armature * model.v[j].squared())
}
