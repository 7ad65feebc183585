//! The equations of an equilibrium, `r(q) = 0`, and their derivative.

use nalgebra::{DMatrix, DVector};

use super::closed::Closed;
use crate::{CoordinateRole, dyn_crane::DynCrane, feet::Feet};

/// The equations that a pose at rest satisfies, with loads and winches as at a time and the drives at given positions.
pub(super) struct Equations<'a> {
    pub crane: &'a dyn DynCrane,
    /// Time of loads and winches, s.
    pub t: f64,
    /// Positions of the drives, by coordinate.
    pub positions: Vec<f64>,
    /// Whether the base stays where it is, as if its supports did not yield.
    holds_base: bool,
    /// What closes the loops, once the search has begun; `None` without loops.
    closed: Option<Closed>,
}

impl<'a> Equations<'a> {
    /// With the drives where their motions are at time `t`, s.
    pub(super) fn at(crane: &'a dyn DynCrane, t: f64) -> Self {
        Self { crane, t, positions: crane.drive_positions_at(t), holds_base: false, closed: None }
    }

    /// With the drives at `positions`, one per drive.
    pub(super) fn holding(crane: &'a dyn DynCrane, t: f64, positions: &[f64]) -> Self {
        let positions = crane.description().by_coordinate(positions);
        Self { crane, t, positions, holds_base: false, closed: None }
    }

    /// With the base held where a search begins.
    pub(super) fn with_held_base(self) -> Self {
        Self { holds_base: true, ..self }
    }

    /// The coordinates of the base, if it is held.
    fn held(&self) -> impl Iterator<Item = usize> {
        let coordinates = self.crane.description().coordinates.iter().enumerate();
        coordinates.filter(|(_, info)| self.holds_base && info.role == CoordinateRole::Base).map(|(index, _)| index)
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

    /// Begins a search at a pose, which is moved onto the loops; returns whether they close.
    pub(super) fn begin(&mut self, q: &mut DVector<f64>) -> bool {
        if self.crane.loop_joints().is_empty() {
            return true;
        }
        self.closed = Some(Closed::new(&self.open_stiffness(q), self.crane.description()));
        self.close(q)
    }

    /// Moves a pose onto the loops; returns whether they close.
    pub(super) fn close(&self, q: &mut DVector<f64>) -> bool {
        self.closed.as_ref().is_none_or(|closed| closed.close(self.crane, q.as_mut_slice()))
    }

    /// `r(q)`, with loops that of the motions that leave them closed: N for translations, N m for rotations.
    pub(super) fn residual(&self, q: &DVector<f64>) -> DVector<f64> {
        let residual = self.open_residual(q);
        match &self.closed {
            Some(closed) => closed.residual(self.crane, q.as_slice(), &residual),
            None => residual,
        }
    }

    /// `∂r/∂q`, with loops positive in the directions that open them; feet that slide are free sideways.
    pub(super) fn stiffness(&self, q: &DVector<f64>) -> DMatrix<f64> {
        let stiffness = self.closed_stiffness(q, self.open_stiffness(q));
        if self.closed.is_some() { (&stiffness + stiffness.transpose()) * 0.5 } else { stiffness }
    }

    /// The same with the friction of feet that slide, which is not symmetric; `None` if none slides.
    pub(super) fn sliding_stiffness(&self, q: &DVector<f64>) -> Option<DMatrix<f64>> {
        let sliding = self.friction_of_sliding(q)?;
        Some(self.closed_stiffness(q, self.open_stiffness(q) + sliding))
    }

    fn friction_of_sliding(&self, q: &DVector<f64>) -> Option<DMatrix<f64>> {
        if self.holds_base || !self.crane.description().has_feet() {
            return None;
        }
        Feet::at_rest(self.crane, q.as_slice()).sliding_stiffness(self.crane.description())
    }

    fn closed_stiffness(&self, q: &DVector<f64>, stiffness: DMatrix<f64>) -> DMatrix<f64> {
        match &self.closed {
            Some(closed) => closed.stiffness(self.crane, q.as_slice(), &self.open_residual(q), &stiffness),
            None => stiffness,
        }
    }

    /// `H = load r(q) + (1 − load) S (q − q₀)`, with loops restricted to the motions that leave them closed, together with their gaps; and
    /// its derivatives by q and by the load. `held` is `S (q − q₀)`, `springs` the diagonal of S.
    pub(super) fn partly_loaded(
        &self,
        q: &DVector<f64>,
        load: f64,
        held: &DVector<f64>,
        springs: &DVector<f64>,
    ) -> (DVector<f64>, DMatrix<f64>, DVector<f64>) {
        let residual = self.open_residual(q);
        let value = &residual * load + held * (1.0 - load);
        let by_load = residual - held;
        let mut stiffness = self.open_stiffness(q);
        if let Some(sliding) = self.friction_of_sliding(q) {
            stiffness += sliding;
        }
        let by_pose = stiffness * load + DMatrix::from_diagonal(springs) * (1.0 - load);
        match &self.closed {
            Some(closed) => closed.partly_loaded(self.crane, q.as_slice(), &value, &by_pose, &by_load),
            None => (value, by_pose, by_load),
        }
    }

    /// `r(q)` of the open chain.
    pub(super) fn open_residual(&self, q: &DVector<f64>) -> DVector<f64> {
        let mut residual = DVector::zeros(q.len());
        self.crane.static_residual(self.t, q.as_slice(), &self.positions, residual.as_mut_slice());
        self.held().for_each(|index| residual[index] = 0.0);
        residual
    }

    /// `∂r/∂q` of the open chain.
    fn open_stiffness(&self, q: &DVector<f64>) -> DMatrix<f64> {
        let mut stiffness = DMatrix::zeros(q.len(), q.len());
        self.crane.tangent_stiffness(self.t, q.as_slice(), &self.positions, stiffness.as_mut_slice());
        for index in self.held() {
            stiffness.row_mut(index).fill(0.0);
            stiffness.column_mut(index).fill(0.0);
            stiffness[(index, index)] = 1.0;
        }
        stiffness
    }
}
