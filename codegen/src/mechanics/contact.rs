//! The law of one-sided supports, which press on the ground, never pull, and hold sideways by friction.
//!
//! Notation
//! : e, ė elongation and its rate along the world's axes; s, d stiffness and damping; μ the coefficient of friction.
//!   `δ = max(0, −e_z)` is how far the support is pressed in, `c = s_z δ` the force of its spring.
//!
//! ```text
//! N = c + min(max(−d_z ė_z, −c), c)                     F = (s_x e_x + d_x ė_x, s_y e_y + d_y ė_y)
//! f = (−g F_x, −g F_y, N),     g = min(1, μ N/|F|)      E = ½ s_z δ² + ½ (s_x e_x² + s_y e_y²), 0 in the air
//! ```
//!
//! A support sticks as long as |F| ≤ μ N: it then acts exactly like a two-sided one, to the last bit. Beyond, it slides. How far it has slid is
//! not a function of the pose: the runtime keeps it as a state and subtracts it from e (`feet` in the runtime); here the support stands where the
//! spec puts it. The damper exerts at most as much as the spring, so that no force jumps where a support meets the ground.

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
    /// μ.
    pub friction: Expr<'g>,
}

/// A lateral force that does not count, N: a support that just touches the ground, without a lateral force, sticks.
const NO_FORCE: f64 = 1e-15;

impl<'g> Contact<'g> {
    fn zero(&self) -> Expr<'g> {
        self.friction.graph().constant(0.0)
    }

    /// `number` if the support touches the ground, otherwise 0. A support that just touches counts, because Newton's method
    /// starts with springs that are about to press.
    fn touching(&self, number: Expr<'g>) -> Expr<'g> {
        self.elongation[2].select(self.zero(), number)
    }

    /// `c = s_z δ`, N.
    fn spring(&self) -> Expr<'g> {
        self.stiffness[2] * (-self.elongation[2]).max(self.zero())
    }

    /// What the damper adds to N.
    fn damper(&self) -> Expr<'g> {
        let force = -(self.damping[2] * self.rate[2]);
        if force.as_constant() == Some(0.0) {
            return force;
        }
        let spring = self.spring();
        force.max(-spring).min(spring)
    }

    /// N, N.
    pub fn pressing(&self) -> Expr<'g> {
        self.spring() + self.damper()
    }

    /// F, N, along x and y.
    fn lateral(&self) -> [Expr<'g>; 2] {
        [0, 1].map(|axis| self.stiffness[axis] * self.elongation[axis] + self.damping[axis] * self.rate[axis])
    }

    /// |F|, N.
    pub fn lateral_size(&self) -> Expr<'g> {
        let [x, y] = self.lateral();
        (x.squared() + y.squared() + NO_FORCE * NO_FORCE).sqrt()
    }

    /// `μ N`, N.
    pub fn grip(&self) -> Expr<'g> {
        self.friction * self.pressing()
    }

    /// g.
    fn share(&self) -> Expr<'g> {
        let one = self.friction.graph().constant(1.0);
        self.touching(((self.grip() + NO_FORCE) / self.lateral_size()).min(one))
    }

    /// `number` if the support sticks, otherwise 0.
    fn sticking(&self, number: Expr<'g>) -> Expr<'g> {
        let slides = self.lateral_size() - (self.grip() + NO_FORCE);
        self.touching(slides.select(self.zero(), number))
    }

    /// f, N.
    pub fn reaction(&self) -> Vec3<'g> {
        let share = self.share();
        let [x, y] = self.lateral().map(|force| -(share * force));
        Vec3([x, y, self.pressing()])
    }

    /// 2E, J.
    pub fn twice_energy(&self) -> Expr<'g> {
        let depth = (-self.elongation[2]).max(self.zero());
        let [x, y] = [0, 1].map(|axis| self.stiffness[axis] * self.elongation[axis].squared());
        self.stiffness[2] * depth.squared() + self.touching(x + y)
    }

    /// The power put into the support minus the rate of change of its energy, W.
    pub fn dissipation(&self) -> Expr<'g> {
        let share = self.share();
        let lost = |axis: usize, force: Expr<'g>| {
            (share * force - self.stiffness[axis] * self.elongation[axis]) * self.rate[axis]
        };
        let [x, y] = self.lateral();
        self.touching(lost(0, x) + lost(1, y)) - self.damper() * self.rate[2]
    }

    /// `−f` at rest, N.
    pub fn pull(&self) -> Vec3<'g> {
        let reaction = Contact { rate: Vec3([self.zero(); 3]), ..*self }.reaction();
        Vec3(reaction.0.map(|force| -force))
    }

    /// `−∂f/∂e` at rest, N/m, of a support that sticks; one that slides is free sideways.
    pub fn tangent(&self) -> Symmetric3<'g> {
        let held = |axis: usize| self.sticking(self.stiffness[axis]);
        let zero = self.zero();
        Symmetric3([held(0), held(1), self.touching(self.stiffness[2]), zero, zero, zero])
    }

    /// Damping at rest, N s/m; one that slides is free sideways.
    pub fn damping_at_rest(&self) -> Vec3<'g> {
        let [x, y] = [0, 1].map(|axis| self.sticking(self.damping[axis]));
        Vec3([x, y, self.touching(self.damping[2])])
    }

    /// Stiffness and damping along the axes for an implicit step, which does not need the exact derivative, but must keep `A + D̂`
    /// positive definite: `g s_x, g s_y, s_z` and `g d_x, g d_y, d_z`; along z zero if the support does not press.
    pub fn stiffness_and_damping(&self) -> [Vec3<'g>; 2] {
        let share = self.share();
        let where_pressing = |number: Expr<'g>| self.pressing().select(number, self.zero());
        let of = |numbers: Vec3<'g>| {
            Vec3([share * numbers[0], share * numbers[1], where_pressing(self.touching(numbers[2]))])
        };
        [of(self.stiffness), of(self.damping)]
    }
}
