//! Energies by part, and powers.

use super::{Derivation, function};
use crate::mechanics::{connectors, drives, gravity, joints, loads, springs, supports};
use crate::program::Argument::{Position, Time, Velocity};
use crate::program::{Function, FunctionId, Shape};

impl Derivation<'_> {
    /// Energy of connectors and power of winches, if there are any.
    fn connector_energies(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let mut functions = Vec::new();
        if !chain.connectors.is_empty() {
            functions.push(function(
                FunctionId::ConnectorEnergy,
                "Energy of connectors, J.",
                "½ Σ k (ℓ − ℓ₀)² − P (ℓ − ℓ₀)",
                &[Time, Position],
                Shape::Scalar,
                vec![connectors::energy(model, &self.kinematics)],
            ));
        }
        if chain.connectors.iter().any(|connector| connector.winch().is_some()) {
            functions.push(function(
                FunctionId::WinchPower,
                "Power that winches put in, W.",
                "−Σ F ℓ̇₀",
                &[Time, Position, Velocity],
                Shape::Scalar,
                vec![connectors::winch_power(model, &self.kinematics)],
            ));
        }
        functions
    }

    pub(super) fn energies(&self) -> Vec<Function> {
        let (model, chain) = (&self.model, self.model.chain);
        let scalar =
            |id, doc, equation, arguments, expr| function(id, doc, equation, arguments, Shape::Scalar, vec![expr]);
        let mut functions = vec![scalar(
            FunctionId::GravityEnergy,
            "Potential energy of gravity, zero at the world's origin, J.",
            "E_g = −Σ γ · ∫ x dm [Urbaś 2016, Eq. (6)]",
            &[Position],
            gravity::energy(model, &self.inertias),
        )];
        if !chain.supports.is_empty() {
            functions.push(scalar(
                FunctionId::SupportEnergy,
                "Energy of the supports' springs, J.",
                "½ Σ s e² [Urbaś 2016, Eqs. (16)–(17)]",
                &[Position],
                supports::energy(model, &self.kinematics),
            ));
        }
        if !chain.beam_springs.is_empty() {
            functions.push(scalar(
                FunctionId::ElementEnergy,
                "Energy of the springs between rigid elements, J.",
                "½ q̃ᵀ S q̃ [Urbaś 2016, Eq. (14)]",
                &[Position],
                springs::element_energy(model),
            ));
        }
        if !chain.drives.is_empty() {
            if chain.drives.iter().any(|drive| drive.spring().is_some()) {
                functions.push(scalar(
                    FunctionId::DriveEnergy,
                    "Energy of the drives' springs, J.",
                    "½ Σ s (q_dr − q)² [Urbaś 2016, Eq. (19)]",
                    &[Time, Position],
                    drives::energy(model),
                ));
            }
            let (power, trace) = self.recorded_if_rigid(|| {
                let efforts = if self.rigid { self.rigid_efforts() } else { vec![] };
                drives::power(model, &efforts)
            });
            functions.push(
                scalar(
                    FunctionId::DrivePower,
                    "Power of the prescribed motions, W.",
                    "Σ t_dr q̇_dr",
                    &[Time, Position, Velocity],
                    power,
                )
                .by(trace),
            );
        }
        if !chain.loads.is_empty() {
            functions.push(scalar(
                FunctionId::LoadPower,
                "Power that the loads applied from outside put in, W.",
                "Σ F · ẋ + M · ω",
                &[Time, Position, Velocity],
                loads::power(model, &self.kinematics, &self.twists),
            ));
        }
        functions.extend(self.connector_energies());
        if chain.stops().next().is_some() {
            functions.push(scalar(
                FunctionId::StopEnergy,
                "Energy of the end stops, J.",
                "½ Σ k δ²",
                &[Position],
                joints::stop_energy(model),
            ));
        }
        let linear =
            supports::dissipation(model, &self.kinematics) + springs::dissipation(model) + drives::dissipation(model);
        let joints = if chain.forces.is_empty() { linear } else { linear + joints::dissipation(model) };
        let between_points = (!chain.connectors.is_empty()).then(|| connectors::dissipation(model, &self.kinematics));
        let dissipation = between_points.map_or(joints, |connectors| joints + connectors);
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
}
