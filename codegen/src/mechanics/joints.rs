//! End stops and friction of joints: laws on single coordinates, `f_j = −F(q_j, q̇_j)`.

use super::drives;
use super::laws;
use super::model::Model;
use super::vector::SymmetricMatrix;
use crate::chain::{CoordinateId, Stop};
use crate::symbolic::Expr;

/// Generalized forces of the end stops.
pub fn stop_forces<'g>(model: &Model<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for (coordinate, stop) in model.chain.stops() {
        let j = coordinate.0;
        forces[j] = forces[j] - laws::stop_force(model, stop, model.q[j], v[j]);
    }
    forces
}

/// Generalized forces of friction.
pub fn friction_forces<'g>(model: &Model<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for (coordinate, friction) in model.chain.frictions() {
        let j = coordinate.0;
        forces[j] = forces[j] - laws::friction_force(model, friction, v[j]);
    }
    forces
}

/// Energy of the stops, `½ Σ k δ²`.
pub fn stop_energy<'g>(model: &Model<'g>) -> Expr<'g> {
    let twice = model.chain.stops().fold(model.zero(), |sum, (coordinate, stop)| {
        sum + laws::twice_stop_energy(model, stop, model.q[coordinate.0])
    });
    0.5 * twice
}

/// Power that stops dissipate.
pub fn stop_dissipation<'g>(model: &Model<'g>) -> Expr<'g> {
    model.chain.stops().fold(model.zero(), |sum, (coordinate, stop)| {
        let j = coordinate.0;
        sum + laws::stop_dissipation(model, stop, model.q[j], model.v[j])
    })
}

/// Power that friction dissipates.
pub fn friction_dissipation<'g>(model: &Model<'g>) -> Expr<'g> {
    model.chain.frictions().fold(model.zero(), |sum, (coordinate, friction)| {
        let rate = model.v[coordinate.0];
        sum + laws::friction_force(model, friction, rate) * rate
    })
}

/// `∂F/∂q_j` and `∂F/∂q̇_j` of all laws on each coordinate at the present state, for implicit steps. Where friction declines with
/// increasing rate, its derivative is set to 0: a step does not need the exact derivative, but `A + D̂` must stay positive definite.
pub fn stiffness_and_damping<'g>(model: &Model<'g>) -> Vec<[Expr<'g>; 2]> {
    let (stops, frictions) = (stop_forces(model, &model.v), friction_forces(model, &model.v));
    let drives = drives::stiffness_and_damping(model);
    let of = |force: Expr<'g>, by: Expr<'g>| -model.graph.derivatives(&[force], by)[0];
    (0..model.size())
        .map(|j| {
            let (q, v) = (model.q[j], model.v[j]);
            let declining = of(frictions[j], v);
            let friction = if declining.is_zero() { declining } else { declining.max(model.zero()) };
            let [stiffness, damping] = drives[j];
            [of(stops[j], q) + stiffness, of(stops[j], v) + friction + damping]
        })
        .collect()
}

/// Stiffness of the stops at rest, on the diagonal.
pub fn stop_stiffness<'g>(model: &Model<'g>, matrix: &mut SymmetricMatrix<'g>) {
    let forces = stop_forces(model, &model.zeros());
    for coordinate in model.chain.stopped() {
        let j = coordinate.0;
        matrix.add(j, j, -model.graph.derivatives(&[forces[j]], model.q[j])[0]);
    }
}

/// Damping of the stops at rest, on the diagonal.
pub fn stop_damping<'g>(model: &Model<'g>, matrix: &mut SymmetricMatrix<'g>) {
    let damping = |(id, stop): (CoordinateId, &Stop)| (id.0, laws::stop_damping_at_rest(model, stop, model.q[id.0]));
    matrix.add_diagonal(model.chain.stops().map(damping));
}

/// Viscous friction, on the diagonal. Coulomb friction is not part of it: a joint that sticks does not damp.
pub fn viscous_damping<'g>(model: &Model<'g>, matrix: &mut SymmetricMatrix<'g>) {
    matrix.add_diagonal(model.chain.frictions().map(|(id, friction)| (id.0, model.number(&friction.viscous))));
}
