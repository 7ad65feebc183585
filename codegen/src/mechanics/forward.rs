//! Accelerations from efforts in O(n), by articulated bodies.
//!
//! Three sweeps: outward for velocities ([`super::outward`]), inward for articulated inertias, outward for accelerations.
//! The mass matrix is never formed, and no digits are lost to its condition number.
//!
//! With velocities and gravity: `q̈` of `A q̈ = e + f` [Urbaś 2016, Eq. (23)]. At rest without gravity: `A x = r`, and with
//! added inertias D̂, block-diagonal, `(A + D̂) x = r`. If a coordinate's acceleration is prescribed, its joint is not released, and
//! the outward sweep computes its effort (hybrid dynamics).

use super::articulated::{Articulated, BallResponse, Effort, Reaction, Response};
use super::axis_rotation::AxisRotation;
use super::factors::{Branches, Factor, Reached};
use super::model::Model;
use super::outward::{Velocities, velocities};
use super::rotation_vector::RotationVector;
use super::vector::{Rotation, Symmetric3, Vec3, plane};
use crate::chain::Axis;
use crate::symbolic::Expr;

/// What the forward dynamics of a chain needs besides its pose.
pub struct ForwardInputs<'a, 'g> {
    /// Velocities of the coordinates.
    pub v: &'a [Expr<'g>],
    /// Efforts on the coordinates.
    pub efforts: &'a [Effort<'g>],
    /// Accelerations of the prescribed coordinates, whose efforts are the unknowns.
    pub prescribed: &'a [Option<Expr<'g>>],
    /// Acceleration of gravity in the world frame.
    pub gravity: Vec3<'g>,
}

/// The motion of a chain with these inputs.
pub struct ForwardMotion<'g> {
    /// q̈ of all coordinates.
    pub accelerations: Vec<Expr<'g>>,
    /// Efforts that the prescribed accelerations require; zero elsewhere.
    pub efforts: Vec<Expr<'g>>,
}

/// The response of a joint, computed in the inward sweep and used in the outward sweep.
pub(super) enum Joint<'g> {
    None,
    Single(Response<'g>),
    /// Its acceleration is prescribed.
    Prescribed(Expr<'g>, Reaction<'g>),
    Ball(Ball<'g>, Box<BallResponse<'g>>),
    RotationVector(Box<BallResponse<'g>>),
}

/// q̈ of all coordinates, and the efforts of the prescribed ones (hybrid dynamics).
pub fn hybrid_dynamics<'g>(
    model: &Model<'g>,
    factors: &[Factor<'g>],
    inputs: &ForwardInputs<'_, 'g>,
) -> ForwardMotion<'g> {
    let velocities = velocities(model, factors, inputs.v);
    let (joints, _) = inward(model, factors, &velocities, inputs.efforts, inputs.prescribed);
    outward(model, factors, &velocities, &joints, (Vec3::zero(model.graph), -inputs.gravity))
}

/// Articulated inertias from the tips to the base, and the remaining inertia at the base.
pub(super) fn inward<'g>(
    model: &Model<'g>,
    factors: &[Factor<'g>],
    velocities: &[Velocities<'g>],
    efforts: &[Effort<'g>],
    prescribed: &[Option<Expr<'g>>],
) -> (Vec<Joint<'g>>, Articulated<'g>) {
    let mut articulated = Articulated::zero(model.graph);
    let mut branches = Branches::new(model);
    let sweep = model.graph.sweep();
    let mut joints: Vec<Joint<'g>> = factors
        .iter()
        .zip(velocities)
        .rev()
        .map(|(factor, velocity)| match (factor, velocity) {
            (Factor::Body(index), Velocities::Body { omega }) => {
                let body = &model.chain.bodies[*index];
                sweep.visit(&body.name);
                for branch in branches.take(*index) {
                    articulated = articulated + branch;
                }
                if let Some(inertia) = &body.inertia {
                    let second = model.second_moments(inertia);
                    let (mass, first) = (model.number(&inertia.mass), model.vector(&inertia.first));
                    articulated.add_body(mass, first, second.tensor(), *omega);
                    articulated.named(&body.name);
                }
                Joint::None
            }
            (Factor::Branch(from), _) => {
                branches.bring(*from, std::mem::replace(&mut articulated, Articulated::zero(model.graph)));
                Joint::None
            }
            (Factor::Rotation(rotation), _) => {
                articulated.rotate_about_axis(rotation);
                Joint::None
            }
            (Factor::Translate(_), Velocities::Translation { by, acceleration }) => {
                articulated.shift(*by, *acceleration);
                Joint::None
            }
            (Factor::Prismatic { j, axis }, Velocities::Translation { by, acceleration }) => {
                let joint = match prescribed[*j] {
                    Some(q) => {
                        Joint::Prescribed(q, articulated.prescribe_translation(*axis, q, efforts[*j].added_inertia))
                    }
                    None => Joint::Single(articulated.free_translation(*axis, efforts[*j])),
                };
                articulated.shift(*by, *acceleration);
                joint
            }
            (Factor::Revolute { j, rotation }, Velocities::Revolute { gyration }) => {
                let axis = rotation.axis;
                let joint = match prescribed[*j] {
                    Some(q) => {
                        let added_inertia = efforts[*j].added_inertia;
                        Joint::Prescribed(q, articulated.prescribe_rotation(axis, q, added_inertia, *gyration))
                    }
                    None => Joint::Single(articulated.free_rotation(axis, efforts[*j], *gyration)),
                };
                articulated.rotate_about_axis(rotation);
                joint
            }
            (Factor::Ball { j, rotations }, Velocities::Ball { .. }) => {
                let ball = Ball {
                    rotations: *rotations,
                    has_added_inertia: efforts[*j..j + 3].iter().any(|e| !e.added_inertia.is_zero()),
                };
                let response = ball.free(&mut articulated, [efforts[*j], efforts[j + 1], efforts[j + 2]]);
                Joint::Ball(ball, Box::new(response))
            }
            (Factor::RotationVector { j, vector }, Velocities::RotationVector { .. }) => {
                let efforts = [efforts[*j], efforts[j + 1], efforts[j + 2]];
                Joint::RotationVector(Box::new(free_rotation_vector(vector, &mut articulated, efforts)))
            }
            _ => unreachable!("velocities were made from the same factors"),
        })
        .collect();
    joints.reverse();
    (joints, articulated)
}

/// Accelerations from the base to the tips; `start` contains the angular and linear accelerations before the first factor.
pub(super) fn outward<'g>(
    model: &Model<'g>,
    factors: &[Factor<'g>],
    velocities: &[Velocities<'g>],
    joints: &[Joint<'g>],
    start: (Vec3<'g>, Vec3<'g>),
) -> ForwardMotion<'g> {
    let (mut angular, mut linear) = start;
    let (mut accelerations, mut efforts) = (model.zeros(), model.zeros());
    let mut reached = Reached::new();
    let sweep = model.graph.sweep();
    for ((factor, velocity), joint) in factors.iter().zip(velocities).zip(joints) {
        if let Velocities::Translation { by, acceleration } = velocity {
            linear = linear + angular.cross(*by) + *acceleration;
        }
        match (factor, velocity, joint) {
            (Factor::Rotation(rotation), ..) => {
                (angular, linear) = (rotation.to_inner(angular), rotation.to_inner(linear));
            }
            (Factor::Revolute { j, rotation }, Velocities::Revolute { gyration }, joint) => {
                (angular, linear) = (rotation.to_inner(angular), rotation.to_inner(linear));
                joint.move_on(&mut accelerations[*j], &mut efforts[*j], angular, linear);
                angular = angular + Vec3::along(rotation.axis, accelerations[*j]) + *gyration;
            }
            (Factor::Prismatic { j, axis }, _, joint) => {
                joint.move_on(&mut accelerations[*j], &mut efforts[*j], angular, linear);
                linear = linear + Vec3::along(*axis, accelerations[*j]);
            }
            (Factor::Ball { j, .. }, Velocities::Ball { gyrations }, Joint::Ball(ball, response)) => {
                let own;
                (own, angular, linear) = ball.move_on(response, gyrations, angular, linear);
                accelerations[*j..j + 3].copy_from_slice(&own);
            }
            (
                Factor::RotationVector { j, vector },
                Velocities::RotationVector { rates, gyration },
                Joint::RotationVector(response),
            ) => {
                let own;
                [own, angular, linear] = move_by_vector(vector, response, (*rates, *gyration), (angular, linear));
                accelerations[*j..j + 3].copy_from_slice(&vector.by_coordinates(own.0));
            }
            (Factor::Body(index), ..) => {
                let name = &model.chain.bodies[*index].name;
                angular.named(&format!("alpha_{name}"));
                linear.named(&format!("acceleration_{name}"));
                sweep.leave(name);
            }
            _ => {}
        }
        let mut state = (angular, linear);
        reached.follow(factor, &mut state);
        (angular, linear) = state;
    }
    for (acceleration, coordinate) in accelerations.iter().zip(&model.chain.coordinates) {
        model.graph.name(*acceleration, format!("{}_ddot", coordinate.name));
    }
    for (effort, coordinate) in efforts.iter().zip(&model.chain.coordinates) {
        model.graph.name(*effort, format!("effort_{}", coordinate.name));
    }
    ForwardMotion { accelerations, efforts }
}

impl<'g> Joint<'g> {
    /// The acceleration of a joint with one coordinate and, if it is prescribed, the effort that it requires, from the
    /// accelerations before it.
    fn move_on(&self, own: &mut Expr<'g>, effort: &mut Expr<'g>, angular: Vec3<'g>, linear: Vec3<'g>) {
        match self {
            Joint::Single(response) => *own = response.acceleration(angular, linear),
            Joint::Prescribed(acceleration, reaction) => {
                *own = *acceleration;
                *effort = reaction.effort(angular, linear);
            }
            Joint::None | Joint::Ball(..) | Joint::RotationVector(_) => {
                unreachable!("joints were made from the same factors")
            }
        }
    }
}

/// Releases a rotation vector and transforms the articulated inertia to the frame before it.
fn free_rotation_vector<'g>(
    vector: &RotationVector<'g>,
    articulated: &mut Articulated<'g>,
    efforts: [Effort<'g>; 3],
) -> BallResponse<'g> {
    let along_axes = |of: fn(Effort<'g>) -> Expr<'g>| Vec3(vector.along_axes(efforts.map(of)));
    let [before, after] = vector.moments(along_axes(|effort| effort.applied));
    if efforts.iter().all(|effort| effort.added_inertia.is_zero()) {
        let response = articulated.free_ball(after, None);
        articulated.rotate_force(vector.rotation(), before);
        return response;
    }
    let added_inertia = vector.added_inertia(along_axes(|effort| effort.added_inertia));
    let response = articulated.free_ball(after, Some(added_inertia));
    articulated.rotate(vector.rotation());
    response
}

/// The accelerations of a rotation vector, and α and a after it.
fn move_by_vector<'g>(
    vector: &RotationVector<'g>,
    response: &BallResponse<'g>,
    (rates, gyration): (Vec3<'g>, Vec3<'g>),
    (angular, linear): (Vec3<'g>, Vec3<'g>),
) -> [Vec3<'g>; 3] {
    let rotation = vector.rotation();
    let linear = rotation.apply_transposed(linear);
    let Some(own) = &response.angular else {
        let after = response.rest - response.linear.apply(linear);
        return [vector.accelerations(angular, after, gyration, rates), after, linear];
    };
    let before = rotation.apply_transposed(angular) + gyration + vector.spin_rate(rates);
    let relative = response.rest - response.linear.apply(linear) - own.apply(before);
    [vector.accelerations_at_rest(relative), before + relative, linear]
}

/// Three rotations through one point, `R_a(ψ) R_b(θ) R_c(φ)`.
///
/// In the frame after the second, with `σ = ±1` so that `e_b × e_a = σ e_c`, the relative angular acceleration is
/// `w = (cos θ ψ̈) e_a + θ̈ e_b + (φ̈ − σ sin θ ψ̈) e_c`: unless θ is ±90°, every w corresponds to a q̈, and the three
/// behave as a ball joint.
pub(super) struct Ball<'g> {
    rotations: [AxisRotation<'g>; 3],
    has_added_inertia: bool,
}

impl<'g> Ball<'g> {
    /// Indices of the axes a, b, c, and `σ tan θ`, `1 / cos θ`.
    fn geometry(&self) -> ([usize; 3], Expr<'g>, Expr<'g>) {
        let [a, b, c] = self.rotations.map(|rotation| rotation.axis.index());
        let AxisRotation { sin, cos, .. } = self.rotations[1];
        let secant = 1.0 / cos;
        let tangent = sin * secant;
        let cyclic = plane([Axis::X, Axis::Y, Axis::Z][c]) == (b, a);
        ([a, b, c], if cyclic { tangent } else { -tangent }, secant)
    }

    /// Releases the joint and transforms the articulated inertia to the frame before it.
    ///
    /// Without added inertia it is released in the body's own frame, where its inertia has the most zeros; with added inertia in
    /// the frame after the second rotation, where D' has the most zeros.
    fn free(&self, articulated: &mut Articulated<'g>, efforts: [Effort<'g>; 3]) -> BallResponse<'g> {
        let ([a, b, c], tangent, secant) = self.geometry();
        let [first, second, third] = &self.rotations;
        // n · (∂w/∂ψ̇, ∂w/∂θ̇, ∂w/∂φ̇) = τ
        let mut moment = Vec3::zero(secant.graph());
        moment.0[a] = secant * efforts[0].applied + tangent * efforts[2].applied;
        moment.0[b] = efforts[1].applied;
        moment.0[c] = efforts[2].applied;
        if self.has_added_inertia {
            articulated.rotate_about_axis(third);
            let [psi, theta, phi] = efforts.map(|effort| effort.added_inertia);
            let mut added_inertia = Symmetric3::zero(secant.graph());
            *added_inertia.at_mut(a, a) = psi * secant.squared() + phi * tangent.squared();
            *added_inertia.at_mut(b, b) = theta;
            *added_inertia.at_mut(c, c) = phi;
            *added_inertia.at_mut(a, c) = phi * tangent;
            let response = articulated.free_ball(moment, Some(added_inertia));
            articulated.rotate_about_axis(second);
            articulated.rotate_about_axis(first);
            response
        } else {
            let response = articulated.free_ball(third.to_inner(moment), None);
            articulated.rotate_force(self.rotation(), first.to_outer(second.to_outer(moment)));
            response
        }
    }

    /// `R_a(ψ) R_b(θ) R_c(φ)` as a matrix, which is known long before the inertias: the chain of dependent operations is shorter
    /// than with plane rotations.
    fn rotation(&self) -> Rotation<'g> {
        let graph = self.rotations[0].sin.graph();
        let rotate = |frame: Rotation<'g>, by: &AxisRotation<'g>| frame.rotated(by.axis, by.sin, by.cos);
        self.rotations.iter().fold(Rotation::identity(graph), rotate)
    }

    /// The accelerations of the joint, and α and a after it.
    fn move_on(
        &self,
        response: &BallResponse<'g>,
        gyrations: &[Vec3<'g>; 3],
        mut angular: Vec3<'g>,
        mut linear: Vec3<'g>,
    ) -> ([Expr<'g>; 3], Vec3<'g>, Vec3<'g>) {
        let [first, second, third] = &self.rotations;
        let before = second.to_inner(first.to_inner(angular) + gyrations[0]) + gyrations[1];
        let relative;
        if let Some(own) = &response.angular {
            linear = second.to_inner(first.to_inner(linear));
            relative = response.rest - response.linear.apply(linear) - own.apply(before);
            (angular, linear) = (third.to_inner(before + relative), third.to_inner(linear));
        } else {
            linear = self.rotation().apply_transposed(linear);
            angular = response.rest - response.linear.apply(linear);
            relative = third.to_outer(angular - gyrations[2]) - before;
        }
        let ([a, b, c], tangent, secant) = self.geometry();
        ([secant * relative[a], relative[b], relative[c] + tangent * relative[a]], angular, linear)
    }
}
