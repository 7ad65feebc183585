//! T, ∂T/∂q and ∂²T/∂q∂q of every body, as the upper three rows of each matrix.

use super::kinematics::{Curvature, Generator, Kinematics, Pose};
use super::model::Model;
use super::vector::Vec3;
use crate::chain::{BodyId, CoordinateId, CoordinateKind};
use crate::program::Shape;
use crate::symbolic::Expr;

/// The columns of a 4×4 matrix without its last row, row by row.
fn rows(columns: [Vec3<'_>; 4]) -> impl Iterator<Item = Expr<'_>> {
    (0..3).flat_map(move |row| columns.map(|column| column[row]))
}

/// T(p) [Urbaś 2016, Eq. (3)].
pub fn transforms<'g>(kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    kinematics.poses.iter().flat_map(|pose| rows(columns(pose))).collect()
}

fn columns<'g>(pose: &Pose<'g>) -> [Vec3<'g>; 4] {
    let [x, y, z] = pose.rotation.0;
    [x, y, z, pose.origin]
}

/// `∂T/∂q_j = Ω_j T`.
fn derivative<'g>(kinematics: &Kinematics<'g>, body: usize, j: usize) -> [Vec3<'g>; 4] {
    moved(&kinematics.generators[j], &kinematics.poses[body])
}

/// `Ω T`
fn moved<'g>(generator: &Generator<'g>, pose: &Pose<'g>) -> [Vec3<'g>; 4] {
    let [x, y, z, origin] = columns(pose);
    [generator.rotate(x), generator.rotate(y), generator.rotate(z), generator.velocity(origin)]
}

/// `∂T(p)/∂q_j` for every body and every coordinate that moves it.
pub fn derivatives<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let mut outputs = Vec::new();
    for (body, moving) in moving(model) {
        for j in moving {
            outputs.extend(rows(derivative(kinematics, body, j)));
        }
    }
    outputs
}

/// Number of nonzero pairs (m, n) above which second derivatives are left as factors: written out, 36 operations each take
/// rustc longer than the rest of the crane.
const MOST_PAIRS_WRITTEN_OUT: usize = 500;

/// `∂²T(p)/∂q_m∂q_n = Ω_m Ω_n T(p)`, m ≤ n, for every body and every pair of coordinates that move it; written out for a
/// small crane, as factors for a large one.
pub fn second_derivatives<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> (Shape, Vec<Expr<'g>>) {
    let rotations: Vec<bool> = model.chain.coordinates.iter().map(|c| c.kind == CoordinateKind::Rotation).collect();
    let moving: Vec<Vec<usize>> = moving(model).map(|(_, moving)| moving).collect();
    let nonzero = |moving: &Vec<usize>| {
        let places = moving.iter().enumerate().filter(|(_, m)| rotations[**m]);
        places.map(|(index, _)| moving.len() - index).sum::<usize>()
    };
    let pairs: usize = moving.iter().map(nonzero).sum();
    if pairs <= MOST_PAIRS_WRITTEN_OUT || model.chain.has_branches() {
        let counts = moving.iter().map(|moving| moving.len() * (moving.len() + 1) / 2).collect();
        return (Shape::Transforms { counts, corner: 0 }, written_out(model, kinematics));
    }
    let mut factors: Vec<Expr<'g>> = kinematics.generators.iter().flat_map(|generator| generator.omega.0).collect();
    factors.extend(derivatives(model, kinematics));
    for curvature in &kinematics.curvatures {
        factors.extend(Curvature::PAIRS.into_iter().flat_map(|pair| curvature.shares(pair)));
    }
    let vectors = kinematics.curvatures.iter().map(|curvature| curvature.first).collect();
    let degrees = moving.iter().map(Vec::len).collect();
    (Shape::TransformFactors { degrees, rotations, vectors }, factors)
}

fn written_out<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let mut outputs = Vec::new();
    for (body, moving) in moving(model) {
        let first: Vec<_> = moving.iter().map(|&j| derivative(kinematics, body, j)).collect();
        for (index, &m) in moving.iter().enumerate() {
            for (&n, first) in moving.iter().zip(&first).skip(index) {
                // The columns of Ω_n T are directions, so Ω_m only rotates them.
                let rotated = first.map(|column| kinematics.generators[m].rotate(column));
                let within = |curvature: &&Curvature<'g>| curvature.first <= m && n < curvature.first + 3;
                outputs.extend(rows(match kinematics.curvatures.iter().find(within) {
                    Some(curvature) => {
                        let generator = curvature.generator((m - curvature.first, n - curvature.first));
                        let own = moved(&generator, &kinematics.poses[body]);
                        [0, 1, 2, 3].map(|k| rotated[k] + own[k])
                    }
                    None => rotated,
                }));
            }
        }
    }
    outputs
}

/// Every body with the coordinates that move it.
fn moving<'a>(model: &'a Model<'_>) -> impl Iterator<Item = (usize, Vec<usize>)> + 'a {
    let moving = |body| model.chain.coordinates_of(BodyId(body)).into_iter().map(|CoordinateId(j)| j).collect();
    (0..model.chain.bodies.len()).map(move |body| (body, moving(body)))
}
