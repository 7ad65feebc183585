//! Forces by part.

use super::{Derivation, function, sum};
use crate::mechanics::{connectors, drives, joints, loads, springs, supports};
use crate::program::Argument::{Position, Time, Velocity};
use crate::program::{Argument, Function, FunctionId, Shape, Struct};
use crate::symbolic::Expr;

/// A part of the forces: identifier, documentation, equation and arguments of its function, and its expressions.
type Part<'g> = (FunctionId, &'static str, &'static str, &'static [Argument], Vec<Expr<'g>>);

impl<'g> Derivation<'g> {
    /// How far one-sided supports are above the ground, if there are any.
    fn support_gaps(&self) -> Option<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        chain.has_one_sided_supports().then(|| {
            function(
                FunctionId::SupportGaps,
                "How far one-sided supports are above the ground, m, negative where they are pressed in, and its rate, m/s; 0 for others.",
                "e_z, ė_z [Urbaś 2016, Eq. (16)]",
                &[Position, Velocity],
                Shape::Pairs(chain.supports.len()),
                supports::gaps(model, &self.kinematics),
            )
        })
    }

    pub(super) fn forces(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let vector = || Shape::Vector(model.size());
        let mut functions = Vec::new();
        let mut parts = vec![model.zeros()];
        if !chain.supports.is_empty() {
            let forces = supports::forces(model, &self.kinematics, &model.v);
            parts.push(forces.clone());
            functions.push(function(
                FunctionId::SupportForces,
                "Generalized forces of the supports, N and N m.",
                "−Jᵀ (s e + d ė) [Urbaś 2016, Eq. (18)]",
                &[Position, Velocity],
                vector(),
                forces,
            ));
            functions.push(function(
                FunctionId::SupportReactions,
                "Forces of the supports on the crane in the world frame, N.",
                "−s e − d ė [Urbaś 2016, Eq. (16)]",
                &[Position, Velocity],
                Shape::Vectors(chain.supports.len()),
                supports::reactions(model, &self.kinematics),
            ));
        }
        functions.extend(self.support_gaps());
        if !chain.beam_springs.is_empty() {
            let forces = springs::element_forces(model, &model.q, &model.v);
            parts.push(forces.clone());
            functions.push(function(
                FunctionId::ElementForces,
                "Generalized forces of the springs and dampers between rigid elements, N m.",
                "−S q̃ − D q̃̇ [Urbaś 2016, Eq. (15)]",
                &[Position, Velocity],
                vector(),
                forces,
            ));
        }
        if !chain.drives.is_empty() {
            let (forces, trace) = self.recorded_if_rigid(|| self.drive_forces());
            parts.push(forces.clone());
            functions.extend(self.drives(forces, trace));
        }
        if !chain.joint_dampers.is_empty() {
            let forces = springs::joint_damper_forces(model, &model.v);
            parts.push(forces.clone());
            functions.push(function(
                FunctionId::JointDamperForces,
                "Generalized forces of viscous damping in passive joints, N and N m.",
                "−d q̇",
                &[Velocity],
                vector(),
                forces,
            ));
        }
        for (id, doc, equation, arguments, forces) in self.joint_forces() {
            parts.push(forces.clone());
            functions.push(function(id, doc, equation, arguments, vector(), forces));
        }
        if !chain.loads.is_empty() {
            let forces = loads::forces(model, &self.kinematics, model.t);
            parts.push(forces.clone());
            functions.push(function(
                FunctionId::LoadForces,
                "Generalized forces of the loads applied from outside, N and N m.",
                "F · Ω_j x + M · ω_j",
                &[Time, Position],
                vector(),
                forces,
            ));
            let pieces = loads::pieces(model);
            if !pieces.is_empty() {
                functions.push(function(
                    FunctionId::LoadPieces,
                    "Start and end of the intervals in which the scales of loads are smooth, load by load, s.",
                    "t_begin, t_end",
                    &[],
                    Shape::Pairs(pieces.len() / 2),
                    pieces,
                ));
            }
        }
        if !chain.connectors.is_empty() {
            parts.push(connectors::forces(model, &self.kinematics, model.t, Some(&model.v)));
            functions.extend(self.connectors());
        }
        if parts.len() > 1 {
            functions.push(
                function(
                    FunctionId::Forces,
                    "Generalized forces of everything except inertia and gravity, N and N m.",
                    "f_s + f_l + t_dr and viscous joints [Urbaś 2016, Eq. (23)]",
                    &[Time, Position, Velocity],
                    vector(),
                    sum(&parts),
                )
                .by(self.recorded_if_rigid(|| self.drive_forces()).1),
            );
        }
        functions
    }

    /// Forces in joints other than those of drives and viscous damping, if the crane has any.
    fn joint_forces(&self) -> Vec<Part<'g>> {
        let model = &self.model;
        let mut parts: Vec<Part<'g>> = Vec::new();
        if model.chain.stops().next().is_some() {
            parts.push((
                FunctionId::StopForces,
                "Generalized forces of the end stops, N and N m.",
                "−k δ max(0, 1 + a δ̇)",
                &[Position, Velocity],
                joints::stop_forces(model, &model.v),
            ));
        }
        if model.chain.frictions().next().is_some() {
            parts.push((
                FunctionId::FrictionForces,
                "Generalized forces of joint friction, N and N m.",
                "−(F_c + (F_b − F_c) exp(−(q̇/v_s)²)) tanh(q̇/v₀) − b q̇",
                &[Velocity],
                joints::friction_forces(model, &model.v),
            ));
        }
        parts
    }

    /// Forces, lengths and tangents of connectors.
    fn connectors(&self) -> Vec<Function> {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let count = model.chain.connectors.len();
        let mut functions = vec![
            function(
                FunctionId::ConnectorForces,
                "Generalized forces of connectors, N and N m.",
                "−Jᵀ F",
                &[Time, Position, Velocity],
                Shape::Vector(model.size()),
                connectors::forces(model, kinematics, model.t, Some(&model.v)),
            ),
            function(
                FunctionId::ConnectorForcesAtRest,
                "Generalized forces of connectors while nothing moves, not even a winch, N and N m.",
                "−Jᵀ F(ℓ, 0)",
                &[Time, Position],
                Shape::Vector(model.size()),
                connectors::forces(model, kinematics, model.t, None),
            ),
            function(
                FunctionId::ConnectorLengths,
                "Length ℓ (m) of every connector, and its rate ℓ̇ (m/s).",
                "|p₂ − p₁|, J q̇",
                &[Position, Velocity],
                Shape::Pairs(count),
                connectors::lengths(model, kinematics),
            ),
            function(
                FunctionId::ConnectorTensions,
                "Force F of every connector (N), positive where it pulls, and its derivatives ∂F/∂ℓ (N/m) and ∂F/∂ℓ̇ (N s/m).",
                "k (ℓ − ℓ₀) + d ℓ̇ − P; k σ max(0, 1 + a σ̇)",
                &[Time, Position, Velocity],
                Shape::Structs(Struct::Tension, count),
                connectors::tensions(model, kinematics),
            ),
            function(
                FunctionId::ConnectorJacobians,
                "How the length of every connector changes with the coordinates, one row per connector, m/rad and 1.",
                "J = ∂ℓ/∂q",
                &[Position],
                Shape::Rows { count, n: model.size() },
                connectors::jacobians(model, kinematics),
            ),
        ];
        let pieces = connectors::pieces(model);
        if !pieces.is_empty() {
            functions.push(function(
                FunctionId::WinchPieces,
                "Start and end of the intervals in which winches move smoothly, connector by connector, s.",
                "t_begin, t_end",
                &[],
                Shape::Pairs(pieces.len() / 2),
                pieces,
            ));
        }
        functions
    }

    /// Generalized forces of everything except inertia, gravity and rigid drives.
    pub(super) fn given_forces(&self, t: Expr<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let model = &self.model;
        let mut parts = vec![
            supports::forces(model, &self.kinematics, v),
            springs::element_forces(model, &model.q, v),
            drives::forces(model, t, v),
            springs::joint_damper_forces(model, v),
        ];
        if !model.chain.forces.is_empty() {
            parts.extend([joints::stop_forces(model, v), joints::friction_forces(model, v)]);
        }
        if !model.chain.loads.is_empty() {
            parts.push(loads::forces(model, &self.kinematics, t));
        }
        if !model.chain.connectors.is_empty() {
            parts.push(connectors::forces(model, &self.kinematics, t, Some(v)));
        }
        sum(&parts)
    }
}
