//! `(A + D̂) x = r` in O(n), D̂ diagonal except for the block of the base.
//!
//! The springs and dampers of elements and drives act on single coordinates, those of the supports on the base: the terms
//! that an implicit step adds to A have this structure, and cost nothing beyond the solution with A.

use super::articulated::{Articulated, Effort};
use super::axis_rotation::AxisRotation;
use super::drives;
use super::factors::Factor;
use super::forward::{inward, outward};
use super::kinematics::Kinematics;
use super::model::Model;
use super::outward::velocities;
use super::rotors;
use super::vector::{SymmetricMatrix, Vec3};
use crate::chain::CoordinateId;
use crate::symbolic::Expr;

/// x of `(A + D̂) x = r`, without the rows and columns of prescribed coordinates: their x is 0.
///
/// Everything beyond the base is released joint by joint; a system of the base's coordinates remains, with the columns
/// `(ω_j, υ_j)` of the motions of the first body's origin.
pub fn solution<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, factors: &[Factor<'g>]) -> Vec<Expr<'g>> {
    let base: Vec<usize> = model.chain.base.iter().flatten().map(|CoordinateId(j)| *j).collect();
    let zero = Vec3::zero(model.graph);
    let mut efforts: Vec<Effort<'g>> = (model.right_hand_side.iter().zip(&model.added_inertia))
        .map(|(&applied, &added_inertia)| Effort { applied, added_inertia })
        .collect();
    for (j, armature) in rotors::by_coordinate(model) {
        efforts[j].added_inertia = efforts[j].added_inertia + armature;
    }
    let velocities = velocities(model, factors, &model.zeros());
    let split = if base.is_empty() { 0 } else { first_body(factors) };

    let prescribed = drives::at_rest(model);
    let (joints, mut articulated) = inward(model, &factors[split..], &velocities[split..], &efforts, &prescribed);
    let path = &factors[..split];
    let rotations: Vec<AxisRotation<'g>> =
        path.iter().flat_map(Factor::rotations).map(|(_, rotation)| rotation).collect();
    rotations.iter().rev().for_each(|rotation| articulated.rotate_about_axis(rotation));
    let columns: Vec<(Vec3<'g>, Vec3<'g>)> = base
        .iter()
        .map(|&j| {
            let generator = &kinematics.generators[j];
            (generator.omega, generator.velocity(kinematics.poses[0].origin))
        })
        .collect();
    let mut own = base_system(model, &articulated, &columns);
    let right: Vec<Expr<'g>> = (columns.iter().zip(&base))
        .map(|((omega, upsilon), &j)| {
            model.right_hand_side[j] - (omega.dot(articulated.moment) + upsilon.dot(articulated.force))
        })
        .collect();
    for (i, j) in (0..base.len()).flat_map(|i| (i..base.len()).map(move |j| (i, j))) {
        own.add(i, j, model.base_added_inertia[6 * i - i * i.saturating_sub(1) / 2 + j - i]);
    }
    let motion = own.solve(&right);

    let sum = |pick: fn(&(Vec3<'g>, Vec3<'g>)) -> Vec3<'g>| {
        columns.iter().zip(&motion).fold(zero, |sum, (column, &x)| sum + x * pick(column))
    };
    let start = rotations.iter().fold((sum(|column| column.0), sum(|column| column.1)), |(alpha, a), rotation| {
        (rotation.to_inner(alpha), rotation.to_inner(a))
    });
    let mut x = outward(model, &factors[split..], &velocities[split..], &joints, start).accelerations;
    for (&j, value) in base.iter().zip(motion) {
        x[j] = value;
    }
    x
}

/// The index of the factor at which the frame of the first body is reached.
fn first_body(factors: &[Factor]) -> usize {
    factors.iter().position(|factor| matches!(factor, Factor::Body(_))).unwrap_or(0)
}

/// `ω_i · (J ω_j + H υ_j) + υ_i · (Hᵀ ω_j + M υ_j)`
fn base_system<'g>(
    model: &Model<'g>,
    articulated: &Articulated<'g>,
    columns: &[(Vec3<'g>, Vec3<'g>)],
) -> SymmetricMatrix<'g> {
    let mut matrix = SymmetricMatrix::zero(model.graph, columns.len());
    for (j, (omega, upsilon)) in columns.iter().enumerate() {
        let moment = articulated.rotational.apply(*omega) + articulated.coupling.apply(*upsilon);
        let force = articulated.coupling.apply_transposed(*omega) + articulated.translational.apply(*upsilon);
        for (i, (omega, upsilon)) in columns[..=j].iter().enumerate() {
            matrix.add(i, j, omega.dot(moment) + upsilon.dot(force));
        }
    }
    matrix
}
