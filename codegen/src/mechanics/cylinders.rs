//! Cylinders between their pins: length, its rate, and its derivative with respect to the joint's coordinate.
//!
//! Notation
//! : A the foot, B the rod's pin, H the head, P the pivot of the rocker, all in the world; e = (B − A)/ℓ. Rates are those seen from the
//!   body that carries A and P; without a linkage B = H:
//!
//! ```text
//! ℓ = |B − A|        ℓ̇ = e · Ḃ
//! ```
//!
//! With a linkage, B is at the rocker's length r from P and at the link's length l from H, in the plane normal to the joint's axis
//! n. With
//! `w = H − P`, `d = |w|`, `c = w/d` and `m = ± (n × w)/|n × w|`:
//!
//! ```text
//! B = P + a c + h m,              a = (d² + r² − l²)/2d,   h = √(r² − a²)
//! Ḃ = ȧ c + a ċ + ḣ m + h ṁ,      ȧ = ḋ (1 − a/d),         ḣ = −a ȧ/h
//! ```
//!
//! Seen from that body, the axis turns as well if something bends between the pins and the joint. In a pose in which the linkage
//! cannot be assembled, the square root is of a negative number, and the result is NaN.

use super::kinematics::{Generator, Kinematics};
use super::model::Model;
use super::twist::Twist;
use super::vector::Vec3;
use crate::chain::{Cylinder, Linkage, Pin};
use crate::symbolic::Expr;

/// The geometry of a cylinder in a pose.
struct Geometry<'g> {
    /// H
    head: Vec3<'g>,
    /// ℓ
    length: Expr<'g>,
    /// e
    direction: Vec3<'g>,
    linkage: Option<Assembled<'g>>,
}

/// A linkage in a pose.
struct Assembled<'g> {
    /// n
    axis: Vec3<'g>,
    /// w and d
    across: Vec3<'g>,
    distance: Expr<'g>,
    /// a, and h with the sign of m: negative if the rod's pin is on the right
    along: Expr<'g>,
    height: Expr<'g>,
    /// c, and m without its sign
    unit_along: Vec3<'g>,
    unit_height: Vec3<'g>,
    /// |n × w|
    normal_length: Expr<'g>,
}

impl<'g> Assembled<'g> {
    fn new(axis: Vec3<'g>, across: Vec3<'g>, [rocker, link]: [Expr<'g>; 2], left: bool) -> Self {
        let distance = across.dot(across).sqrt();
        let along = (distance.squared() + rocker.squared() - link.squared()) / (2.0 * distance);
        let height = (rocker.squared() - along.squared()).sqrt();
        let normal = axis.cross(across);
        let normal_length = normal.dot(normal).sqrt();
        Assembled {
            axis,
            across,
            distance,
            along,
            height: if left { height } else { -height },
            unit_along: (1.0 / distance) * across,
            unit_height: (1.0 / normal_length) * normal,
            normal_length,
        }
    }

    /// B − P
    fn pin(&self) -> Vec3<'g> {
        self.along * self.unit_along + self.height * self.unit_height
    }

    /// Ḃ, from Ḣ and ṅ.
    fn pin_rate(&self, head: Vec3<'g>, axis: Vec3<'g>) -> Vec3<'g> {
        let distance = self.unit_along.dot(head);
        let along = distance * (1.0 - self.along / self.distance);
        let height = -(self.along * along / self.height);
        let unit_along = (1.0 / self.distance) * (head - distance * self.unit_along);
        let normal = axis.cross(self.across) + self.axis.cross(head);
        let unit_height = (1.0 / self.normal_length) * (normal - self.unit_height.dot(normal) * self.unit_height);
        along * self.unit_along + self.along * unit_along + height * self.unit_height + self.height * unit_height
    }
}

impl<'g> Geometry<'g> {
    /// ℓ̇, from Ḣ and ṅ.
    fn rate(&self, head: Vec3<'g>, axis: Vec3<'g>) -> Expr<'g> {
        let pin = self.linkage.as_ref().map_or(head, |linkage| linkage.pin_rate(head, axis));
        self.direction.dot(pin)
    }
}

fn pin_position<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, pin: &Pin) -> Vec3<'g> {
    let pose = &kinematics.poses[pin.body.0];
    pose.origin + pose.rotation.apply(model.vector(&pin.position))
}

fn geometry<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, cylinder: &Cylinder) -> Geometry<'g> {
    let [foot, head] = [&cylinder.foot, &cylinder.head].map(|pin| pin_position(model, kinematics, pin));
    let linkage = cylinder.linkage.as_ref().map(|Linkage { pivot, rocker, link, left }| {
        let pivot = pin_position(model, kinematics, &Pin { position: pivot.clone(), ..cylinder.foot.clone() });
        let lengths = [rocker, link].map(|length| model.number(length));
        let axis = kinematics.generators[cylinder.coordinate.0].omega;
        (pivot, Assembled::new(axis, head - pivot, lengths, *left))
    });
    let pin = linkage.as_ref().map_or(head, |(pivot, linkage)| *pivot + linkage.pin());
    let way = pin - foot;
    let length = way.dot(way).sqrt();
    let linkage = linkage.map(|(_, linkage)| linkage);
    Geometry { head, length, direction: (1.0 / length) * way, linkage }
}

/// Angular velocity of a joint's axis relative to a body: that of the rotations between them.
fn spin_of_axis<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, joint: usize, from: usize) -> Vec3<'g> {
    let turning = |(j, generator): (usize, &Generator<'g>)| match (generator.body > from, j < joint) {
        (true, true) => Some(model.v[j] * generator.omega),
        (false, false) if j > joint => Some(-(model.v[j] * generator.omega)),
        _ => None,
    };
    let all = kinematics.generators.iter().enumerate();
    all.filter_map(turning).fold(Vec3::zero(model.graph), |sum, rate| sum + rate)
}

/// ℓ, ℓ̇ and `∂ℓ/∂q_j` of every cylinder, m, m/s and m or m/rad.
pub fn states<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, twists: &[Twist<'g>]) -> Vec<Expr<'g>> {
    let state = |cylinder: &Cylinder| {
        let (joint, foot) = (cylinder.coordinate.0, cylinder.foot.body.0);
        let geometry = geometry(model, kinematics, cylinder);
        let head = geometry.head;
        let [at_foot, at_head] = [foot, cylinder.head.body.0].map(|body| {
            let twist = &twists[body];
            twist.omega.cross(head) + twist.upsilon
        });
        let axis = kinematics.generators[joint].omega;
        let rotated = spin_of_axis(model, kinematics, joint, foot).cross(axis);
        let rate = geometry.rate(at_head - at_foot, rotated);
        let arm = geometry.rate(kinematics.generators[joint].velocity(head), Vec3::zero(model.graph));
        // The joint moves the body with the greater index.
        let arm = if cylinder.head.body > cylinder.foot.body { arm } else { -arm };
        [geometry.length, rate, arm]
    };
    model.chain.cylinders.iter().flat_map(state).collect()
}
