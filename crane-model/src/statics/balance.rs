//! How far a pose is from equilibrium, in one number.

use nalgebra::SVector;

use crate::{CoordinateKind, Statics};

/// Smallest force scale, 1 N and 1 N m: without gravity and springs there is nothing to compare with.
const LEAST_FORCE: f64 = 1.0;

/// Size of the forces that balance, by which the residual is measured.
///
/// Every row of `r = ∂E_p/∂q = ∂E_g/∂q − f` balances gravity against springs. A row in N cannot be compared with a row in
/// N m, and one alone may balance nothing at all (a passive hinge in equilibrium: 0 = 0). So the scale of a translation is
/// the greatest force that any translation balances at the guess, that of a rotation the greatest moment of any rotation.
pub(super) struct Balance<const N: usize> {
    scale: SVector<f64, N>,
}

impl<const N: usize> Balance<N> {
    /// Scales from the terms of the balance at pose `q`.
    pub(super) fn at<C: Statics<N>>(crane: &C, q: &SVector<f64, N>) -> Self {
        let coordinates = crane.description().coordinates;
        let springs = crane.forces(0.0, q, &SVector::zeros());
        let gravity = crane.static_residual(q) + springs;
        let greatest = |kind: CoordinateKind| {
            (0..N)
                .filter(|&i| coordinates[i].kind == kind)
                .map(|i| springs[i].abs().max(gravity[i].abs()))
                .fold(LEAST_FORCE, f64::max)
        };
        let (force, moment) = (greatest(CoordinateKind::Translation), greatest(CoordinateKind::Rotation));
        let scale = SVector::from_fn(|i, _| match coordinates[i].kind {
            CoordinateKind::Translation => force,
            CoordinateKind::Rotation => moment,
        });
        Self { scale }
    }

    /// `‖r/scale‖`, dimensionless: 0 in equilibrium, about 1 where springs do not carry the weight yet.
    pub(super) fn norm(&self, residual: &SVector<f64, N>) -> f64 {
        residual.component_div(&self.scale).norm()
    }
}
