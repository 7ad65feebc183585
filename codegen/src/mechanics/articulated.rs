//! Articulated inertia: the inertia of everything beyond a joint, as seen from its base side, with all outer joints free.
//!
//! Notation
//! : at the origin of a frame, in its components, the moment and force that must act on everything beyond:
//!   `n = J α + H a + n₀`, `f = Hᵀ α + M a + f₀`. J and M are symmetric; for one rigid body of mass m and first moments s
//!   `H = [s]×`, `M = m 1`.
//!
//! R. Featherstone, *Rigid Body Dynamics Algorithms*, Springer 2008, chapter 7; here in classical accelerations, with three
//! rotations through a point as one joint, and with added inertias D̂.

use std::ops::Add;

use super::axis_rotation::AxisRotation;
use super::vector::{Matrix3, Rotation, Symmetric3, Vec3};
use crate::chain::Axis;
use crate::symbolic::{Expr, Graph};

/// Articulated inertia and bias wrench at the origin of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Articulated<'g> {
    /// J
    pub rotational: Symmetric3<'g>,
    /// H
    pub coupling: Matrix3<'g>,
    /// M
    pub translational: Symmetric3<'g>,
    /// n₀
    pub moment: Vec3<'g>,
    /// f₀
    pub force: Vec3<'g>,
}

/// Effort τ on a coordinate and its added inertia d̂: `τ − d̂ q̈` acts on the joint.
#[derive(Clone, Copy, Debug)]
pub struct Effort<'g> {
    pub applied: Expr<'g>,
    pub added_inertia: Expr<'g>,
}

/// q̈ of a single joint from the accelerations before it: `q̈ = rest − ⟨angular, α⟩ − ⟨linear, a⟩`.
#[derive(Clone, Copy, Debug)]
pub struct Response<'g> {
    pub rest: Expr<'g>,
    /// 1/D
    pub reciprocal: Expr<'g>,
    pub angular: Vec3<'g>,
    pub linear: Vec3<'g>,
}

/// The effort of a joint whose q̈ is prescribed, from the accelerations before it: `τ = rest + ⟨angular, α⟩ + ⟨linear, a⟩`.
#[derive(Clone, Copy, Debug)]
pub struct Reaction<'g> {
    pub rest: Expr<'g>,
    pub angular: Vec3<'g>,
    pub linear: Vec3<'g>,
}

/// The acceleration of a ball joint from those before it: `α' − α = rest − B α − G a` if there is added inertia, otherwise
/// `α' = rest − G a`.
#[derive(Clone, Copy, Debug)]
pub struct BallResponse<'g> {
    pub rest: Vec3<'g>,
    pub angular: Option<Matrix3<'g>>,
    pub linear: Matrix3<'g>,
}

impl<'g> Articulated<'g> {
    pub fn zero(graph: &'g Graph) -> Self {
        Articulated {
            rotational: Symmetric3::zero(graph),
            coupling: Matrix3::zero(graph),
            translational: Symmetric3::zero(graph),
            moment: Vec3::zero(graph),
            force: Vec3::zero(graph),
        }
    }

    /// Adds a rigid body of mass m, first moments s and inertia I about the origin, turning with ω.
    pub fn add_body(&mut self, mass: Expr<'g>, first: Vec3<'g>, inertia: Symmetric3<'g>, omega: Vec3<'g>) {
        self.rotational = self.rotational + inertia;
        self.coupling = self.coupling + Matrix3::cross(first);
        self.translational = self.translational + Symmetric3::scalar(mass);
        self.moment = self.moment + omega.cross(inertia.apply(omega));
        self.force = self.force + omega.cross(omega.cross(first));
    }

    /// Names the quantities in generated code, at the frame of a body.
    pub fn named(&self, body: &str) {
        self.rotational.named(&format!("rotational_{body}"));
        self.coupling.named(&format!("coupling_{body}"));
        self.translational.named(&format!("translational_{body}"));
        self.moment.named(&format!("moment_{body}"));
        self.force.named(&format!("force_{body}"));
    }

    /// Moves the reference point from d to the frame's own origin, where a is smaller by `α × d` and `acceleration`.
    pub fn shift(&mut self, d: Vec3<'g>, acceleration: Vec3<'g>) {
        self.moment = self.moment + self.coupling.apply(acceleration);
        self.force = self.force + self.translational.apply(acceleration);
        self.moment = self.moment + d.cross(self.force);
        // H ← H + [d]× M, J ← J + [d]× Hᵀ (new H) + ([d]× Hᵀ)ᵀ (old H)
        let old = d.cross_rows(&self.coupling);
        self.coupling = self.coupling + self.translational.full().map_columns(|column| d.cross(column));
        let new = d.cross_rows(&self.coupling);
        let own = self.rotational;
        self.rotational = Symmetric3::from_entries(|i, j| own.at(i, j) + old.0[j][i] + new.0[i][j]);
    }

    /// Transforms to components in the frame before a rotation.
    pub fn rotate_about_axis(&mut self, rotation: &AxisRotation<'g>) {
        *self = Articulated {
            rotational: rotation.to_outer_symmetric(&self.rotational),
            coupling: rotation.to_outer_matrix(&self.coupling),
            translational: rotation.to_outer_symmetric(&self.translational),
            moment: rotation.to_outer(self.moment),
            force: rotation.to_outer(self.force),
        };
    }

    /// Transforms to components in the frame before a rotation R.
    pub fn rotate(&mut self, rotation: Rotation<'g>) {
        *self = Articulated {
            rotational: self.rotational.rotated(rotation),
            coupling: self.coupling.rotated(rotation),
            translational: self.translational.rotated(rotation),
            moment: rotation.apply(self.moment),
            force: rotation.apply(self.force),
        };
    }

    /// Transforms the wrench that a released ball joint transmits, a force and the moment n, to components in the frame before
    /// a rotation R.
    pub fn rotate_force(&mut self, rotation: Rotation<'g>, moment: Vec3<'g>) {
        self.translational = self.translational.rotated(rotation);
        self.moment = moment;
        self.force = rotation.apply(self.force);
    }

    /// Releases the rotation about an axis, in the frame after it; `gyration` is `ω × e q̇`.
    ///
    /// `D = J_kk + d̂`, `q̈ = (τ − n₀_k − J_k α − H_k a) / D`. Row k of J, H and n₀ then gives the moment `τ − d̂ q̈` about the axis:
    /// J and H are scaled by d̂/D, and without added inertia only τ remains. This is computed directly instead of as a difference
    /// that should be zero.
    pub fn free_rotation(&mut self, axis: Axis, effort: Effort<'g>, gyration: Vec3<'g>) -> Response<'g> {
        let k = axis.index();
        self.moment = self.moment + self.rotational.apply(gyration);
        self.force = self.force + self.coupling.apply_transposed(gyration);
        let reciprocal = 1.0 / (self.rotational.at(k, k) + effort.added_inertia);
        let (angular, linear) = (self.rotational.row(k), self.coupling.row(k));
        let (scaled_angular, scaled_linear) = (reciprocal * angular, reciprocal * linear);
        let free = reciprocal * (effort.applied - self.moment[k]);
        let kept = effort.added_inertia * reciprocal;

        let own = self.rotational;
        self.rotational = Symmetric3::from_entries(|i, j| {
            if i == k || j == k { kept * own.at(i, j) } else { own.at(i, j) - scaled_angular[i] * angular[j] }
        });
        let own = self.coupling.0;
        self.coupling = Matrix3([0, 1, 2].map(|i| {
            [0, 1, 2].map(|j| if i == k { kept * own[i][j] } else { own[i][j] - scaled_angular[i] * linear[j] })
        }));
        let own = self.translational;
        self.translational = Symmetric3::from_entries(|i, j| own.at(i, j) - scaled_linear[i] * linear[j]);
        let own = self.moment;
        self.moment =
            Vec3([0, 1, 2].map(|i| {
                if i == k { effort.applied - effort.added_inertia * free } else { own[i] + angular[i] * free }
            }));
        self.force = self.force + free * linear;
        // α of the response does not include the gyration: its moment is already in n₀.
        Response { rest: free, reciprocal, angular: scaled_angular, linear: scaled_linear }
    }

    /// Releases the translation along an axis. `D = M_kk + d̂`, `q̈ = (τ − f₀_k − H_kᵀ α − M_k a) / D`.
    pub fn free_translation(&mut self, axis: Axis, effort: Effort<'g>) -> Response<'g> {
        let k = axis.index();
        let reciprocal = 1.0 / (self.translational.at(k, k) + effort.added_inertia);
        let (angular, linear) = (self.coupling.column(k), self.translational.row(k));
        let (scaled_angular, scaled_linear) = (reciprocal * angular, reciprocal * linear);
        let free = reciprocal * (effort.applied - self.force[k]);
        let kept = effort.added_inertia * reciprocal;

        let own = self.translational;
        self.translational = Symmetric3::from_entries(|i, j| {
            if i == k || j == k { kept * own.at(i, j) } else { own.at(i, j) - scaled_linear[i] * linear[j] }
        });
        let own = self.coupling.0;
        self.coupling = Matrix3([0, 1, 2].map(|i| {
            [0, 1, 2].map(|j| if j == k { kept * own[i][j] } else { own[i][j] - scaled_angular[i] * linear[j] })
        }));
        let own = self.rotational;
        self.rotational = Symmetric3::from_entries(|i, j| own.at(i, j) - scaled_angular[i] * angular[j]);
        let own = self.force;
        self.force =
            Vec3([0, 1, 2].map(|i| {
                if i == k { effort.applied - effort.added_inertia * free } else { own[i] + linear[i] * free }
            }));
        self.moment = self.moment + free * angular;
        Response { rest: free, reciprocal, angular: scaled_angular, linear: scaled_linear }
    }

    /// Prescribes `q̈` of a rotation about an axis, in the frame after it; `gyration` is `ω × e q̇`.
    ///
    /// The part beyond the joint moves with the part before it except for `e q̈` and the gyration: J, H and M stay, and n₀ and f₀
    /// include these accelerations. `τ = n₀_k + J_k α + H_k a + d̂ q̈`. Featherstone 2008, section 9.2.
    pub fn prescribe_rotation(
        &mut self,
        axis: Axis,
        acceleration: Expr<'g>,
        added_inertia: Expr<'g>,
        gyration: Vec3<'g>,
    ) -> Reaction<'g> {
        let k = axis.index();
        let own = Vec3::along(axis, acceleration) + gyration;
        self.moment = self.moment + self.rotational.apply(own);
        self.force = self.force + self.coupling.apply_transposed(own);
        let rest = self.moment[k] + added_inertia * acceleration;
        Reaction { rest, angular: self.rotational.row(k), linear: self.coupling.row(k) }
    }

    /// Prescribes `q̈` of a translation along an axis. `τ = f₀_k + H_kᵀ α + M_k a + d̂ q̈`.
    pub fn prescribe_translation(
        &mut self,
        axis: Axis,
        acceleration: Expr<'g>,
        added_inertia: Expr<'g>,
    ) -> Reaction<'g> {
        let k = axis.index();
        let own = Vec3::along(axis, acceleration);
        self.moment = self.moment + self.coupling.apply(own);
        self.force = self.force + self.translational.apply(own);
        let rest = self.force[k] + added_inertia * acceleration;
        Reaction { rest, angular: self.coupling.column(k), linear: self.translational.row(k) }
    }

    /// Releases all rotations about the origin, against the moment `n_τ − D' (α' − α)`; everything in one frame.
    ///
    /// With `K = J + D'`: `α' − α = K⁻¹ (n_τ − n₀ − H a − J α)`. The joint transmits
    /// `J ← D' K⁻¹ J`, `H ← D' K⁻¹ H`, `M ← M − Hᵀ K⁻¹ H`: without added inertia a pure force, with J and H exactly zero, so
    /// that no digits are lost.
    pub fn free_ball(&mut self, moment: Vec3<'g>, added_inertia: Option<Symmetric3<'g>>) -> BallResponse<'g> {
        let blocks = added_inertia.map_or(self.rotational, |d| self.rotational + d).inverse();
        let graph = moment[0].graph();
        let coupling = self.coupling;
        let missing = moment - self.moment;
        let (mut linear, mut rest) = (Matrix3::zero(graph), Vec3::zero(graph));
        for (reciprocal, cofactors) in &blocks {
            let part = coupling.map_columns(|column| cofactors.apply(column));
            let own = self.translational;
            self.translational =
                Symmetric3::from_entries(|i, j| own.at(i, j) - *reciprocal * coupling.column(i).dot(part.column(j)));
            linear = linear + part.map_columns(|column| *reciprocal * column);
            rest = rest + *reciprocal * cofactors.apply(missing);
        }
        self.force = self.force + coupling.apply_transposed(rest);
        let Some(added_inertia) = added_inertia else {
            (self.rotational, self.coupling) = (Symmetric3::zero(graph), Matrix3::zero(graph));
            self.moment = moment;
            return BallResponse { rest, angular: None, linear };
        };
        let solve = |column: Vec3<'g>| {
            let parts = blocks.iter().map(|(reciprocal, cofactors)| *reciprocal * cofactors.apply(column));
            parts.fold(Vec3::zero(graph), Vec3::add)
        };
        let angular = self.rotational.full().map_columns(solve);
        self.rotational = Symmetric3::from_entries(|i, j| added_inertia.row(i).dot(angular.column(j)));
        self.coupling = linear.map_columns(|column| added_inertia.apply(column));
        self.moment = moment - added_inertia.apply(rest);
        BallResponse { rest, angular: Some(angular), linear }
    }
}

impl Add for Articulated<'_> {
    type Output = Self;

    /// What two parts attached at the same frame require together.
    fn add(self, other: Self) -> Self {
        Articulated {
            rotational: self.rotational + other.rotational,
            coupling: self.coupling + other.coupling,
            translational: self.translational + other.translational,
            moment: self.moment + other.moment,
            force: self.force + other.force,
        }
    }
}

impl<'g> Reaction<'g> {
    /// τ from the accelerations before the joint's own motion.
    pub fn effort(&self, angular: Vec3<'g>, linear: Vec3<'g>) -> Expr<'g> {
        self.rest + (self.angular.dot(angular) + self.linear.dot(linear))
    }
}

impl<'g> Response<'g> {
    /// q̈ from the accelerations before the joint's own motion.
    pub fn acceleration(&self, angular: Vec3<'g>, linear: Vec3<'g>) -> Expr<'g> {
        self.rest - (self.angular.dot(angular) + self.linear.dot(linear))
    }
}
