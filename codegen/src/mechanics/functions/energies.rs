//! Energies by kind of force, and powers.

use super::Derivation;
use crate::chain::Group;
use crate::mechanics::forces::Kind;
use crate::mechanics::{connectors, drives, gravity, loads};
use crate::program::{Function, FunctionId};

impl Derivation<'_> {
    pub(super) fn energies(&self) -> Vec<Function> {
        let forces = self.forces();
        let mut functions =
            vec![self.function(FunctionId::GravityEnergy, vec![gravity::energy(&self.model, &self.inertias)])];
        for kind in forces.kinds() {
            functions.extend(self.energy(kind));
            functions.extend(self.power(kind));
        }
        let dissipation = forces.dissipation();
        if !dissipation.is_zero() {
            functions.push(self.function(FunctionId::Dissipation, vec![dissipation]));
        }
        functions
    }

    /// Energy of a kind of force, if it stores any.
    fn energy(&self, kind: Kind) -> Option<Function> {
        let id = kind.row().energy?;
        Some(self.function(id, vec![self.forces().forces_of_kind(kind).energy()?]))
    }

    /// Power that a kind of force puts in, if it can.
    fn power(&self, kind: Kind) -> Option<Function> {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let function = |id, power| self.function(id, vec![power]);
        match kind {
            Kind::Drives => {
                let (of_motions, trace) = self.recorded_if_rigid(|| {
                    let efforts = if self.rigid { self.rigid_efforts() } else { vec![] };
                    drives::power(model, &efforts)
                });
                Some(function(FunctionId::DrivePower, of_motions).by(trace))
            }
            Kind::Loads => Some(function(FunctionId::LoadPower, loads::power(model, kinematics, &self.twists))),
            Kind::Of(Group::Connectors) => {
                let has_winches = model.chain.connectors().iter().any(|connector| connector.winch().is_some());
                let of_winches = has_winches.then(|| connectors::winch_power(self.posed()))?;
                Some(function(FunctionId::WinchPower, of_winches))
            }
            Kind::Supports | Kind::Of(_) => None,
        }
    }
}
