//! Laws of force elements: a strain s, which depends on the pose, and its rate determine a force F, positive where it resists a
//! growing strain.

use super::model::Model;
use crate::chain::{End, Friction, Stop};
use crate::symbolic::Expr;

/// `δ = max(0, s)` of an end stop, with `s = ±(q − q_stop)` the travel beyond it, and the sign `∂s/∂q`.
fn depth<'g>(model: &Model<'g>, stop: &Stop, q: Expr<'g>) -> (Expr<'g>, f64) {
    let at = model.number(&stop.at);
    let (beyond, sign) = match stop.end {
        End::Lower => (at - q, -1.0),
        End::Upper => (q - at, 1.0),
    };
    (beyond.max(model.zero()), sign)
}

/// `F = k δ max(0, 1 + a δ̇)` of a stop, along q: it pushes and never pulls.
pub fn stop_force<'g>(model: &Model<'g>, stop: &Stop, q: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
    let (depth, sign) = depth(model, stop, q);
    let approach = (1.0 + model.number(&stop.damping) * (sign * rate)).max(model.zero());
    sign * (model.number(&stop.stiffness) * depth * approach)
}

/// `k δ²`, twice the energy that a stop stores.
pub fn twice_stop_energy<'g>(model: &Model<'g>, stop: &Stop, q: Expr<'g>) -> Expr<'g> {
    let (depth, _) = depth(model, stop, q);
    model.number(&stop.stiffness) * depth.squared()
}

/// `k δ max(−1, a δ̇) δ̇ ≥ 0`: the power that a stop dissipates, that of F minus the rate of change of its energy.
pub fn stop_dissipation<'g>(model: &Model<'g>, stop: &Stop, q: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
    let (depth, sign) = depth(model, stop, q);
    let approach = sign * rate;
    let share = (model.number(&stop.damping) * approach).max(model.graph.constant(-1.0));
    model.number(&stop.stiffness) * depth * (share * approach)
}

/// `k a δ`, the damping of a stop at rest.
pub fn stop_damping_at_rest<'g>(model: &Model<'g>, stop: &Stop, q: Expr<'g>) -> Expr<'g> {
    let (depth, _) = depth(model, stop, q);
    model.number(&stop.stiffness) * model.number(&stop.damping) * depth
}

/// `F = (F_c + (F_b − F_c) exp(−(q̇/v_s)²)) tanh(q̇/v₀) + b q̇`; for a joint with bristles only `b q̇`, since
/// the rest follows from a state.
pub fn friction_force<'g>(model: &Model<'g>, friction: &Friction, rate: Expr<'g>) -> Expr<'g> {
    if friction.bristle.is_some() {
        return model.number(&friction.viscous) * rate;
    }
    let coulomb = model.number(&friction.coulomb);
    let size = friction.breakaway.as_ref().map_or(coulomb, |(breakaway, stribeck)| {
        let decline = (-(rate / model.number(stribeck)).squared()).exp();
        coulomb + (model.number(breakaway) - coulomb) * decline
    });
    size * (rate / model.number(&friction.width)).tanh() + model.number(&friction.viscous) * rate
}
