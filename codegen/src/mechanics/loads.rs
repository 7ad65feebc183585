//! External loads: a force and a moment at a point of a body.
//!
//! `f_j = F · Ω_j x + M · ω_j` for the coordinates j that move the body, x the point in the world: the power `F · ẋ + M · ω` at unit
//! rate of j.

use super::acts::{Acts, Rest};
use super::connectors;
use super::elements::Posed;
use super::kinematics::Kinematics;
use super::model::Model;
use super::place::{Along, Place, Pull};
use super::profile;
use super::tangent::Tangent;
use super::twist::Twist;
use super::vector::Vec3;
use crate::chain::{BodyId, CoordinateId, Load, LoadAxes, Profile, Value};
use crate::symbolic::Expr;

/// The loads of a chain.
pub struct Loads<'a, 'g> {
    pub model: &'a Model<'g>,
    pub kinematics: &'a Kinematics<'g>,
}

impl<'g> Acts<'g> for Loads<'_, 'g> {
    fn in_motion(&self) -> Vec<Expr<'g>> {
        forces(self.model, self.kinematics, self.model.t)
    }

    fn at_rest(&self, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        forces(self.model, self.kinematics, rest.t)
    }

    /// The symmetric part of `−∂f/∂q`. With `J_j = Ω_j x` and i ≤ j on the path of the load's body,
    ///
    /// `K_ij = −ω_i · (J_j × F + ½ ω_j × M)`
    ///
    /// and the contribution of curvatures: three multiplications per entry from two vectors per coordinate. For a force along fixed axes `∂f/∂q` is
    /// symmetric; for a moment, and for a force that turns with its link, it is not, and there is no potential. The latter adds
    /// `∂F/∂q_i = ω_i × F`, `½ ω_i · (J_j × F) + ½ ω_j · (J_i × F)`; the moment's, `½ (ω_i × M) · ω_j + ½ (ω_j × M) · ω_i`, is zero.
    fn add_stiffness(&self, rest: &Rest<'g>, tangent: &mut Tangent<'_, 'g>) {
        let (model, generators) = (self.model, &self.kinematics.generators);
        let (half, zero) = (model.graph.constant(0.5), Vec3::zero(model.graph));
        for load in &model.chain.loads {
            let Applied { at, force, moment } = applied(model, self.kinematics, load, rest.t);
            let path = model.chain.coordinates_of(load.body);
            let turning = |j: usize| generators[j].velocity(at).cross(force);
            for (index, CoordinateId(j)) in path.iter().enumerate() {
                let moving = &generators[*j];
                let torque = match load.axes {
                    LoadAxes::World => turning(*j),
                    LoadAxes::Link => half * turning(*j),
                };
                let torque = torque + half * moving.omega.cross(moment);
                tangent.add(*j, [Some(BodyId(moving.body)), None], [zero, -torque]);
                if load.axes == LoadAxes::Link {
                    for CoordinateId(i) in &path[..=index] {
                        tangent.matrix.add(*i, *j, 0.5 * moving.omega.dot(turning(*i)));
                    }
                }
            }
            for curvature in &self.kinematics.curvatures {
                if model.chain.is_beyond(load.body, BodyId(curvature.body)) {
                    let torque = (at - curvature.pose.origin).cross(force) + moment;
                    curvature.add_works(-torque, &mut tangent.matrix);
                }
            }
        }
    }
}

/// A load in the world.
struct Applied<'g> {
    at: Vec3<'g>,
    force: Vec3<'g>,
    moment: Vec3<'g>,
}

/// The factor of a load at time t; `None` if the load is constant.
fn scale<'g>(model: &Model<'g>, load: &Load, t: Expr<'g>) -> Option<Expr<'g>> {
    load.scale.as_ref().map(|scale| profile::position(model, scale, t))
}

fn applied<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, load: &Load, t: Expr<'g>) -> Applied<'g> {
    let pose = &kinematics.poses[load.body.0];
    let scale = scale(model, load, t);
    let in_world = |vector: Vec3<'g>| {
        let vector = match load.axes {
            LoadAxes::World => vector,
            LoadAxes::Link => pose.rotation.apply(vector),
        };
        scale.map_or(vector, |scale| scale * vector)
    };
    Applied {
        at: pose.origin + pose.rotation.apply(model.vector(&load.position)),
        force: in_world(model.vector(&load.force)),
        moment: in_world(model.vector(&load.moment)),
    }
}

/// Generalized forces of the loads at time t.
fn forces<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, t: Expr<'g>) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for load in &model.chain.loads {
        let Applied { at, force, moment } = applied(model, kinematics, load, t);
        for CoordinateId(j) in model.chain.coordinates_of(load.body) {
            let generator = &kinematics.generators[j];
            forces[j] = forces[j] + (force.dot(generator.velocity(at)) + moment.dot(generator.omega));
        }
    }
    forces
}

/// A force on a body and its moment about the body's origin, in the body's axes.
#[derive(Clone, Debug)]
pub struct Action<'g> {
    /// Where it acts along the body.
    pub along: Along<'g>,
    /// Force and moment.
    pub wrench: [Vec3<'g>; 2],
}

impl<'g> Action<'g> {
    /// A multiple.
    pub fn times(&self, factor: Expr<'g>) -> Self {
        Action { along: self.along.clone(), wrench: self.wrench.map(|vector| factor * vector) }
    }
}

/// The sum of actions on a body; `None` if there are none.
pub fn sum<'a, 'g: 'a>(actions: impl Iterator<Item = &'a Action<'g>>) -> Option<[Vec3<'g>; 2]> {
    let wrenches = actions.map(|action| action.wrench);
    wrenches.reduce(|[others, moments], [force, moment]| [others + force, moments + moment])
}

/// What loads and connectors exert on each body.
pub fn on_bodies<'g>(posed: Posed<'_, 'g>) -> Vec<Vec<Action<'g>>> {
    let (model, kinematics, _) = posed;
    let mut actions: Vec<Vec<Action<'g>>> = vec![Vec::new(); model.chain.bodies.len()];
    for load in &model.chain.loads {
        let BodyId(body) = load.body;
        let scale = scale(model, load, model.t);
        let along_own_axes = |vector: &[Value; 3]| {
            let vector = model.vector(vector);
            let rotated = match load.axes {
                LoadAxes::World => kinematics.poses[body].rotation.apply_transposed(vector),
                LoadAxes::Link => vector,
            };
            scale.map_or(rotated, |scale| scale * rotated)
        };
        let force = along_own_axes(&load.force);
        let moment = along_own_axes(&load.moment) + model.vector(&load.position).cross(force);
        actions[body].push(Action { along: Along::Fixed(load.position[0].clone()), wrench: [force, moment] });
    }
    for (Place { body: BodyId(body), along }, Pull { point, force, moment }) in connectors::pulls(posed) {
        let pose = &kinematics.poses[body];
        let [force, lever] = [force, point - pose.origin].map(|vector| pose.rotation.apply_transposed(vector));
        let moment = moment.map(|moment| pose.rotation.apply_transposed(moment));
        actions[body].push(Action { along, wrench: Pull::wrench(lever, force, moment) });
    }
    actions
}

/// Start and end of the smooth intervals of every load's factor.
pub fn pieces<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let pieces = model.chain.loads.iter().filter_map(|load| load.scale.as_ref()).flat_map(Profile::pieces);
    pieces.flatten().map(|time| model.number(&time)).collect()
}

/// Power input of the loads, `Σ F · ẋ + M · ω`.
pub fn power<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, twists: &[Twist<'g>]) -> Expr<'g> {
    model.chain.loads.iter().fold(model.zero(), |sum, load| {
        let Applied { at, force, moment } = applied(model, kinematics, load, model.t);
        let twist = &twists[load.body.0];
        sum + (force.dot(twist.omega.cross(at) + twist.upsilon) + moment.dot(twist.omega))
    })
}
