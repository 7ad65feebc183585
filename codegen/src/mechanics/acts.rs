//! What every kind of force is asked for.

use super::model::Model;
use super::tangent::Tangent;
use super::vector::SymmetricMatrix;
use crate::symbolic::Expr;

/// What is given at rest besides the pose.
pub struct Rest<'g> {
    /// Time of loads and winches, s.
    pub t: Expr<'g>,
    /// Positions at which the drives hold the crane, by coordinate.
    pub positions: Vec<Expr<'g>>,
}

impl<'g> Rest<'g> {
    /// At any time, with the drives at any positions.
    pub fn given(model: &Model<'g>) -> Self {
        Rest { t: model.t, positions: model.drive_positions.clone() }
    }
}

/// The forces of a kind.
pub trait Acts<'g> {
    /// Generalized forces in motion.
    fn in_motion(&self) -> Vec<Expr<'g>>;

    /// Generalized forces at rest, `−∂E/∂q`: oil holds its joints, and no winch moves.
    fn at_rest(&self, rest: &Rest<'g>) -> Vec<Expr<'g>>;

    /// The energy that they store, if any.
    fn energy(&self) -> Option<Expr<'g>> {
        None
    }

    /// The power that they dissipate, if they can.
    fn dissipation(&self) -> Option<Expr<'g>> {
        None
    }

    /// Adds the tangent stiffness at rest, `∂²E/∂q∂q`, without that of oil, which follows from its volumes.
    fn add_stiffness(&self, rest: &Rest<'g>, tangent: &mut Tangent<'_, 'g>);

    /// Adds the damping at rest, `−∂f/∂q̇`.
    fn add_damping(&self, _rest: &Rest<'g>, _matrix: &mut SymmetricMatrix<'g>) {}

    /// Adds stiffness and damping for an implicit step: constants for linear springs and dampers on single coordinates, and for the base's
    /// coordinates values at the present state, which are never negative.
    fn add_step_matrices(&self, _matrices: [&mut SymmetricMatrix<'g>; 2]) {}

    /// Adds stiffness and damping for an implicit step of other laws on single coordinates, at the present state. The derivative of a law
    /// that declines is set to 0: a step does not need the exact one, but `A + D̂` must stay positive definite.
    fn add_nonlinear(&self, _diagonal: &mut [[Expr<'g>; 2]]) {}
}

/// The sum of two vectors of generalized forces.
pub fn add<'g>(a: &[Expr<'g>], b: &[Expr<'g>]) -> Vec<Expr<'g>> {
    a.iter().zip(b).map(|(&a, &b)| a + b).collect()
}
