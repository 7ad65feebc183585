//! Springs and dampers on single coordinates: rigid elements and passive joints.

use super::model::Model;
use super::vector::SymmetricMatrix;
use crate::chain::Drive;
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

/// Drives whose efforts have no limit.
fn linear_drives<'a>(model: &'a Model<'_>) -> impl Iterator<Item = &'a Drive> {
    model.chain.drives.iter().filter(|drive| drive.max_effort().is_none())
}

/// Stiffness of elements and drives without a limit, on the diagonal.
pub fn stiffness<'g>(model: &Model<'g>, matrix: &mut SymmetricMatrix<'g>) {
    let elements = model.chain.beam_springs.iter().map(|s| (s.coordinate.0, &s.stiffness));
    let drives = linear_drives(model).filter_map(|d| Some((d.coordinate.0, d.spring()?.0)));
    for (j, stiffness) in elements.chain(drives) {
        matrix.add(j, j, model.number(stiffness));
    }
}

/// Damping of elements, drives without a limit and joints, on the diagonal.
pub fn damping<'g>(model: &Model<'g>, matrix: &mut SymmetricMatrix<'g>) {
    let elements = model.chain.beam_springs.iter().map(|s| (s.coordinate.0, &s.damping));
    let drives = linear_drives(model).filter_map(|d| Some((d.coordinate.0, d.spring()?.1)));
    let joint_dampers = model.chain.joint_dampers.iter().map(|h| (h.coordinate.0, &h.damping));
    for (j, damping) in elements.chain(drives).chain(joint_dampers) {
        matrix.add(j, j, model.number(damping));
    }
}

/// Power that elements' and joints' dampers dissipate, `Σ d q̇²` (2R of [Urbaś 2016, Eq. (14)]).
pub fn dissipation<'g>(model: &Model<'g>) -> Expr<'g> {
    let elements = model.chain.beam_springs.iter().map(|s| (s.coordinate.0, &s.damping));
    let joint_dampers = model.chain.joint_dampers.iter().map(|h| (h.coordinate.0, &h.damping));
    elements
        .chain(joint_dampers)
        .fold(model.zero(), |sum, (j, damping)| sum + model.number(damping) * model.v[j].squared())
}
