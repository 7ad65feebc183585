//! Cylinders between their pins: length, its rate, and its derivative by the joint's coordinate.
//!
//! Notation
//! : A the foot, B the rod's pin, H the head, P the pivot of the rocker, all in the world; e = (B − A)/ℓ. What moves H as seen from
//!   the body that carries A and P is Ḣ; without a linkage B = H:
//!
//! ```text
//! ℓ = |B − A|        ℓ̇ = e · Ḃ
//! ```
//!
//! With a linkage, B is at the rocker's length r from P and at the link's length l from H, in the plane across the joint's axis n. With
//! `c = (H − P)/|H − P|` and `m = ± (n × c)/|n × c|`:
//!
//! ```text
//! B = P + a c + √(r² − a²) m,     a = (|H − P|² + r² − l²)/(2|H − P|)
//! Ḃ = ω n × (B − P),              ω = (B − H) · Ḣ / ((B − H) · n × (B − P))
//! ```
//!
//! A square root of a negative number, not a number, is a pose that cannot be assembled.

use super::kinematics::Kinematics;
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
    /// What gives ℓ̇ as a scalar product with Ḣ.
    by_head: Vec3<'g>,
}

fn place<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, pin: &Pin) -> Vec3<'g> {
    let pose = &kinematics.poses[pin.body.0];
    pose.origin + pose.rotation.apply(model.vector(&pin.position))
}

fn geometry<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, cylinder: &Cylinder) -> Geometry<'g> {
    let [foot, head] = [&cylinder.foot, &cylinder.head].map(|pin| place(model, kinematics, pin));
    let Some(linkage) = &cylinder.linkage else {
        let way = head - foot;
        let length = way.dot(way).sqrt();
        return Geometry { head, length, by_head: (1.0 / length) * way };
    };
    let Linkage { pivot, rocker, link, left } = linkage;
    let pivot = place(model, kinematics, &Pin { position: pivot.clone(), ..cylinder.foot.clone() });
    let [rocker, link] = [rocker, link].map(|length| model.number(length));
    let axis = kinematics.generators[cylinder.coordinate.0].omega;
    let across = head - pivot;
    let distance = across.dot(across).sqrt();
    let along = (distance.squared() + rocker.squared() - link.squared()) / (2.0 * distance);
    let height = (rocker.squared() - along.squared()).sqrt();
    let normal = axis.cross(across);
    let side = if *left { height } else { -height };
    let arm = (along / distance) * across + (side / normal.dot(normal).sqrt()) * normal;
    let pin = pivot + arm;
    let way = pin - foot;
    let length = way.dot(way).sqrt();
    let (of_link, turned) = (pin - head, axis.cross(arm));
    let by_head = (way.dot(turned) / (length * of_link.dot(turned))) * of_link;
    Geometry { head, length, by_head }
}

/// ℓ, ℓ̇ and `∂ℓ/∂q_j` of every cylinder, m, m/s and m or m/rad.
pub fn states<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, twists: &[Twist<'g>]) -> Vec<Expr<'g>> {
    let state = |cylinder: &Cylinder| {
        let Geometry { head, length, by_head } = geometry(model, kinematics, cylinder);
        let [at_foot, at_head] = [&cylinder.foot, &cylinder.head].map(|pin| {
            let twist = &twists[pin.body.0];
            twist.omega.cross(head) + twist.upsilon
        });
        let arm = by_head.dot(kinematics.generators[cylinder.coordinate.0].velocity(head));
        // The joint moves the body with the greater index.
        let arm = if cylinder.head.body > cylinder.foot.body { arm } else { -arm };
        [length, by_head.dot(at_head - at_foot), arm]
    };
    model.chain.cylinders.iter().flat_map(state).collect()
}
