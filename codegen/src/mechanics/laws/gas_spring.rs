//! A gas spring: `E = ½ k x² − P x`, `D = d ṡ`, with `x = s − s₀`.

use super::{Law, LawState};
use crate::chain::GasSpring;
use crate::symbolic::Expr;

impl Law for GasSpring {
    fn twice_energy<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        let stretch = strain - at.number(&self.length);
        at.number(&self.stiffness) * stretch.squared() - 2.0 * at.number(&self.force) * stretch
    }

    fn resistance<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.damping) * rate
    }

    /// `k x − P + d ṡ`
    fn force<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let elastic = at.number(&self.stiffness) * (strain - at.number(&self.length)) - at.number(&self.force);
        elastic + self.resistance(at, strain, rate)
    }
}
