//! A spring and a damper: `E = ½ k x²`, `D = d ṡ`, with `x = s − s₀`.

use super::{At, Law};
use crate::chain::Spring;
use crate::symbolic::Expr;

impl Law for Spring {
    fn twice_energy<'g>(&self, at: At<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        at.number(&self.stiffness) * (strain - at.number(&self.length)).squared()
    }

    fn resistance<'g>(&self, at: At<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.damping) * rate
    }

    /// `k x + d ṡ`
    fn force<'g>(&self, at: At<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.stiffness) * (strain - at.number(&self.length)) + self.resistance(at, strain, rate)
    }

    fn dissipation<'g>(&self, at: At<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.damping) * rate.squared()
    }

    fn is_linear(&self) -> bool {
        true
    }
}
