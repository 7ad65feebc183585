//! Forces by kind.

use super::{Derivation, function};
use crate::chain::Group;
use crate::mechanics::acts::add;
use crate::mechanics::forces::Kind;
use crate::mechanics::{connectors, loads, supports};
use crate::program::Argument::{Position, Time, Velocity};
use crate::program::{Function, FunctionId, Shape, Struct};
use crate::symbolic::{Expr, SweepTrace};

/// The equation of the drives' forces if some are rigid.
const WITH_RIGID_DRIVES: &str = "s (q_dr − q) + d (q̇_dr − q̇) [Urbaś 2016, Eqs. (20)–(21)]; of rigid drives (A q̈ − e)_j";

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
            let (id, doc, equation, arguments) = kind.row().forces;
            let equation = if kind == Kind::Drives && self.rigid { WITH_RIGID_DRIVES } else { equation };
            functions.push(function(id, doc, equation, arguments, vector(), forces).by(trace));
            functions.extend(match kind {
                Kind::Supports => self.reactions_and_gaps(),
                Kind::Drives => self.drives(),
                Kind::Loads => self.load_pieces(),
                Kind::Of(Group::Connectors) => self.connectors(),
                Kind::Of(_) => Vec::new(),
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
            _ => (self.forces().of(kind).in_motion(), SweepTrace::default()),
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
        let count = model.chain.connectors().len();
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
