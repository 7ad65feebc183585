//! An end stop: `E = ½ k δ²`, `D = k δ max(−1, a δ̇)` along δ, with `δ = max(0, ±(s − s_stop))`.

use super::{Law, LawState};
use crate::chain::{End, Stop};
use crate::symbolic::Expr;

impl Stop {
    /// δ, and the sign `∂δ/∂s` beyond the stop.
    fn depth<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> (Expr<'g>, f64) {
        let stop = at.number(&self.at);
        let (beyond, sign) = match self.end {
            End::Lower => (stop - strain, -1.0),
            End::Upper => (strain - stop, 1.0),
        };
        (beyond.max(at.zero()), sign)
    }
}

impl Law for Stop {
    fn twice_energy<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        at.number(&self.stiffness) * self.depth(at, strain).0.squared()
    }

    fn resistance<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let (depth, sign) = self.depth(at, strain);
        let share = (at.number(&self.damping) * (sign * rate)).max(at.model.graph.constant(-1.0));
        sign * (at.number(&self.stiffness) * depth * share)
    }

    /// `± k δ max(0, 1 + a δ̇)`: it pushes and never pulls.
    fn force<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let (depth, sign) = self.depth(at, strain);
        let approach = (1.0 + at.number(&self.damping) * (sign * rate)).max(at.zero());
        sign * (at.number(&self.stiffness) * depth * approach)
    }

    /// `k a δ`
    fn damping_at_rest<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        at.number(&self.stiffness) * at.number(&self.damping) * self.depth(at, strain).0
    }
}
