//! A pad with clearance: `F = k (x + ε h) + d ṡ` with `h = clamp(s, −c, c)`, `x = s − h`. Within the clearance grease and seals centre the beam
//! with a fraction ε of the stiffness, so that it has a position there; beyond, they add the constant force ε k c. The grease also damps the motion
//! while beam and pad do not touch.

use super::{At, Law};
use crate::chain::Clearance;
use crate::symbolic::Expr;

/// ε
const CENTRING: f64 = 1e-3;

impl Clearance {
    /// x and h
    fn pressed<'g>(&self, at: At<'_, 'g>, strain: Expr<'g>) -> [Expr<'g>; 2] {
        let clearance = at.number(&self.clearance);
        let held = strain.clamp(-clearance, clearance);
        [strain - held, held]
    }
}

impl Law for Clearance {
    /// `k (x² + ε h (2s − h))`
    fn twice_energy<'g>(&self, at: At<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        let [pressed, held] = self.pressed(at, strain);
        at.number(&self.stiffness) * (pressed.squared() + CENTRING * held * (2.0 * strain - held))
    }

    fn resistance<'g>(&self, at: At<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.damping) * rate
    }

    fn force<'g>(&self, at: At<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let [pressed, held] = self.pressed(at, strain);
        at.number(&self.stiffness) * (pressed + CENTRING * held) + self.resistance(at, strain, rate)
    }

    fn dissipation<'g>(&self, at: At<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        at.number(&self.damping) * rate.squared()
    }
}
