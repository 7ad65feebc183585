//! A spring and a damper: `E = ½ k x² − P x`, `D = d ṡ`, with `x = s − s₀`.

use super::{At, Law};
use crate::chain::Spring;
use crate::symbolic::Expr;

impl Spring {
    fn stretch<'g>(&self, at: At<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        strain - at.number(&self.length)
    }
}

impl Law for Spring {
    fn twice_energy<'g>(&self, at: At<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        let stretch = self.stretch(at, strain);
        at.number(&self.stiffness) * stretch.squared() - 2.0 * at.number(&self.push) * stretch
    }

    fn resistance<'g>(&self, at: At<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.damping) * rate
    }

    /// `k x − P + d ṡ`
    fn force<'g>(&self, at: At<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let elastic = at.number(&self.stiffness) * self.stretch(at, strain) - at.number(&self.push);
        elastic + self.resistance(at, strain, rate)
    }

    fn dissipation<'g>(&self, at: At<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.damping) * rate.squared()
    }

    fn is_linear(&self) -> bool {
        true
    }
}
