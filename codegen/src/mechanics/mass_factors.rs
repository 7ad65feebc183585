//! Factors of the inverse mass matrix in O(n), by articulated bodies.
//!
//! Notation
//! : for coordinate j its axis `n_j`; in the world's axes, about the joint's point, the accelerations `α` and `a` before the joint's own motion,
//!   and the moment and force that everything beyond requires. `D_j` is the articulated inertia along the axis, and
//!   `κ_j`, `λ_j` are its moments and forces for a unit rate of `q̇_j`, divided by `D_j`.
//!
//! Output
//! : n, λ, κ, the offset to the point of j from that of the coordinate before it, or from the world's origin, and 1/D, with which `A⁻¹ = Lᵀ D⁻¹ L`. Inward from the tips,
//!   with wrench (m, f) of everything beyond, `g_j = r_j − n_j · m` (of a translation `n_j · f`), then `m ← m + κ_j g_j`, `f ← f + λ_j g_j`: this is
//!   `g = L r`. Outward, `x_j = g_j/D_j − κ_j · α − λ_j · a`, then `α ← α + n_j x_j` (of a translation a): `x = Lᵀ D⁻¹ g`.
//!
//! R. Featherstone, *Rigid Body Dynamics Algorithms*, Springer 2008, chapter 7; as a factorisation of A⁻¹: G. Rodriguez, K. Kreutz-Delgado, IEEE
//! Transactions on Robotics and Automation 8 (1992).

use super::articulated::{Articulated, Effort, Response};
use super::columns::{Columns, frames};
use super::factors::{Branches, Factor};
use super::model::Model;
use super::rotors;
use super::vector::{Matrix3, Symmetric3, Vec3};
use crate::symbolic::Expr;

/// The factors, row by row: x, y and z of n, λ, κ and the offsets of all coordinates, and 1/D. κ, λ and 1/D of a prescribed coordinate are zero: it
/// does not accelerate.
pub fn mass_factors<'g>(
    model: &Model<'g>,
    factors: &[Factor<'g>],
    columns: &Columns<'g>,
    is_prescribed: &[bool],
) -> Vec<Expr<'g>> {
    let (zero, nothing) = (Vec3::zero(model.graph), model.zero());
    let armatures = rotors::armatures(model);
    let mut found =
        Responses { linear: vec![zero; model.size()], angular: vec![zero; model.size()], reciprocals: model.zeros() };
    let mut frames = frames(model, factors);
    let mut frame_before = || frames.pop().expect("as many as outward");
    let mut articulated = Articulated::zero(model.graph);
    let mut branches = Branches::new(model);
    let effort = |j: usize| Effort { applied: nothing, added_inertia: armatures[j] };
    let sweep = model.graph.sweep();
    for factor in factors.iter().rev() {
        match factor {
            Factor::Body(index) => {
                let body = &model.chain.bodies[*index];
                sweep.visit(&body.name);
                for branch in branches.take(*index) {
                    articulated = articulated + branch;
                }
                if let Some(inertia) = &body.inertia {
                    let (mass, first) = (model.number(&inertia.mass), model.vector(&inertia.first));
                    articulated.add_body(mass, first, model.second_moments(inertia).tensor(), zero);
                    articulated.named(&body.name);
                }
            }
            Factor::Branch(from) => {
                branches.bring(*from, std::mem::replace(&mut articulated, Articulated::zero(model.graph)));
            }
            Factor::Translate(by) => {
                frame_before();
                articulated.shift(*by, zero);
            }
            Factor::Prismatic { j, axis } => {
                let frame = frame_before();
                if !is_prescribed[*j] {
                    let response = articulated.free_translation(*axis, effort(*j));
                    found.set(*j, &response, |x| frame.apply(x));
                }
                articulated.shift(Vec3::along(*axis, model.q[*j]), zero);
            }
            Factor::RotationVector { j, vector } => {
                let frame = frame_before();
                articulated.rotate(vector.rotation());
                let jacobian = vector.jacobian();
                let axes = vector.by_coordinates([0, 1, 2].map(|k| jacobian.column(k)));
                for (k, axis) in axes.into_iter().enumerate().rev() {
                    let response = articulated.free_rotation_about(axis, effort(j + k));
                    found.set(j + k, &response, |x| frame.apply(x));
                }
                articulated.transmit_no_moment(&armatures[*j..j + 3]);
            }
            Factor::Rotation(_) | Factor::Revolute { .. } | Factor::Ball { .. } => {
                for (j, rotation) in factor.rotations().into_iter().rev() {
                    let after = frame_before().rotated(rotation.axis, rotation.sin, rotation.cos);
                    if let Some(j) = j.filter(|j| !is_prescribed[*j]) {
                        let response = articulated.free_rotation(rotation.axis, effort(j), zero);
                        found.set(j, &response, |x| after.apply(x));
                    }
                    articulated.rotate_about_axis(&rotation);
                }
                if let Factor::Ball { j, .. } = factor {
                    articulated.transmit_no_moment(&armatures[*j..j + 3]);
                }
            }
        }
    }
    let Responses { linear, angular, reciprocals } = found;
    let vectors = [&columns.axes, &linear, &angular, &columns.offsets];
    let rows = vectors.into_iter().flat_map(|of| (0..3).flat_map(move |k| of.iter().map(move |vector| vector[k])));
    rows.chain(reciprocals).collect()
}

/// The responses of all coordinates, in the world's axes.
struct Responses<'g> {
    linear: Vec<Vec3<'g>>,
    angular: Vec<Vec3<'g>>,
    reciprocals: Vec<Expr<'g>>,
}

impl<'g> Responses<'g> {
    fn set(&mut self, j: usize, response: &Response<'g>, to_world: impl Fn(Vec3<'g>) -> Vec3<'g>) {
        self.linear[j] = to_world(response.linear);
        self.angular[j] = to_world(response.angular);
        self.reciprocals[j] = response.reciprocal;
    }
}

impl<'g> Articulated<'g> {
    /// Releases the rotation about any axis n through the origin. `D = n · J n + d̂`, `q̈ = (τ − n · n₀ − (J n) · α − (Hᵀ n) · a) / D`.
    fn free_rotation_about(&mut self, axis: Vec3<'g>, effort: Effort<'g>) -> Response<'g> {
        let (angular, linear) = (self.rotational.apply(axis), self.coupling.apply_transposed(axis));
        let reciprocal = 1.0 / (axis.dot(angular) + effort.added_inertia);
        let (scaled_angular, scaled_linear) = (reciprocal * angular, reciprocal * linear);
        let own = self.rotational;
        self.rotational = Symmetric3::from_entries(|i, j| own.at(i, j) - scaled_angular[i] * angular[j]);
        let own = self.coupling.0;
        self.coupling = Matrix3([0, 1, 2].map(|i| [0, 1, 2].map(|j| own[i][j] - scaled_angular[i] * linear[j])));
        let own = self.translational;
        self.translational = Symmetric3::from_entries(|i, j| own.at(i, j) - scaled_linear[i] * linear[j]);
        Response { rest: effort.applied, reciprocal, angular: scaled_angular, linear: scaled_linear }
    }

    /// Three rotations through the origin are free: without rotors, nothing but a force is left to transmit, and what is left of J and H is
    /// rounding.
    fn transmit_no_moment(&mut self, armatures: &[Expr<'g>]) {
        if armatures.iter().all(|armature| armature.is_zero()) {
            let graph = armatures[0].graph();
            (self.rotational, self.coupling) = (Symmetric3::zero(graph), Matrix3::zero(graph));
        }
    }
}
