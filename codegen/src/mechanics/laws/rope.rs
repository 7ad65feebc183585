//! A rope: `E = ½ k σ²`, `D = k σ max(−1, a σ̇)`, with `σ = max(0, s − ℓ₀(t))`, and `k = EA/ℓ₀(t)` if EA is given.

use super::super::profile;
use super::{Law, LawState};
use crate::chain::{Rope, RopeStiffness};
use crate::symbolic::Expr;

impl Rope {
    /// σ. A rope that is just taut counts as taut, because Newton's method starts with ropes that are about to pull.
    fn stretch<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        let length = profile::position(at.model, &self.length, at.t);
        (length - strain).select(at.zero(), strain - length)
    }

    /// k
    fn stiffness<'g>(&self, at: LawState<'_, 'g>) -> Expr<'g> {
        match &self.stiffness {
            RopeStiffness::Whole(stiffness) => at.number(stiffness),
            RopeStiffness::Axial(axial) => at.number(axial) / profile::position(at.model, &self.length, at.t),
        }
    }

    /// The force that a winch overcomes, `−∂E/∂ℓ₀ + D`: the rope's force F; with `k = EA/ℓ₀` also `E/ℓ₀`, because the rope that it winds up
    /// is stretched.
    pub fn winch_force<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, force: Expr<'g>) -> Expr<'g> {
        match self.stiffness {
            RopeStiffness::Whole(_) => force,
            RopeStiffness::Axial(_) => {
                let length = profile::position(at.model, &self.length, at.t);
                force + 0.5 * self.twice_energy(at, strain) / length
            }
        }
    }

    /// `a σ̇`
    fn growth<'g>(&self, at: LawState<'_, 'g>, rate: Expr<'g>) -> Expr<'g> {
        let winch = if at.moving { profile::rate(at.model, &self.length, at.t) } else { at.zero() };
        at.number(&self.damping) * (rate - winch)
    }
}

impl Law for Rope {
    fn twice_energy<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>) -> Expr<'g> {
        self.stiffness(at) * self.stretch(at, strain).squared()
    }

    fn resistance<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let share = self.growth(at, rate).max(at.model.graph.constant(-1.0));
        self.stiffness(at) * self.stretch(at, strain) * share
    }

    /// `k σ max(0, 1 + a σ̇)`
    fn force<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let growth = (1.0 + self.growth(at, rate)).max(at.zero());
        self.stiffness(at) * self.stretch(at, strain) * growth
    }

    fn slopes<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> [Expr<'g>; 2] {
        let (stiffness, damping) = (self.stiffness(at), at.number(&self.damping));
        let slack = profile::position(at.model, &self.length, at.t) - strain;
        let growth = 1.0 + self.growth(at, rate);
        let by_strain = slack.select(at.zero(), stiffness * growth.max(at.zero()));
        [by_strain, growth.select(stiffness * damping * self.stretch(at, strain), at.zero())]
    }

    /// `D σ̇`: the winch takes part in σ̇.
    fn dissipation<'g>(&self, at: LawState<'_, 'g>, strain: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
        let winch = if at.moving { profile::rate(at.model, &self.length, at.t) } else { at.zero() };
        self.resistance(at, strain, rate) * (rate - winch)
    }
}
