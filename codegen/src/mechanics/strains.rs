//! Strains at the present pose: coordinates, distances of points, couplings of coordinates.
//!
//! Notation
//! : points p₁, p₂ in the world, `ℓ = |p₂ − p₁|`, `e = (p₂ − p₁)/ℓ`. `J_j = ∂ℓ/∂q_j = e · (∂p₂/∂q_j − ∂p₁/∂q_j)` for the coordinates
//!   that move only one of the points: those that move both do not change ℓ. `ℓ̇ = J q̇`. For a coupling `ℓ = q_j − r q_i`,
//!   `J_j = 1`, `J_i = −r`.

use super::kinematics::{Kinematics, Pose};
use super::model::Model;
use super::place::Place;
use super::vector::Vec3;
use crate::chain::{Attachment, BodyId, CoordinateId, Strain};
use crate::symbolic::Expr;

/// A strain at the present pose.
pub struct Strained<'g> {
    /// ℓ, m or rad.
    pub length: Expr<'g>,
    /// Indices and values of the entries of J.
    pub jacobian: Vec<(usize, Expr<'g>)>,
    /// p₁, p₂ and e between points.
    line: Option<([Vec3<'g>; 2], Vec3<'g>)>,
}

/// The position of an end in the world.
fn point<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, end: &Attachment) -> Vec3<'g> {
    let at = model.vector(&end.position);
    match end.body {
        Some(BodyId(body)) => {
            let Pose { rotation, origin } = kinematics.poses[body];
            origin + rotation.apply(at)
        }
        None => at,
    }
}

impl<'g> Strained<'g> {
    pub fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, strain: &Strain) -> Self {
        match strain {
            Strain::Coordinate(CoordinateId(j)) => {
                Strained { length: model.q[*j], jacobian: vec![(*j, model.graph.constant(1.0))], line: None }
            }
            Strain::Distance(ends) => {
                let points = ends.each_ref().map(|end| point(model, kinematics, end));
                let way = points[1] - points[0];
                let length = way.dot(way).sqrt();
                let direction = (1.0 / length) * way;
                let of_second = model.chain.reach(&ends[1]);
                let column = |id: CoordinateId| {
                    let (moved, sign) = if of_second.contains(&id) { (points[1], 1.0) } else { (points[0], -1.0) };
                    (id.0, sign * direction.dot(kinematics.generators[id.0].velocity(moved)))
                };
                let jacobian = model.chain.spanned(strain).into_iter().map(column).collect();
                Strained { length, jacobian, line: Some((points, direction)) }
            }
            Strain::Coupling { coordinate: CoordinateId(j), leader: CoordinateId(i), ratio } => {
                let ratio = model.number(ratio);
                let mut jacobian = vec![(*j, model.graph.constant(1.0)), (*i, -ratio)];
                jacobian.sort_by_key(|(place, _)| *place);
                Strained { length: model.q[*j] - ratio * model.q[*i], jacobian, line: None }
            }
        }
    }

    /// ℓ̇
    pub fn rate(&self, model: &Model<'g>, v: &[Expr<'g>]) -> Expr<'g> {
        self.jacobian.iter().fold(model.zero(), |sum, &(j, column)| sum + column * v[j])
    }

    /// Adds `c Jᵀ J`.
    pub fn add_square(&self, c: Expr<'g>, matrix: &mut super::vector::SymmetricMatrix<'g>) {
        for (place, &(j, one)) in self.jacobian.iter().enumerate() {
            for &(i, other) in &self.jacobian[..=place] {
                matrix.add(i, j, c * one * other);
            }
        }
    }

    /// The bodies that it pulls with 1 N, in the world: place, point, force. Without points there are none: the force acts on joints, like
    /// that of a drive.
    pub fn pulls(&self, strain: &Strain) -> impl Iterator<Item = (Place, Vec3<'g>, Vec3<'g>)> {
        let place = |end: &Attachment| end.body.map(|body| Place { body, along: end.position[0].clone() });
        let of_line = strain.ends().zip(self.line).map(|(ends, (points, direction))| {
            [(place(&ends[0]), points[0], direction), (place(&ends[1]), points[1], -direction)]
        });
        of_line.into_iter().flatten().filter_map(|(place, point, pull)| Some((place?, point, pull)))
    }
}
