//! The equations of an equilibrium, `r(q) = 0`, and their derivative.

use nalgebra::{DMatrix, DVector};

use crate::{CoordinateRole, dyn_crane::DynStatics};

/// The equations that a pose at rest satisfies, with loads and winches as at a time and the drives at given positions.
pub(super) struct Equations<'a> {
    pub crane: &'a dyn DynStatics,
    /// Time of loads and winches, s.
    pub t: f64,
    /// Positions of the drives, by coordinate.
    pub positions: Vec<f64>,
}

impl<'a> Equations<'a> {
    /// With the drives where their motions are at time `t`, s.
    pub(super) fn at(crane: &'a dyn DynStatics, t: f64) -> Self {
        Self { crane, t, positions: crane.drive_positions_at(t) }
    }

    /// With the drives at `positions`, one per drive.
    pub(super) fn holding(crane: &'a dyn DynStatics, t: f64, positions: &[f64]) -> Self {
        Self { crane, t, positions: crane.description().by_coordinate(positions) }
    }

    /// Sets the coordinates of rigid drives, which have no residual, to the positions of these drives.
    pub(super) fn prescribe(&self, q: &mut [f64]) {
        let coordinates = self.crane.description().coordinates.iter().zip(&self.positions);
        for (q, (coordinate, position)) in q.iter_mut().zip(coordinates) {
            if coordinate.role == CoordinateRole::Prescribed {
                *q = *position;
            }
        }
    }

    /// `r(q)`: N for translations, N m for rotations.
    pub(super) fn residual(&self, q: &DVector<f64>) -> DVector<f64> {
        let mut residual = DVector::zeros(q.len());
        self.crane.static_residual(self.t, q.as_slice(), &self.positions, residual.as_mut_slice());
        residual
    }

    /// `∂r/∂q`
    pub(super) fn stiffness(&self, q: &DVector<f64>) -> DMatrix<f64> {
        let mut stiffness = DMatrix::zeros(q.len(), q.len());
        self.crane.tangent_stiffness(self.t, q.as_slice(), &self.positions, stiffness.as_mut_slice());
        stiffness
    }
}
