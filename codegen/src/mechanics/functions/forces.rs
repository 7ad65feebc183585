//! Forces by kind.

use super::Derivation;
use crate::chain::Group;
use crate::mechanics::acts::add;
use crate::mechanics::forces::Kind;
use crate::mechanics::{connectors, loads, supports};
use crate::program::{Function, FunctionId};
use crate::symbolic::{Expr, SweepTrace};

/// The equation of the drives' forces if some are rigid.
const WITH_RIGID_DRIVES: &str = "s (q_dr − q) + d (q̇_dr − q̇) [Urbaś 2016, Eqs. (20)–(21)]; of rigid drives (A q̈ − e)_j";

impl<'g> Derivation<'g> {
    /// The forces of each kind with what belongs to it, and their sum.
    pub(super) fn force_functions(&self) -> Vec<Function> {
        let model = &self.model;
        let mut functions = Vec::new();
        let mut sum = None;
        for kind in self.forces().kinds() {
            let (forces, trace) = self.generalized(kind);
            let total = sum.take().unwrap_or_else(|| model.zeros());
            sum = Some(add(&total, &forces));
            let id = kind.row().forces;
            let equation = if kind == Kind::Drives && self.rigid { WITH_RIGID_DRIVES } else { id.equation() };
            functions.push(Function { equation, ..self.function(id, forces).by(trace) });
            functions.extend(match kind {
                Kind::Supports => self.reactions_and_gaps(),
                Kind::Drives => self.drives(),
                Kind::Loads => self.load_pieces(),
                Kind::Of(Group::Connectors) => self.connectors(),
                Kind::Of(_) => Vec::new(),
            });
        }
        functions.extend(sum.map(|sum| self.function(FunctionId::Forces, sum).by(self.generalized(Kind::Drives).1)));
        functions
    }

    /// Generalized forces of a kind, including those of rigid drives, with the order of their operations.
    fn generalized(&self, kind: Kind) -> (Vec<Expr<'g>>, SweepTrace) {
        match kind {
            Kind::Drives => self.recorded_if_rigid(|| self.drive_forces()),
            _ => (self.forces().forces_of_kind(kind).in_motion(), SweepTrace::default()),
        }
    }

    /// Forces on the supports, and how one-sided ones stand on the ground.
    fn reactions_and_gaps(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let mut functions =
            vec![self.function(FunctionId::SupportReactions, supports::reactions(model, &self.kinematics))];
        if chain.has_one_sided_supports() {
            let kinematics = &self.kinematics;
            functions.extend([
                self.function(FunctionId::SupportGaps, supports::gaps(model, kinematics)),
                self.function(FunctionId::SupportElongations, supports::elongations(model, kinematics)),
                self.function(FunctionId::SupportJacobians, supports::jacobians(model, kinematics)),
                self.function(FunctionId::SupportStiffnesses, supports::stiffnesses(model)),
                self.function(FunctionId::SupportDampings, supports::dampings(model)),
                self.function(FunctionId::SupportGrips, supports::grips(model, kinematics)),
            ]);
        }
        functions
    }

    /// When the scales of loads are smooth.
    fn load_pieces(&self) -> Vec<Function> {
        let pieces = loads::pieces(&self.model);
        if pieces.is_empty() {
            return Vec::new();
        }
        vec![self.function(FunctionId::LoadPieces, pieces)]
    }

    /// Lengths and tangents of connectors.
    fn connectors(&self) -> Vec<Function> {
        let posed = self.posed();
        let mut functions = vec![
            self.function(FunctionId::ConnectorLengths, connectors::lengths(posed)),
            self.function(FunctionId::ConnectorTensions, connectors::tensions(posed)),
            self.function(FunctionId::ConnectorJacobians, connectors::jacobians(posed)),
        ];
        let pieces = connectors::pieces(&self.model);
        if !pieces.is_empty() {
            functions.push(self.function(FunctionId::WinchPieces, pieces));
        }
        functions
    }
}
