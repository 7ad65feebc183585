//! Points of interest, their velocities and their derivatives.

use super::kinematics::Kinematics;
use super::model::Model;
use super::twist::Twist;
use super::vector::Vec3;
use crate::chain::{CoordinateId, Point};
use crate::symbolic::Expr;

fn position<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, point: &Point) -> Vec3<'g> {
    let pose = &kinematics.poses[point.body.0];
    (pose.origin + pose.rotation.apply(model.vector(&point.position))).named(&point.name)
}

/// `T r`, world frame, m.
pub fn positions<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    model.chain.points.iter().flat_map(|point| position(model, kinematics, point).0).collect()
}

/// `Ṫ r = ω × x + υ`, world frame, m/s.
pub fn velocities<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, twists: &[Twist<'g>]) -> Vec<Expr<'g>> {
    let velocity = |point: &Point| {
        let twist = &twists[point.body.0];
        (twist.omega.cross(position(model, kinematics, point)) + twist.upsilon).0
    };
    model.chain.points.iter().flat_map(velocity).collect()
}

/// `Ω_j T r` for every point, row by row, world frame.
pub fn jacobians<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let rows = |point: &Point| {
        let mut columns = vec![Vec3::zero(model.graph); model.size()];
        for CoordinateId(j) in model.chain.coordinates_of(point.body) {
            columns[j] = kinematics.generators[j].velocity(position(model, kinematics, point));
        }
        (0..3).flat_map(|axis| columns.iter().map(move |column| column[axis]).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    model.chain.points.iter().flat_map(rows).collect()
}
