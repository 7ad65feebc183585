//! The bias by Newton's and Euler's equations in local frames: two sweeps, O(n).
//!
//! J. Y. S. Luh, M. W. Walker, R. P. C. Paul, J. Dyn. Syst. Meas. Control 102 (1980) 69, with q̈ = 0.

use super::factors::Factor;
use super::model::Model;
use super::outward::{Velocities, along};
use super::vector::Vec3;
use crate::symbolic::Expr;

/// `e = −(h + g)` [Urbaś 2016, Eqs. (5), (7), (9), by recursion]; the base is accelerated against gravity.
pub fn bias<'g>(model: &Model<'g>, factors: &[Factor<'g>]) -> Vec<Expr<'g>> {
    let zero = Vec3::zero(model.graph);
    // Outward: ω, α and a of each frame. In one sweep the three chains of dependent operations run side by side.
    let (mut omega, mut alpha, mut a) = (zero, zero, -model.vector(&model.chain.gravity));
    let mut motions = Vec::new();
    let sweep = model.graph.sweep();
    for factor in factors {
        let velocities = along(model, &mut omega, factor, &model.v);
        match (factor, &velocities) {
            (Factor::Turn(turn), _) => (alpha, a) = (turn.inward(alpha), turn.inward(a)),
            (Factor::Revolute { turn, .. }, Velocities::Revolute { gyration }) => {
                (alpha, a) = (turn.inward(alpha) + *gyration, turn.inward(a));
            }
            (Factor::Ball { turns, .. }, Velocities::Ball { gyrations }) => {
                for (turn, gyration) in turns.iter().zip(gyrations) {
                    (alpha, a) = (turn.inward(alpha) + *gyration, turn.inward(a));
                }
            }
            (Factor::RotationVector { vector, .. }, Velocities::RotationVector { rates, gyration }) => {
                let rotation = vector.rotation();
                alpha = rotation.apply_transposed(alpha) + *gyration + vector.spin_rate(*rates);
                a = rotation.apply_transposed(a);
            }
            (_, Velocities::Translation { by, acceleration }) => a = a + alpha.cross(*by) + *acceleration,
            (Factor::Body(index), _) => sweep.leave(&model.chain.bodies[*index].name),
            _ => {}
        }
        motions.push((velocities, alpha, a));
    }
    // Inward: force and moment that each frame takes.
    let (mut force, mut moment) = (zero, zero);
    let mut bias = model.zeros();
    let sweep = model.graph.sweep();
    for (factor, (velocities, alpha, a)) in factors.iter().zip(motions).rev() {
        match (factor, velocities) {
            (Factor::Body(index), Velocities::Body { omega }) => {
                let body = &model.chain.bodies[*index];
                sweep.visit(&body.name);
                if let Some(inertia) = &body.inertia {
                    let (mass, first) = (model.number(&inertia.mass), model.vector(&inertia.first));
                    let tensor = model.second_moments(inertia).tensor();
                    force = force + mass * a + alpha.cross(first) + omega.cross(omega.cross(first));
                    moment = moment + tensor.apply(alpha) + omega.cross(tensor.apply(omega)) + first.cross(a);
                    force.named(&format!("force_{}", body.name));
                    moment.named(&format!("moment_{}", body.name));
                }
            }
            (Factor::Turn(_) | Factor::Revolute { .. } | Factor::Ball { .. }, _) => {
                for (j, turn) in factor.turns().into_iter().rev() {
                    if let Some(j) = j {
                        bias[j] = -moment[turn.axis.index()];
                    }
                    (force, moment) = (turn.outward(force), turn.outward(moment));
                }
            }
            (Factor::RotationVector { j, vector }, _) => {
                // Jᵀ R = J: what the moment does to the coordinates, by its components after the joint.
                let efforts = vector.jacobian().apply(moment);
                for (k, effort) in vector.by_coordinates(efforts.0).into_iter().enumerate() {
                    bias[j + k] = -effort;
                }
                let rotation = vector.rotation();
                (force, moment) = (rotation.apply(force), rotation.apply(moment));
            }
            (factor, Velocities::Translation { by, .. }) => {
                if let Factor::Prismatic { j, axis } = factor {
                    bias[*j] = -force[axis.index()];
                }
                moment = moment + by.cross(force);
            }
            _ => {}
        }
    }
    bias
}
