//! A spring and a damper: `E = ½ k x²`, `D = d ṡ`, with `x = s − s₀`; k and d [with what is in series](At::stiffness).

use super::{Law, LawState};
use crate::chain::Spring;
use crate::symbolic::Expr;

impl Spring {
    fn damping<'g>(&self, at: LawState<'_, 'g>) -> Expr<'g> {
        at.damping(at.number(&self.stiffness), at.number(&self.damping))
    }
}

impl Law for Spring {
    fn twice_energy<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        at.stiffness(at.number(&self.stiffness)) * (strain - at.number(&self.length)).squared()
    }

    fn resistance<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        self.damping(at) * rate
    }

    /// `k x + d ṡ`
    fn force<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.stiffness(at.number(&self.stiffness)) * (strain - at.number(&self.length))
            + self.resistance(at, strain, rate)
    }

    fn dissipation<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        self.damping(at) * rate.squared()
    }

    fn is_linear(&self) -> bool {
        true
    }
}
