//! Springs and dampers on single coordinates: rigid elements and passive joints.

use super::model::Model;
use super::vector::SymmetricMatrix;
use crate::chain::Value;
use crate::symbolic::Expr;

/// `f = −S q̃ − D q̃̇` of the elements [Urbaś 2016, Eq. (15); one spring for each of the elements 1 … n].
pub fn element_forces<'g>(model: &Model<'g>, q: &[Expr<'g>], v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for spring in &model.chain.beam_springs {
        let j = spring.coordinate.0;
        let (stiffness, damping) = (model.number(&spring.stiffness), model.number(&spring.damping));
        forces[j] = forces[j] - (stiffness * q[j] + damping * v[j]);
    }
    forces
}

/// `E_l = ½ q̃ᵀ S q̃` [Urbaś 2016, Eq. (14)].
pub fn element_energy<'g>(model: &Model<'g>) -> Expr<'g> {
    let twice = model.chain.beam_springs.iter().fold(model.zero(), |sum, spring| {
        sum + model.number(&spring.stiffness) * model.q[spring.coordinate.0].squared()
    });
    0.5 * twice
}

/// `f = −d q̇` of viscous joints.
pub fn joint_damper_forces<'g>(model: &Model<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for damper in &model.chain.joint_dampers {
        let j = damper.coordinate.0;
        forces[j] = forces[j] - model.number(&damper.damping) * v[j];
    }
    forces
}

/// Dampers between elements, by their coordinates.
fn element_dampers<'a>(model: &'a Model<'_>) -> impl Iterator<Item = (usize, &'a Value)> {
    model.chain.beam_springs.iter().map(|spring| (spring.coordinate.0, &spring.damping))
}

/// Dampers of passive joints, by their coordinates.
fn joint_dampers<'a>(model: &'a Model<'_>) -> impl Iterator<Item = (usize, &'a Value)> {
    model.chain.joint_dampers.iter().map(|damper| (damper.coordinate.0, &damper.damping))
}

/// Stiffness of elements, on the diagonal.
pub fn stiffness<'g>(model: &Model<'g>, matrix: &mut SymmetricMatrix<'g>) {
    let springs = model.chain.beam_springs.iter().map(|spring| (spring.coordinate.0, &spring.stiffness));
    matrix.add_diagonal(springs.map(|(j, stiffness)| (j, model.number(stiffness))));
}

/// Damping of elements, on the diagonal.
pub fn element_damping<'g>(model: &Model<'g>, matrix: &mut SymmetricMatrix<'g>) {
    matrix.add_diagonal(element_dampers(model).map(|(j, damping)| (j, model.number(damping))));
}

/// Damping of passive joints, on the diagonal.
pub fn joint_damping<'g>(model: &Model<'g>, matrix: &mut SymmetricMatrix<'g>) {
    matrix.add_diagonal(joint_dampers(model).map(|(j, damping)| (j, model.number(damping))));
}

/// Power that dampers between elements dissipate, `Σ d q̇²` (2R of [Urbaś 2016, Eq. (14)]).
pub fn element_dissipation<'g>(model: &Model<'g>) -> Expr<'g> {
    dissipation(model, element_dampers(model))
}

/// Power that dampers of passive joints dissipate, `Σ d q̇²`.
pub fn joint_dissipation<'g>(model: &Model<'g>) -> Expr<'g> {
    dissipation(model, joint_dampers(model))
}

fn dissipation<'a, 'g>(model: &Model<'g>, dampers: impl Iterator<Item = (usize, &'a Value)>) -> Expr<'g> {
    dampers.fold(model.zero(), |sum, (j, damping)| sum + model.number(damping) * model.v[j].squared())
}
