//! Forces by kind.

use super::{Derivation, function};
use crate::mechanics::forces::{Kind, add};
use crate::mechanics::{connectors, loads, supports};
use crate::program::Argument::{Position, Time, Velocity};
use crate::program::{Argument, Function, FunctionId, Shape, Struct};
use crate::symbolic::{Expr, SweepTrace};

impl<'g> Derivation<'g> {
    /// The forces of each kind with what belongs to it, and their sum.
    pub(super) fn force_functions(&self) -> Vec<Function> {
        let model = &self.model;
        let vector = || Shape::Vector(model.size());
        let mut functions = Vec::new();
        let mut sum = None;
        for kind in self.forces().kinds() {
            let (forces, trace) = self.generalized(kind);
            let total = sum.take().unwrap_or_else(|| model.zeros());
            sum = Some(add(&total, &forces));
            let (id, doc, equation, arguments) = self.signature(kind);
            functions.push(function(id, doc, equation, arguments, vector(), forces).by(trace));
            functions.extend(match kind {
                Kind::Supports => self.reactions_and_gaps(),
                Kind::Drives => self.drives(),
                Kind::Loads => self.load_pieces(),
                Kind::Connectors => self.connectors(),
                Kind::BeamSprings | Kind::JointDampers | Kind::Stops | Kind::Friction => Vec::new(),
            });
        }
        functions.extend(sum.map(|sum| {
            function(
                FunctionId::Forces,
                "Generalized forces of everything except inertia and gravity, N and N m.",
                "f_s + f_l + t_dr and viscous joints [Urbaś 2016, Eq. (23)]",
                &[Time, Position, Velocity],
                vector(),
                sum,
            )
            .by(self.generalized(Kind::Drives).1)
        }));
        functions
    }

    /// Generalized forces of a kind, including those of rigid drives, with the order of their operations.
    fn generalized(&self, kind: Kind) -> (Vec<Expr<'g>>, SweepTrace) {
        match kind {
            Kind::Drives => self.recorded_if_rigid(|| self.drive_forces()),
            _ => (self.forces().in_motion(kind), SweepTrace::default()),
        }
    }

    /// Documentation, equation and arguments of the function with the generalized forces of a kind.
    fn signature(&self, kind: Kind) -> (FunctionId, &'static str, &'static str, &'static [Argument]) {
        match kind {
            Kind::Supports => (
                FunctionId::SupportForces,
                "Generalized forces of the supports, N and N m.",
                "−Jᵀ (s e + d ė) [Urbaś 2016, Eq. (18)]",
                &[Position, Velocity],
            ),
            Kind::BeamSprings => (
                FunctionId::ElementForces,
                "Generalized forces of the springs and dampers between rigid elements, N m.",
                "−S q̃ − D q̃̇ [Urbaś 2016, Eq. (15)]",
                &[Position, Velocity],
            ),
            Kind::Drives => (
                FunctionId::DriveForces,
                "Generalized forces of the drives, N and N m.",
                if self.rigid {
                    "s (q_dr − q) + d (q̇_dr − q̇) [Urbaś 2016, Eqs. (20)–(21)]; of rigid drives (A q̈ − e)_j"
                } else {
                    "s (q_dr − q) + d (q̇_dr − q̇) [Urbaś 2016, Eqs. (20)–(21)]"
                },
                &[Time, Position, Velocity],
            ),
            Kind::JointDampers => (
                FunctionId::JointDamperForces,
                "Generalized forces of viscous damping in passive joints, N and N m.",
                "−d q̇",
                &[Velocity],
            ),
            Kind::Stops => (
                FunctionId::StopForces,
                "Generalized forces of the end stops, N and N m.",
                "−k δ max(0, 1 + a δ̇)",
                &[Position, Velocity],
            ),
            Kind::Friction => (
                FunctionId::FrictionForces,
                "Generalized forces of joint friction, N and N m.",
                "−(F_c + (F_b − F_c) exp(−(q̇/v_s)²)) tanh(q̇/v₀) − b q̇",
                &[Velocity],
            ),
            Kind::Loads => (
                FunctionId::LoadForces,
                "Generalized forces of the loads applied from outside, N and N m.",
                "F · Ω_j x + M · ω_j",
                &[Time, Position],
            ),
            Kind::Connectors => (
                FunctionId::ConnectorForces,
                "Generalized forces of connectors, N and N m.",
                "−Jᵀ F",
                &[Time, Position, Velocity],
            ),
        }
    }

    /// Forces on the supports, and how far one-sided ones are above the ground.
    fn reactions_and_gaps(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let mut functions = vec![function(
            FunctionId::SupportReactions,
            "Forces of the supports on the crane in the world frame, N.",
            "−s e − d ė [Urbaś 2016, Eq. (16)]",
            &[Position, Velocity],
            Shape::Vectors(chain.supports.len()),
            supports::reactions(model, &self.kinematics),
        )];
        if chain.has_one_sided_supports() {
            functions.push(function(
                FunctionId::SupportGaps,
                "How far one-sided supports are above the ground, m, negative where they are pressed in, and its rate, m/s; 0 for others.",
                "e_z, ė_z [Urbaś 2016, Eq. (16)]",
                &[Position, Velocity],
                Shape::Pairs(chain.supports.len()),
                supports::gaps(model, &self.kinematics),
            ));
        }
        functions
    }

    /// When the scales of loads are smooth.
    fn load_pieces(&self) -> Vec<Function> {
        let pieces = loads::pieces(&self.model);
        if pieces.is_empty() {
            return Vec::new();
        }
        vec![function(
            FunctionId::LoadPieces,
            "Start and end of the intervals in which the scales of loads are smooth, load by load, s.",
            "t_begin, t_end",
            &[],
            Shape::Pairs(pieces.len() / 2),
            pieces,
        )]
    }

    /// Lengths and tangents of connectors.
    fn connectors(&self) -> Vec<Function> {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let count = model.chain.connectors.len();
        let mut functions = vec![
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
}
