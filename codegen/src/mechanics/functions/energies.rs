//! Energies by kind of force, and powers.

use super::{Derivation, function};
use crate::chain::Group;
use crate::mechanics::forces::Kind;
use crate::mechanics::{connectors, drives, gravity, loads};
use crate::program::Argument::{self, Position, Time, Velocity};
use crate::program::{Function, FunctionId, Shape};
use crate::symbolic::Expr;

impl Derivation<'_> {
    pub(super) fn energies(&self) -> Vec<Function> {
        let forces = self.forces();
        let mut functions = vec![scalar(
            FunctionId::GravityEnergy,
            "Potential energy of gravity, zero at the world's origin, J.",
            "E_g = −Σ γ · ∫ x dm [Urbaś 2016, Eq. (6)]",
            &[Position],
            gravity::energy(&self.model, &self.inertias),
        )];
        for kind in forces.kinds() {
            functions.extend(self.energy(kind));
            functions.extend(self.power(kind));
        }
        let dissipation = forces.dissipation();
        if !dissipation.is_zero() {
            functions.push(scalar(
                FunctionId::Dissipation,
                "Power that all dampers dissipate, W.",
                "2R [Urbaś 2016, Eqs. (14), (17), (19)]",
                &[Time, Position, Velocity],
                dissipation,
            ));
        }
        functions
    }

    /// Energy of a kind of force, if it stores any.
    fn energy(&self, kind: Kind) -> Option<Function> {
        let (id, doc, equation, arguments) = kind.row().energy?;
        Some(scalar(id, doc, equation, arguments, self.forces().of(kind).energy()?))
    }

    /// Power that a kind of force puts in, if it can.
    fn power(&self, kind: Kind) -> Option<Function> {
        let (model, kinematics) = (&self.model, &self.kinematics);
        let power = |id, doc, equation, power| scalar(id, doc, equation, &[Time, Position, Velocity], power);
        match kind {
            Kind::Drives => {
                let (of_motions, trace) = self.recorded_if_rigid(|| {
                    let efforts = if self.rigid { self.rigid_efforts() } else { vec![] };
                    drives::power(model, &efforts)
                });
                let (doc, equation) = ("Power of the prescribed motions, W.", "Σ t_dr q̇_dr");
                Some(power(FunctionId::DrivePower, doc, equation, of_motions).by(trace))
            }
            Kind::Loads => Some(power(
                FunctionId::LoadPower,
                "Power that the loads applied from outside put in, W.",
                "Σ F · ẋ + M · ω",
                loads::power(model, kinematics, &self.twists),
            )),
            Kind::Of(Group::Connectors) => {
                let has_winches = model.chain.connectors().iter().any(|connector| connector.winch().is_some());
                let of_winches = has_winches.then(|| connectors::winch_power(model, kinematics))?;
                Some(power(FunctionId::WinchPower, "Power that winches put in, W.", "−Σ F ℓ̇₀", of_winches))
            }
            Kind::Supports | Kind::Of(_) => None,
        }
    }
}

fn scalar(
    id: FunctionId,
    doc: &'static str,
    equation: &'static str,
    arguments: &'static [Argument],
    of: Expr<'_>,
) -> Function {
    function(id, doc, equation, arguments, Shape::Scalar, vec![of])
}
