//! Pins that turn.
//!
//! Notation
//! : u and w fixed to the first body, `u × w` along the pin; c fixed to the second, normal to the pin, and along u at the guess;
//!   `x = u · c`, `y = w · c`. With ω_j of coordinate j and `σ_j` 1 if it moves only the second body, −1 if it moves only the first:
//!
//! ```text
//! θ = atan2(y, x)        n = c × (x w − y u)/(x² + y²)        ∂θ/∂q_j = σ_j ω_j · n
//! ```
//!
//! While the pin holds, n is its axis. A torque of 1 N m that resists turning acts on the first body with n, and on the second with −n.

use super::kinematics::Kinematics;
use super::model::Model;
use super::place::{Along, Place, Pull};
use super::vector::{Rotation, Vec3};
use crate::chain::{Attachment, BodyId, CoordinateId, Turning, Vector};
use crate::symbolic::Expr;

/// A pin at the present pose.
pub struct Turned<'g> {
    /// θ, rad.
    pub angle: Expr<'g>,
    /// Indices and values of the entries of ∂θ/∂q.
    pub jacobian: Vec<(usize, Expr<'g>)>,
    /// What a torque of 1 N m exerts on bodies.
    pub pulls: Vec<(Place<'g>, Pull<'g>)>,
}

impl<'g> Turned<'g> {
    pub fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, turning: &Turning) -> Self {
        let [first, second] = turning.ends.each_ref();
        let [u, w] = turning.across.map(|across| direction(model, kinematics, first, across));
        let c = direction(model, kinematics, second, turning.reference);
        let (x, y) = (u.dot(c), w.dot(c));
        let normal = (1.0 / (x.squared() + y.squared())) * c.cross(x * w - y * u);
        let of_second = model.chain.reach(second);
        let slope = |id: CoordinateId| {
            let slope = kinematics.generators[id.0].omega.dot(normal);
            (id.0, if of_second.contains(&id) { slope } else { -slope })
        };
        let zero = Vec3::zero(model.graph);
        let pull = |(end, moment): (&Attachment, Vec3<'g>)| {
            let place = Place { body: end.body?, along: Along::Fixed(end.position[0].clone()) };
            Some((place, Pull { point: zero, force: zero, moment: Some(moment) }))
        };
        Turned {
            angle: y.atan2(x),
            jacobian: model.chain.turned_by(turning).into_iter().map(slope).collect(),
            pulls: [(first, normal), (second, -normal)].into_iter().filter_map(pull).collect(),
        }
    }
}

/// A direction of the body at an end, in the world.
fn direction<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, end: &Attachment, along: Vector) -> Vec3<'g> {
    let rotation = end.body.map_or(Rotation::identity(model.graph), |BodyId(body)| kinematics.poses[body].rotation);
    rotation.apply(Vec3(along.map(|x| model.graph.constant(x))))
}
