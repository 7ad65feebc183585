//! The bias by Newton's and Euler's equations in local frames: two sweeps, O(n).
//!
//! J. Y. S. Luh, M. W. Walker, R. P. C. Paul, J. Dyn. Syst. Meas. Control 102 (1980) 69, with q̈ = 0.

use super::factors::Factor;
use super::model::Model;
use super::outward::{Velocities, velocities};
use super::vector::Vec3;
use crate::symbolic::Expr;

/// `e = −(h + g)` [Urbaś 2016, Eqs. (5), (7), (9), by recursion]; the base is accelerated against gravity.
pub fn bias<'g>(model: &Model<'g>, factors: &[Factor<'g>]) -> Vec<Expr<'g>> {
    let along = velocities(model, factors, &model.v);
    let zero = Vec3::zero(model.graph);
    // Outward: α and a of each frame.
    let (mut alpha, mut a) = (zero, -model.vector(&model.chain.gravity));
    let mut accelerations = Vec::new();
    let sweep = model.graph.sweep();
    for (factor, velocity) in factors.iter().zip(&along) {
        match (factor, velocity) {
            (Factor::Turn(turn), _) => (alpha, a) = (turn.inward(alpha), turn.inward(a)),
            (Factor::Revolute { turn, .. }, Velocities::Revolute { gyration }) => {
                (alpha, a) = (turn.inward(alpha) + *gyration, turn.inward(a));
            }
            (Factor::Ball { turns, .. }, Velocities::Ball { gyrations }) => {
                for (turn, gyration) in turns.iter().zip(gyrations) {
                    (alpha, a) = (turn.inward(alpha) + *gyration, turn.inward(a));
                }
            }
            (_, Velocities::Translation { by, acceleration }) => a = a + alpha.cross(*by) + *acceleration,
            (Factor::Body(index), _) => sweep.leave(&model.chain.bodies[*index].name),
            _ => {}
        }
        accelerations.push((alpha, a));
    }
    // Inward: force and moment that each frame takes.
    let (mut force, mut moment) = (zero, zero);
    let mut bias = model.zeros();
    let sweep = model.graph.sweep();
    for ((factor, velocity), (alpha, a)) in factors.iter().zip(&along).zip(accelerations).rev() {
        match (factor, velocity) {
            (Factor::Body(index), Velocities::Body { omega }) => {
                let body = &model.chain.bodies[*index];
                sweep.visit(&body.name);
                if let Some(inertia) = &body.inertia {
                    let (mass, first) = (model.number(&inertia.mass), model.vector(&inertia.first));
                    let tensor = model.second_moments(inertia).tensor();
                    force = force + mass * a + alpha.cross(first) + omega.cross(omega.cross(first));
                    moment = moment + tensor.apply(alpha) + omega.cross(tensor.apply(*omega)) + first.cross(a);
                    force.named(&format!("force_{}", body.name));
                    moment.named(&format!("moment_{}", body.name));
                }
            }
            (Factor::Turn(turn), _) => (force, moment) = (turn.outward(force), turn.outward(moment)),
            (Factor::Revolute { j, turn }, _) => {
                bias[*j] = -moment[turn.axis.index()];
                (force, moment) = (turn.outward(force), turn.outward(moment));
            }
            (Factor::Ball { j, turns }, _) => {
                for (k, turn) in turns.iter().enumerate().rev() {
                    bias[j + k] = -moment[turn.axis.index()];
                    (force, moment) = (turn.outward(force), turn.outward(moment));
                }
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
