//! Friction of a joint: `D = (F_c + (F_b − F_c) exp(−(ṡ/v_s)²)) tanh(ṡ/v₀) + b ṡ`; for a joint with bristles only `b ṡ`, since the
//! rest follows from a state. It stores no energy.

use super::{Law, LawState};
use crate::chain::Friction;
use crate::symbolic::Expr;

impl Law for Friction {
    fn twice_energy<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>) -> Expr<'g> {
        at.zero()
    }

    fn resistance<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let viscous = at.number(&self.viscous) * rate;
        if self.bristle.is_some() {
            return viscous;
        }
        let coulomb = at.number(&self.coulomb);
        let size = self.breakaway.as_ref().map_or(coulomb, |(breakaway, stribeck)| {
            let decline = (-(rate / at.number(stribeck)).squared()).exp();
            coulomb + (at.number(breakaway) - coulomb) * decline
        });
        size * (rate / at.number(&self.width)).tanh() + viscous
    }

    /// Only the viscous part: a joint that sticks does not damp.
    fn damping_at_rest<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>) -> Expr<'g> {
        at.number(&self.viscous)
    }

    fn declines(&self) -> bool {
        true
    }
}
