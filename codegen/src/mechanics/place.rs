//! Places on bodies, and what is exerted there.

use super::vector::Vec3;
use crate::chain::{BodyId, Value};
use crate::symbolic::Expr;

/// Where a force acts on a body.
#[derive(Clone, Debug)]
pub struct Place<'g> {
    /// The body.
    pub body: BodyId,
    /// Position along it.
    pub along: Along<'g>,
}

/// A position along a body.
#[derive(Clone, Debug)]
pub enum Along<'g> {
    /// Always the same, m.
    Fixed(Value),
    /// That of a pad on which a beam slides: its distance from the beginning of the beam, m. It acts on the element where the pad is, the others get
    /// nothing from it.
    Pad(Expr<'g>),
}

/// A force on a body, in the world.
#[derive(Clone, Copy, Debug)]
pub struct Pull<'g> {
    /// Where it acts.
    pub point: Vec3<'g>,
    /// Force.
    pub force: Vec3<'g>,
    /// A moment besides that of the force.
    pub moment: Option<Vec3<'g>>,
}

impl<'g> Pull<'g> {
    /// A force alone.
    pub fn of_force(point: Vec3<'g>, force: Vec3<'g>) -> Self {
        Pull { point, force, moment: None }
    }

    /// As many times as large.
    pub fn times(self, tension: Expr<'g>) -> Self {
        Pull { force: tension * self.force, moment: self.moment.map(|moment| tension * moment), ..self }
    }

    /// Force and moment about the world's origin.
    pub fn about_origin(self) -> [Vec3<'g>; 2] {
        Pull::wrench(self.point, self.force, self.moment)
    }

    /// Force and moment, the force acting with a lever; both vectors in the axes of the lever.
    pub fn wrench(lever: Vec3<'g>, force: Vec3<'g>, moment: Option<Vec3<'g>>) -> [Vec3<'g>; 2] {
        let of_force = lever.cross(force);
        [force, moment.map_or(of_force, |moment| of_force + moment)]
    }
}
