//! A progressive spring and a damper: `E = ½ k x² + ¼ k₃ x⁴`, `D = d ṡ`, with `x = s − s₀`.

use super::{Law, LawState};
use crate::chain::ProgressiveSpring;
use crate::symbolic::Expr;

impl Law for ProgressiveSpring {
    fn twice_energy<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        let square = (strain - at.number(&self.length)).squared();
        square * (at.number(&self.stiffness) + 0.5 * at.number(&self.progression) * square)
    }

    fn resistance<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.damping) * rate
    }

    /// `k x + k₃ x³ + d ṡ`
    fn force<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let stretch = strain - at.number(&self.length);
        let stiffness = at.number(&self.stiffness) + at.number(&self.progression) * stretch.squared();
        stiffness * stretch + self.resistance(at, strain, rate)
    }
}
