//! A pad with clearance: `F = k (x + ε h) + d ṡ` with `h = clamp(s, −c, c)`, `x = s − h`. Within the clearance grease and seals centre the beam
//! with a fraction ε of the stiffness, so that it has a position there; beyond, they add the constant force ε k c. The grease also damps the motion
//! while beam and pad do not touch.
//!
//! With a compliance γ in series, `F = k₁ x + k₂ h`, `k₁ = k/(1 + k γ)`, `k₂ = ε k/(1 + ε k γ)`, and h within `c (1 + ε k γ)`: what is in series has
//! given way before the pad presses.

use super::{Law, LawState};
use crate::chain::Clearance;
use crate::symbolic::Expr;

/// ε
const CENTRING: f64 = 1e-3;

impl Clearance {
    /// x and h
    fn pressed<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> [Expr<'g>; 2] {
        let clearance = at.number(&self.clearance);
        let clearance = at.softened(CENTRING * at.number(&self.stiffness)).map_or(clearance, |times| clearance * times);
        let held = strain.clamp(-clearance, clearance);
        [strain - held, held]
    }

    /// `k₂/k₁`
    fn centring<'g>(&self, at: LawState<'_, 'g>) -> Expr<'g> {
        let stiffness = at.number(&self.stiffness);
        let times = at.softened(stiffness).zip(at.softened(CENTRING * stiffness));
        times.map_or(at.model.graph.constant(CENTRING), |(stiff, soft)| CENTRING * stiff / soft)
    }

    fn damping<'g>(&self, at: LawState<'_, 'g>) -> Expr<'g> {
        at.damping(at.number(&self.stiffness), at.number(&self.damping))
    }
}

impl Law for Clearance {
    /// `k (x² + ε h (2s − h))`
    fn twice_energy<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        let [pressed, held] = self.pressed(at, strain);
        at.stiffness(at.number(&self.stiffness))
            * (pressed.squared() + self.centring(at) * held * (2.0 * strain - held))
    }

    fn resistance<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        self.damping(at) * rate
    }

    fn force<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let [pressed, held] = self.pressed(at, strain);
        at.stiffness(at.number(&self.stiffness)) * (pressed + self.centring(at) * held)
            + self.resistance(at, strain, rate)
    }

    fn dissipation<'g>(&self, at: LawState<'_, 'g>, _: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        self.damping(at) * rate.squared()
    }
}
