//! The law of one-sided supports, which press on the ground and never pull.
//!
//! Notation
//! : e, ė elongation and its rate along the world's axes; s, d stiffness and damping; N₀ the pressing force above which it holds fully.
//!   `δ = max(0, −e_z)` is how far the support is pressed in, `x = min(1, s_z δ/N₀)` and `w = x² (3 − 2x)` the fraction to which
//!   its lateral springs and its dampers act, `L = s_x e_x² + s_y e_y²`.
//!
//! ```text
//! E = ½ s_z δ² + ½ w L
//! f = (−w (s_x e_x + d_x ė_x), −w (s_y e_y + d_y ė_y), max(0, c − w d_z ė_z)),     c = s_z δ + ½ w' L
//! ```
//!
//! Above N₀, w = 1: a firmly pressed support acts exactly like a two-sided one, to the last bit. Through the term `½ w' L`, a
//! lifting support returns the energy of its lateral springs.

use super::vector::{Symmetric3, Vec3};
use crate::symbolic::Expr;

/// A one-sided support at a state.
pub struct Contact<'g> {
    /// e, m.
    pub elongation: Vec3<'g>,
    /// ė, m/s.
    pub rate: Vec3<'g>,
    /// s, N/m.
    pub stiffness: Vec3<'g>,
    /// d, N s/m.
    pub damping: Vec3<'g>,
    /// N₀, N.
    pub full_hold: Expr<'g>,
}

/// The fraction w to which a support holds, and its derivatives with respect to δ.
struct Share<'g> {
    value: Expr<'g>,
    slope: Expr<'g>,
    curvature: Expr<'g>,
}

impl<'g> Contact<'g> {
    fn zero(&self) -> Expr<'g> {
        self.full_hold.graph().constant(0.0)
    }

    /// `number` if the support touches the ground, otherwise 0. A support that just touches counts, because Newton's method
    /// starts with springs that are about to press.
    fn touching(&self, number: Expr<'g>) -> Expr<'g> {
        self.elongation[2].select(self.zero(), number)
    }

    /// δ
    fn depth(&self) -> Expr<'g> {
        (-self.elongation[2]).max(self.zero())
    }

    fn share(&self) -> Share<'g> {
        let one = self.full_hold.graph().constant(1.0);
        let by_depth = self.stiffness[2] / self.full_hold;
        let x = (by_depth * self.depth()).min(one);
        let rest = 1.0 - x;
        Share {
            value: x.squared() * (3.0 - 2.0 * x),
            slope: 6.0 * x * rest * by_depth,
            curvature: self.touching(rest.select((6.0 - 12.0 * x) * by_depth.squared(), self.zero())),
        }
    }

    /// L
    fn lateral(&self) -> Expr<'g> {
        self.stiffness[0] * self.elongation[0].squared() + self.stiffness[1] * self.elongation[1].squared()
    }

    /// `c = s_z δ + ½ w' L`, the pressing force of the springs.
    fn spring(&self, share: &Share<'g>) -> Expr<'g> {
        self.stiffness[2] * self.depth() + 0.5 * share.slope * self.lateral()
    }

    /// `−w d_z ė_z`, the force that the damper adds as long as the sum is positive.
    fn damper(&self, share: &Share<'g>) -> Expr<'g> {
        -(share.value * (self.damping[2] * self.rate[2]))
    }

    /// f, N.
    pub fn reaction(&self) -> Vec3<'g> {
        let share = self.share();
        let along = |axis: usize| {
            let pull = self.stiffness[axis] * self.elongation[axis] + self.damping[axis] * self.rate[axis];
            -(share.value * pull)
        };
        Vec3([along(0), along(1), (self.spring(&share) + self.damper(&share)).max(self.zero())])
    }

    /// 2E, J.
    pub fn twice_energy(&self) -> Expr<'g> {
        self.stiffness[2] * self.depth().squared() + self.share().value * self.lateral()
    }

    /// Dissipated power, W: `w (d_x ė_x² + d_y ė_y²) + max(−w d_z ė_z, −c) (−ė_z) ≥ 0`, the power put into the support minus the
    /// rate of change of its energy.
    pub fn dissipation(&self) -> Expr<'g> {
        let share = self.share();
        let lateral = self.damping[0] * self.rate[0].squared() + self.damping[1] * self.rate[1].squared();
        let pressing = self.damper(&share).max(-self.spring(&share));
        share.value * lateral - pressing * self.rate[2]
    }

    /// `∂E/∂e`, N.
    pub fn gradient(&self) -> Vec3<'g> {
        let share = self.share();
        let along = |axis: usize| share.value * (self.stiffness[axis] * self.elongation[axis]);
        Vec3([along(0), along(1), -self.spring(&share)])
    }

    /// `∂²E/∂e∂e`, N/m.
    pub fn tangent(&self) -> Symmetric3<'g> {
        let share = self.share();
        let held = |axis: usize| share.value * self.stiffness[axis];
        let mixed = |axis: usize| -(share.slope * (self.stiffness[axis] * self.elongation[axis]));
        let normal = self.touching(self.stiffness[2] + 0.5 * share.curvature * self.lateral());
        Symmetric3([held(0), held(1), normal, self.zero(), mixed(0), mixed(1)])
    }

    /// Damping at rest, N s/m.
    pub fn damping_at_rest(&self) -> Vec3<'g> {
        let share = self.share();
        Vec3(self.damping.0.map(|damping| share.value * damping))
    }

    /// Stiffness and damping along the axes for an implicit step, which does not need the exact derivative, but must keep `A + D̂`
    /// positive definite: `w s_x, w s_y, max(0, ∂f_z/∂δ)` and `w d`; along z zero if the support does not press.
    pub fn stiffness_and_damping(&self) -> [Vec3<'g>; 2] {
        let share = self.share();
        let presses = self.spring(&share) + self.damper(&share);
        let where_pressing = |number: Expr<'g>| presses.select(number, self.zero());
        let growth = 0.5 * share.curvature * self.lateral() - share.slope * (self.damping[2] * self.rate[2]);
        let normal = (self.stiffness[2] + growth).max(self.zero());
        let [held_x, held_y] = [0, 1].map(|axis| share.value * self.stiffness[axis]);
        let [x, y, z] = self.damping_at_rest().0;
        [Vec3([held_x, held_y, where_pressing(self.touching(normal))]), Vec3([x, y, where_pressing(z)])]
    }
}
